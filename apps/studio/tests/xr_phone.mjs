// A phone that emulates WebXR's immersive-ar (iwer), in a room with a floor and a table; what iwer lacks of a phone is put
// in here: a DOM overlay, hit tests of fingers, light, and a screen to touch where there is no overlay.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { furnish } from './xr_room.mjs';

const iwer = readFileSync(createRequire(import.meta.url).resolve('iwer/build/iwer.min.js'), 'utf8');

/** Metres: a level box top, to be seen beside what stands on the floor straight ahead. */
export const table = { height: 0.7, x: [0.3, 1.1], z: [-3.9, -3.1] };

/** Into each page of a context, before its own scripts. `without`: features that the phone has not. */
export async function emulatePhone(context, { without = [] } = {}) {
  await context.addInitScript(`${iwer};(${install})(globalThis.IWER, ${furnish}, ${JSON.stringify({ table, without })})`);
}

function install(IWER, furnish, { table, without }) {
  const has = (feature) => !without.includes(feature);
  const device = new IWER.XRDevice({
    name: 'phone', supportedSessionModes: ['inline', 'immersive-ar'],
    supportedFeatures: ['viewer', 'local', 'local-floor', 'hit-test', 'dom-overlay', 'anchors', 'light-estimation'].filter(has),
    supportedFrameRates: [60], isSystemKeyboardSupported: true, internalNominalFrameRate: 60,
    environmentBlendModes: { 'immersive-ar': 'alpha-blend' }, interactionMode: 'screen-space', userAgent: navigator.userAgent,
    controllerConfig: {
      profileId: 'generic-touchscreen', fallbackProfileIds: [],
      layout: { none: { gamepad: { mapping: '', buttons: [{ id: 'touch', type: 'binary', eventTrigger: 'select' }], axes: [] }, numHapticActuators: 0 } },
    },
  }, { ipd: 0, stereoEnabled: false, fovy: 1 });
  device.installRuntime({ forceInstall: true });
  device.canvasContainer.style.zIndex = '10'; // below the overlay
  device.canvasContainer.setAttribute('role', 'presentation');
  device.position.set(0, 1.5, 0);

  const { room, meets } = furnish(device, table);
  room.light = null;
  let current = null;
  const request = navigator.xr.requestSession.bind(navigator.xr);
  const phone = { device, room, fingers: new Map(), refuse: null, poseLost: false, drift: [0, 0, 0], get session() { return current; } };
  globalThis.phone = phone;
  navigator.xr.requestSession = async (mode, options) => {
    if (phone.refuse) throw new DOMException('refused', phone.refuse);
    current = await request(mode, options);
    phone.options = options;
    if (has('dom-overlay')) Object.defineProperty(current, 'domOverlayState', { value: { type: 'screen' } });
    return current;
  };
  const { getViewerPose } = XRFrame.prototype;
  XRFrame.prototype.getViewerPose = function (space) { return phone.poseLost ? null : getViewerPose.call(this, space); };

  // Light from one side, and the same in the first order all round.
  if (has('light-estimation')) {
    XRSession.prototype.requestLightProbe = async () => Object.assign(new EventTarget(), { probeSpace: {} });
    XRFrame.prototype.getLightEstimate = () => room.light;
  }

  // Fingers of the overlay meet surfaces as well: the test says where they are on the screen.
  if (has('hit-test')) {
    XRSession.prototype.requestHitTestSourceForTransientInput = async () => ({ cancel() {} });
    XRFrame.prototype.getHitTestResultsForTransientInput = function () {
      return [...phone.fingers.values()].map(({ x, y }) => {
        const ray = phone.rayOf(x, y), inputSource = { targetRayMode: 'screen', targetRaySpace: phone.spaceOf(ray) };
        return { inputSource, results: meets(ray.origin, ray.direction).map((matrix) => ({ getPose: () => ({ transform: { matrix } }) })) };
      });
    };
  }
  const rotate = ({ x, y, z, w }, [a, b, c]) => {
    const [tx, ty, tz] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
    return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
  };
  /** Through a pixel of the screen. */
  phone.rayOf = (x, y) => {
    const up = Math.tan(device.fovy / 2), across = (up * innerWidth) / innerHeight;
    const direction = rotate(device.quaternion, [(2 * x / innerWidth - 1) * across, (1 - 2 * y / innerHeight) * up, -1]);
    return { origin: [device.position.x, device.position.y, device.position.z], direction };
  };
  /** Nobody asks it for more than a ray. */
  phone.spaceOf = (ray) => ({ ray });
  // Anchors go where the device finds that they are.
  const anchored = new WeakSet(), { createAnchor, getPose } = XRFrame.prototype;
  if (has('anchors')) {
    XRFrame.prototype.createAnchor = async function (...asked) {
      const anchor = await createAnchor.apply(this, asked);
      anchored.add(anchor.anchorSpace);
      return anchor;
    };
  } else delete XRFrame.prototype.createAnchor;
  XRFrame.prototype.getPose = function (space, base) {
    if (anchored.has(space)) {
      const matrix = new Float32Array(getPose.call(this, space, base).transform.matrix);
      phone.drift.forEach((value, i) => { matrix[12 + i] += value; });
      return { transform: { matrix } };
    }
    if (!space.ray) return getPose.call(this, space, base);
    const { origin, direction } = space.ray, length = Math.hypot(...direction), [x, y, z] = direction.map((value) => -value / length);
    return { transform: { matrix: new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, x, y, z, 0, ...origin, 1]) } };
  };
  /** Where there is no overlay to touch: an input source while the finger is down. */
  phone.touchScreen = (phase, { x, y }) => {
    const finger = device.controllers.none, { inputSource } = finger;
    for (const symbol of Object.getOwnPropertySymbols(inputSource)) {
      if (inputSource[symbol]?.targetRayMode) inputSource[symbol].targetRayMode = 'screen';
    }
    const { origin, direction } = phone.rayOf(x, y), [a, b, c] = direction, length = Math.hypot(a, b, c);
    // From -z to the ray.
    const turn = [b / length, -a / length, 0, 1 - c / length], size = Math.hypot(...turn);
    finger.position.set(...origin);
    finger.quaternion.set(...turn.map((value) => value / size));
    if (phase === 'down') finger.connected = true;
    if (phase !== 'move') finger.updateButtonValue('touch', phase === 'down' ? 1 : 0);
  };
  /** Metres, and degrees: to the right about y, then up. */
  phone.stand = ({ x, y, z }, turn = 0, tilt = 0) => {
    device.position.set(x, y, z);
    const [a, b] = [(-turn * Math.PI) / 360, (tilt * Math.PI) / 360];
    device.quaternion.set(Math.cos(a) * Math.sin(b), Math.sin(a) * Math.cos(b), -Math.sin(a) * Math.sin(b), Math.cos(a) * Math.cos(b));
  };
  phone.stand({ x: 0, y: 1.5, z: 0 }, 0, -20);
}
