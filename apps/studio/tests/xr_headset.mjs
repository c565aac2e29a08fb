// A headset that emulates WebXR's immersive-ar (iwer), with two controllers and two hands, in a room with a floor and a table.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { furnish, table } from './xr_room.mjs';

const iwer = readFileSync(createRequire(import.meta.url).resolve('iwer/build/iwer.min.js'), 'utf8');

/** Into each page of a context, before its own scripts. `stereo`: both eyes are drawn. */
export async function emulateHeadset(context, { stereo = false } = {}) {
  await context.addInitScript(`${iwer};(${install})(globalThis.IWER, ${furnish}, ${JSON.stringify({ table, stereo })})`);
}

function install(IWER, furnish, { table, stereo }) {
  const device = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: stereo });
  device.installRuntime({ forceInstall: true });
  device.canvasContainer.setAttribute('role', 'presentation');
  const { room } = furnish(device, table);
  let current = null;
  const request = navigator.xr.requestSession.bind(navigator.xr);
  navigator.xr.requestSession = async (mode, options) => (current = await request(mode, options));
  const headset = { device, room, get session() { return current; } };
  globalThis.headset = headset;

  /** Metres, and degrees: to the right about y, then up. */
  headset.stand = ([x, y, z], turn = 0, tilt = 0) => {
    device.position.set(x, y, z);
    const [a, b] = [(-turn * Math.PI) / 360, (tilt * Math.PI) / 360];
    device.quaternion.set(Math.cos(a) * Math.sin(b), Math.sin(a) * Math.cos(b), -Math.sin(a) * Math.sin(b), Math.cos(a) * Math.cos(b));
  };
  const inputs = () => (device.primaryInputMode === 'hand' ? device.hands : device.controllers);
  /** Where an input's pointing ray begins, and how it is turned: x, y, z, w. */
  headset.hold = (side, [x, y, z], [a, b, c, d] = [0, 0, 0, 1]) => {
    inputs()[side].position.set(x, y, z);
    inputs()[side].quaternion.set(a, b, c, d);
  };
  /** From a place of the room it points at another one. */
  headset.aim = (side, from, to) => {
    const way = to.map((value, i) => value - from[i]), level = Math.hypot(way[0], way[2]);
    const [turn, tilt] = [Math.atan2(-way[0], -way[2]) / 2, Math.atan2(way[1], level) / 2];
    headset.hold(side, from, [Math.cos(turn) * Math.sin(tilt), Math.sin(turn) * Math.cos(tilt), -Math.sin(turn) * Math.sin(tilt), Math.cos(turn) * Math.cos(tilt)]);
  };
  headset.press = (side, on) => {
    if (device.primaryInputMode === 'hand') device.hands[side].updatePinchValue(on ? 1 : 0);
    else device.controllers[side].updateButtonValue('trigger', on ? 1 : 0);
  };
  headset.squeeze = (side, on) => device.controllers[side].updateButtonValue('squeeze', on ? 1 : 0);
  headset.stand([0, 1.6, 0], 0, -15);
  headset.hold('left', [-0.25, 1.1, -0.3]);
  headset.hold('right', [0.25, 1.1, -0.3]);
}
