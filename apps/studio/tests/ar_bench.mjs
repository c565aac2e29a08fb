// What a frame of augmented reality costs the page, on an emulated phone: the whole of the session's callback, with three's
// draw calls, while a handle is dragged and the phone moves.
//
//   node apps/studio/tests/ar_bench.mjs DIST
import { resolve } from 'node:path';
import { launch, openStudio, serve, sessionState, settled } from './page.mjs';
import { emulatePhone } from './xr_phone.mjs';

const frames = 120;
const [dist] = process.argv.slice(2).map((path) => resolve(path));
const server = await serve(dist), browser = await launch();
const { page, context } = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=winged', prepare: (before) => emulatePhone(before) });
const finger = await context.newCDPSession(page);
const touch = (type, touchPoints) => finger.send('Input.dispatchTouchEvent', { type, touchPoints });

await page.evaluate(() => {
  globalThis.costs = [];
  const { requestAnimationFrame: ask } = XRSession.prototype;
  XRSession.prototype.requestAnimationFrame = function (act) {
    return ask.call(this, (...frame) => {
      const begun = performance.now();
      act(...frame);
      costs.push(performance.now() - begun);
    });
  };
});

/** Milliseconds: the median and the 95th percentile of the frames of a drag. */
async function measured() {
  const joint = (await sessionState(page)).joints.at(-1).name, at = await page.evaluate((name) => globalThis.limberStudio.place(name), joint);
  await touch('touchStart', [at]);
  await page.evaluate(() => { costs.length = 0; });
  for (let i = 1; i <= 10; ++i) {
    await touch('touchMove', [{ x: at.x + 3 * i, y: at.y }]);
    await page.evaluate(([step, count]) => new Promise((done) => {
      const until = costs.length + count;
      const look = () => {
        phone.stand({ x: 0.01 * step + 0.0005 * (until - costs.length), y: 1.5, z: 0 }, 0, -20);
        if (costs.length < until) requestAnimationFrame(look);
        else done();
      };
      look();
    }), [i, frames / 10]);
  }
  const sorted = await page.evaluate(() => [...costs].sort((a, b) => a - b));
  await touch('touchEnd', []);
  await settled(page);
  return [0.5, 0.95].map((part) => sorted[Math.floor(part * sorted.length)].toFixed(2));
}

await page.locator('#view-in-ar').tap();
await page.waitForFunction(() => globalThis.phone.session && document.querySelector('#ar-place')?.checkVisibility());
const place = async () => {
  await page.waitForFunction(() => globalThis.limberStudio.idle());
  await page.locator('#ar-place').tap();
  await page.locator('#ar-pose').waitFor();
  await settled(page);
};
await place();
await page.locator('#ar-pose').tap();
for (const models of [1, 3]) {
  for (let more = 1; more < models; ++more) {
    await page.locator('#ar #open-add').tap();
    await page.locator('#ar #add-member [data-sample=winged]').tap();
    await page.waitForFunction((count) => globalThis.limberStudio.state().members.length === count, more + 1);
    await place();
  }
  if (models > 1) await page.locator('#ar-pose').tap();
  const { vertices, joints } = await sessionState(page), [median, most] = await measured();
  console.log(`AR frame, ${models} x ${vertices} vertices, ${joints.length} handles: median ${median} ms, 95 % below ${most} ms`);
}
await browser.close();
server.close();
