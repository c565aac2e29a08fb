// A phone in augmented reality, for tests: what a person does with it, and where things are then.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { barriers, openStudio, sessionState, settled } from './page.mjs';
import { emulatePhone } from './xr_phone.mjs';

/** The emulation of WebXR shows its frames in a canvas of its own, outside the overlay. */
export const overlayBarriers = async (page) => (await barriers(page)).filter((barrier) => !/^region: [^ ]* > canvas/.test(barrier));

/** The screen turned a quarter to the left, or upright again; by a CDP session of the page. */
export const turnScreen = (wire, landscape) => wire.send('Emulation.setDeviceMetricsOverride', {
  ...(landscape ? { width: 844, height: 390 } : { width: 390, height: 844 }), deviceScaleFactor: 1, mobile: false,
  screenOrientation: landscape ? { type: 'landscapePrimary', angle: 90 } : { type: 'portraitPrimary', angle: 0 },
});

/** Of the screen as it is turned: playwright's own turns it back. */
export async function pictureOfScreen(wire, path) {
  const { data } = await wire.send('Page.captureScreenshot');
  writeFileSync(path, Buffer.from(data, 'base64'));
}

export const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

/** `without`: features that it has not. Pictures go to the folder `output`. */
export async function openPhone(browser, address, output, search, { without = [] } = {}) {
  const { page, context, errors } = await openStudio(browser, address, {
    width: 390, height: 844, touch: true, search, prepare: (before) => emulatePhone(before, { without }),
  });
  const finger = await context.newCDPSession(page);

  const frames = (count = 3) => page.evaluate((n) => new Promise((done) => {
    const next = () => (n-- > 0 ? requestAnimationFrame(next) : done());
    next();
  }), count);
  async function stand(at, turn = 0, tilt = -20) {
    await page.evaluate((asked) => phone.stand(...asked), [at, turn, tilt]);
    await frames();
  }
  async function touch(type, points) {
    await page.evaluate((all) => { phone.fingers = new Map(all.map((point, id) => [id, point])); }, points);
    await finger.send('Input.dispatchTouchEvent', { type, touchPoints: points.map((point, id) => ({ ...point, id })) });
    await frames(2);
  }
  async function drag(from, to, steps = 4) {
    await touch('touchStart', [from]);
    for (let i = 1; i <= steps; ++i) await touch('touchMove', [{ x: from.x + ((to.x - from.x) * i) / steps, y: from.y + ((to.y - from.y) * i) / steps }]);
    await touch('touchEnd', []);
    await settled(page);
  }
  async function tap(spot) {
    await touch('touchStart', [spot]);
    await touch('touchEnd', []);
    await settled(page);
  }
  const shot = (name) => page.screenshot({ path: join(output, `ar_${name}.png`) });
  const line = () => page.locator('#ar-line').textContent();
  const says = (words) => page.waitForFunction((wanted) => document.querySelector('#ar-line').textContent.includes(wanted), words);
  const ar = (what, ...asked) => page.evaluate(([name, all]) => globalThis.limberStudio.ar[name](...all), [what, asked]);
  /** Pixels of the screen, and metres of the room. */
  const jointSpot = (name) => page.evaluate((joint) => globalThis.limberStudio.place(joint), name);
  const memberBase = (member) => ar('base', member);
  const middleOf = (member, up = 0.5) => page.evaluate((asked) => globalThis.limberStudio.memberPlace(...asked), [member, up]);
  const jointOf = async (part) => (await sessionState(page)).joints.find((joint) => joint.part === part).name;
  const placement = async (member = 0) => (await sessionState(page)).members[member].placement;
  async function enter() {
    await page.locator('#view-in-ar').tap();
    await page.waitForFunction(() => phone.session && document.querySelector('#ar-place')?.checkVisibility());
    await frames();
  }
  async function place() {
    await touch('touchStart', [{ x: 200, y: 400 }]);
    await touch('touchEnd', []);
    await page.locator('#ar-pose').waitFor();
    if (!await page.evaluate(() => document.querySelector('#ar-play path').getAttribute('d').startsWith('M7'))) await settled(page); // a clip that plays is never idle
  }
  async function leave() {
    await page.locator('#ar-close').tap();
    await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
    await settled(page);
  }
  async function pose(mode) {
    if (await page.locator('#ar-pose').getAttribute('aria-pressed') !== 'true') await page.locator('#ar-pose').tap();
    await page.locator(`#ar .choice [data-value=${mode}]`).tap();
    await frames();
  }
  /** Metres from the phone to a joint. */
  const distanceTo = async (name) => apart(await ar('joint', name), await page.evaluate(() => [phone.device.position.x, phone.device.position.y, phone.device.position.z]));

  return {
    page, context, errors, frames, stand, touch, drag, tap, shot, line, says, ar, jointSpot, memberBase, middleOf, jointOf, placement, enter, place, leave, pose, distanceTo, overlayBarriers: () => overlayBarriers(page),
  };
}
