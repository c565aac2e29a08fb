// Which ways this device has to show models in the real place, and why it has not the others. With the page from the
// start: small, and no words.
import { mediaTypes } from '../app/saved_files';
import type { PageState } from '../app/state';

/** The best first. Posed while it is seen: in a WebXR session, on a card before the camera, before the camera alone. Only
 *  looked at: in Apple's viewer, in Google's, in what the file is shared with. */
export const allWays = ['webxr', 'card', 'camera', 'quick-look', 'scene-viewer', 'share'] as const;
export type Way = (typeof allWays)[number];

export type Lack = 'insecure' | 'no-webxr' | 'no-camera' | 'no-sensors' | 'not-apple' | 'not-android' | 'no-address' | 'no-sharing' | 'needless';
/** Null where the way is there. */
export type Ways = Record<Way, Lack | null>;

export const waysOf = (ways: Ways): Way[] => allWays.filter((way) => ways[way] === null);

const patience = 500; // milliseconds for sensors to say something

export async function findWays(now: PageState): Promise<Ways> {
  const [webxr, camera, sensors] = await Promise.all([lackOfWebXr(), lackOfCamera(), lackOfSensors()]);
  const quickLook = document.createElement('a').relList.supports?.('ar') ? null : 'not-apple', sceneViewer = lackOfSceneViewer(now);
  return {
    webxr, card: camera, camera: camera ?? sensors, 'quick-look': quickLook, 'scene-viewer': sceneViewer,
    share: quickLook === null || sceneViewer === null ? 'needless' : shareable() ? null : 'no-sharing',
  };
}

async function lackOfWebXr(): Promise<Lack | null> {
  if (!isSecureContext) return 'insecure';
  return await navigator.xr?.isSessionSupported('immersive-ar').catch(() => false) ? null : 'no-webxr';
}

/** Without asking for leave: that there is one is told, not which. */
async function lackOfCamera(): Promise<Lack | null> {
  if (!navigator.mediaDevices) return 'insecure';
  const devices = await navigator.mediaDevices.enumerateDevices().catch(() => []);
  return devices.some(({ kind }) => kind === 'videoinput') ? null : 'no-camera';
}

/** Silent ones may be there where the user is asked first (iOS). A device without any sends one event with nothing in it. */
async function lackOfSensors(): Promise<Lack | null> {
  if (!isSecureContext) return 'insecure';
  const events = globalThis.DeviceOrientationEvent as typeof DeviceOrientationEvent | undefined;
  if (!events) return 'no-sensors';
  const askedFirst = 'requestPermission' in events;
  return new Promise((resolve) => {
    const tell = (lack: Lack | null) => {
      removeEventListener('deviceorientation', hear);
      clearTimeout(late);
      resolve(lack);
    };
    const hear = ({ alpha }: DeviceOrientationEvent) => tell(alpha === null ? 'no-sensors' : null);
    const late = setTimeout(() => tell(askedFirst ? null : 'no-sensors'), patience);
    addEventListener('deviceorientation', hear);
  });
}

const isAndroid = () => /android/i.test(navigator.userAgent);

function lackOfSceneViewer(now: PageState): Lack | null {
  if (!isAndroid()) return 'not-android';
  return publicAddress(now) ? null : 'no-address';
}

/** Of the file that the page was opened with, as long as it is what is shown, where anybody can fetch it. */
export function publicAddress({ session }: PageState): URL | null {
  const given = new URLSearchParams(location.search).get('model');
  if (!given || !session || session.members.length > 1 || !URL.canParse(given, location.href)) return null;
  const address = new URL(given, location.href), name = decodeURIComponent(address.pathname.split('/').pop() ?? '');
  const known = /\.(glb|gltf)$/i.test(name) && name === session.name;
  return known && /^https?:$/.test(address.protocol) && !isPrivate(address.hostname) ? address : null;
}

/** Of this machine or this network alone (RFC 1918, 3927, 4193, 6762). */
function isPrivate(host: string): boolean {
  return /^(localhost|127\.|0\.|10\.|192\.168\.|169\.254\.|172\.(1[6-9]|2\d|3[01])\.|\[(::1?\]|f[cd]|fe80))/.test(host)
    || /\.(localhost|local|internal|home\.arpa)$/.test(host) || !/[.:]/.test(host);
}

type SharedFormat = 'usdz' | 'glb';
export const modelFile = (format: SharedFormat, bytes: BlobPart, stem = 'model') => new File([bytes], `${stem}.${format}`, { type: mediaTypes[format] });

/** What this browser lets out, the one first that its device shows in AR. */
export function shareable(): SharedFormat | null {
  const formats: SharedFormat[] = isAndroid() ? ['glb', 'usdz'] : ['usdz', 'glb'];
  return formats.find((format) => navigator.canShare?.({ files: [modelFile(format, '')] })) ?? null;
}
