// What the device itself shows models in AR with: Apple's Quick Look, Google's Scene Viewer, whatever a file is shared with.
import { chosenClip } from '../app/clips';
import { stemOf } from '../app/saved_files';
import { element } from '../ui/dom';
import { say } from '../words/say';
import type { Desk } from './desk';
import { modelFile, publicAddress, shareable } from './ways';

const kept = 60_000; // milliseconds that the viewer has to fetch what it is given

/** What moves now moves there, too; else the surface as it stands. What bends it otherwise than linearly has no movement there. */
async function shownUsdz({ studio, page: { now } }: Desk): Promise<Uint8Array | null> {
  const clip = chosenClip(now.session);
  if (!now.playing || !clip || now.session?.deformer !== 'linear-blend') return studio.exportFile('usdz');
  return (await studio.saveModel({ format: 'usdz', target: 'gltf', clip: clip.name }))?.bytes ?? null;
}

/** The scene as it stands or moves now. A link with rel=ar that has nothing but a picture in it opens Quick Look. */
export async function openQuickLook(desk: Desk) {
  const bytes = await shownUsdz(desk);
  if (!bytes) return;
  const file = modelFile('usdz', bytes as BlobPart);
  const link = element('a', { rel: 'ar', href: URL.createObjectURL(file), download: file.name, class: 'quick-look', hidden: true }, element('img', { alt: say('AR Quick Look') }));
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), kept);
}

/** Where the browser comes back to on a device without it; the page stays, as only the part behind # is another. */
const without = '#no-scene-viewer';

/** Rejects when the device has none. */
export function openSceneViewer({ page }: Desk): Promise<void> {
  const file = publicAddress(page.now);
  if (!file) return Promise.reject(new Error('the model has no public address'));
  return new Promise((resolve, reject) => {
    const back = new URL(without, location.href);
    addEventListener('hashchange', function came() {
      if (location.hash !== without) return;
      removeEventListener('hashchange', came);
      history.back();
      reject(new Error('this device has no Scene Viewer'));
    });
    const asked = new URLSearchParams({ file: file.href, mode: 'ar_preferred', title: page.now.session!.name });
    element('a', {
      href: `intent://arvr.google.com/scene-viewer/1.0?${asked}#Intent;scheme=https;package=com.google.android.googlequicksearchbox;`
        + `action=android.intent.action.VIEW;S.browser_fallback_url=${encodeURIComponent(back.href)};end;`,
    }).click();
    addEventListener('visibilitychange', () => resolve(), { once: true }); // the viewer is in front
  });
}

export async function shareModel(desk: Desk) {
  const format = shareable();
  if (!format) throw new Error('this browser shares no models');
  const bytes = format === 'usdz' ? await shownUsdz(desk) : await desk.studio.exportFile('glb');
  if (!bytes) return;
  await navigator.share({ files: [modelFile(format, bytes as BlobPart, stemOf(desk.page.now))] }).catch((error: unknown) => {
    if (!(error instanceof DOMException && error.name === 'AbortError')) throw error; // thought better of it
  });
}
