// How long the page takes for a frame on a headset, while a hand carries a handle: everything between the headset's call
// and its return, three.js and the calls of WebGL with it, but not what the graphics card does.
//
//   node tools/bench_headset.mjs DIST [SAMPLE] [HANDLES]
import { resolve } from 'node:path';
import { launch, openStudio, serve, sessionState, settled } from '../apps/studio/tests/page.mjs';
import { emulateHeadset } from '../apps/studio/tests/xr_headset.mjs';

const [dist, sample = 'winged', handles = '20'] = process.argv.slice(2), count = 100;
const server = await serve(resolve(dist)), browser = await launch();
const { page } = await openStudio(browser, server.address, { width: 400, height: 400, search: `?sample=${sample}`, prepare: (context) => emulateHeadset(context, { stereo: true }) });
await page.evaluate(() => {
  globalThis.spent = [];
  const { requestAnimationFrame: ask } = XRSession.prototype;
  XRSession.prototype.requestAnimationFrame = function (act) {
    return ask.call(this, (time, frame) => {
      const begun = performance.now();
      act(time, frame);
      globalThis.spent.push(performance.now() - begun);
    });
  };
});
for (let have = (await sessionState(page)).joints.length; have !== Number(handles); have = (await sessionState(page)).joints.length) {
  await page.locator(have < handles ? '#more-handles' : '#fewer-handles').click();
  await settled(page);
}
const frames = (n) => page.evaluate((left) => new Promise((done) => {
  const next = () => (left-- > 0 ? requestAnimationFrame(next) : done());
  next();
}), n);
const act = async (name, ...given) => {
  await page.evaluate(([call, all]) => headset[call](...all), [name, given]);
  await frames(3);
};
await page.locator('#view-in-ar').click();
await page.waitForFunction(() => globalThis.limberHeadset);
await act('aim', 'right', [0.2, 1.2, -0.2], [0, 0, -1.2]);
for (const on of [true, false]) await act('press', 'right', on);
await settled(page);
await page.evaluate(() => document.querySelector('#ar-pose').click());
await frames(5);

const measured = async (what) => {
  await page.evaluate(() => { globalThis.spent.length = 0; });
  await page.waitForFunction((n) => globalThis.spent.length >= n, count);
  const spent = (await page.evaluate(() => globalThis.spent)).slice(0, count).sort((a, b) => a - b);
  console.log(`${what.padEnd(28)} median ${spent[count / 2].toFixed(2)} ms   95 % below ${spent[Math.floor(0.95 * count)].toFixed(2)} ms   longest ${spent.at(-1).toFixed(2)} ms`);
};
const { vertices, joints } = await sessionState(page);
console.log(`${sample}: ${vertices} vertices, ${joints.length} handles, two controllers, both eyes`);
await measured('looking on');
const at = await page.evaluate((name) => limberHeadset.handle(name), joints.at(-1).name);
await page.evaluate((to) => {
  const { grip } = limberHeadset.hand('right'), { position } = headset.device.controllers.right;
  headset.hold('right', to.map((value, i) => value - (grip[i] - [position.x, position.y, position.z][i])));
}, at);
await frames(3);
await act('press', 'right', true);
await page.evaluate(() => {
  const { position } = headset.device.controllers.right, from = [position.x, position.y, position.z];
  let step = 0;
  const next = () => {
    headset.hold('right', from.map((value, i) => value + 0.1 * Math.sin(0.07 * ++step + i)));
    requestAnimationFrame(next);
  };
  next();
});
await measured('a handle carried in the hand');
await browser.close();
server.close();
