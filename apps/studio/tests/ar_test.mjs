// Augmented reality on a phone that emulates WebXR: placed, posed, moved, scaled, kept, with all that can go wrong.
//
//   node apps/studio/tests/ar_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, jointPlace, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { emulatePhone } from './xr_phone.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors, finger } = await openPhone('?sample=biped');

async function openPhone(search, options = {}) {
  const opened = await openStudio(browser, server.address, {
    width: 390, height: 844, touch: true, search, prepare: (context) => emulatePhone(context, options),
  });
  return { ...opened, finger: await opened.context.newCDPSession(opened.page) };
}
const frames = (count = 3) => page.evaluate((n) => new Promise((done) => {
  const next = () => (n-- > 0 ? requestAnimationFrame(next) : done());
  next();
}), count);
const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
async function stand(at, turn = 0, tilt = 0) {
  await page.evaluate((asked) => phone.stand(...asked), [at, turn, tilt]);
  await frames();
}
async function touch(type, points) {
  await page.evaluate((all) => { phone.fingers = new Map(all.map((point, id) => [id, point])); }, points);
  await finger.send('Input.dispatchTouchEvent', { type, touchPoints: points });
  await frames(2);
}
const shot = (name) => page.screenshot({ path: join(output, `ar_${name}.png`) });
const line = () => page.locator('#ar-line').textContent();

const cases = {
  async 'begins where the device can, and looks for a surface'() {
    await page.locator('#view-in-ar').tap();
    await page.waitForFunction(() => phone.session && document.querySelector('#ar-place')?.checkVisibility());
    await frames();
    assert.equal(await page.locator('#app').isVisible(), false);
    assert.match(await line(), /Tap to place/);
    await shot('placing');
  },
  async 'a tap places the model on the floor, facing the device'() {
    await touch('touchStart', [{ x: 200, y: 400 }]);
    await touch('touchEnd', []);
    await page.locator('#ar-pose').waitFor();
    await settled(page);
    await shot('placed');
  },
  async 'handles are dragged'() {
    await page.locator('#ar-pose').tap();
    await frames();
    await shot('posing');
    await page.locator('#ar .choice [data-value=move]').tap();
    const { joints } = await sessionState(page), { name } = joints.find(({ part }) => part === 'left hand');
    const at = await jointPlace(page, name), before = await jointPosition(page, name);
    await touch('touchStart', [at]);
    await touch('touchMove', [{ x: at.x - 20, y: at.y - 60 }]);
    await touch('touchEnd', []);
    await settled(page);
    assert.ok(apart(before, await jointPosition(page, name)) > 0.05);
    await shot('posed');
  },
  async 'everybody can use it'() {
    // The emulation shows the frames in a canvas of its own, outside the overlay.
    assert.deepEqual((await barriers(page)).filter((barrier) => !/^region: [^ ]* > canvas/.test(barrier)), []);
  },
  async 'the end puts the desk back, the scene is as posed'() {
    await page.locator('#ar-close').tap();
    await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
    await settled(page);
    assert.equal(await page.locator('#ar').count(), 0);
    await shot('desk');
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
