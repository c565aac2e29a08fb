// From opening the page to the first pose, as a phone of some years ago has it: a narrow screen, touch, the page's own
// thread slowed (Emulation.setCPUThrottlingRate, which leaves workers as fast as they are).
//
//   node tools/bench_first_minute.mjs DIST NATIVE_PROGRAM WORK_FOLDER [RATE]
//
// Two ways to it: the page's own first model and one drag; and a file of about ten thousand vertices, opened and dragged.
// The best of several runs counts. All is served from this machine, so that no network is in it. The picture is drawn by the
// processor, which a phone leaves to its graphics chip: each way is gone once more with every call of WebGL that draws left
// out, and the difference is the drawing.
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { jointPlace, launch, serve, sessionState } from '../apps/studio/tests/page.mjs';

const [dist, program, work] = process.argv.slice(2, 5).map((path) => resolve(path)), rate = Number(process.argv[5] ?? 4), runs = 3;
mkdirSync(work, { recursive: true });
const file = join(work, 'ten_thousand.glb');
execFileSync(program, ['sample', 'winged', '-o', file, '--quiet']);

const server = await serve(dist), browser = await launch();
/** When the worker is asked and answers, in milliseconds since the page was asked for. */
function listen() {
  const marks = globalThis.marks = {}, Plain = globalThis.Worker;
  const mark = (name) => { marks[name] ??= performance.now(); };
  globalThis.Worker = class extends Plain {
    constructor(...given) {
      super(...given);
      mark('worker started');
      this.addEventListener('message', ({ data }) => {
        if (data.kind === 'ready') mark('engine ready');
        if (data.kind === 'done' && data.answer?.model) mark('model rigged');
      });
    }
  };
}
function leaveOutDrawing() {
  for (const name of ['clear', 'drawArrays', 'drawArraysInstanced', 'drawElements', 'drawElementsInstanced']) WebGL2RenderingContext.prototype[name] = () => {};
}
const settled = () => globalThis.limberStudio?.idle() && globalThis.limberStudio.state();

async function firstPose(own, drawing) {
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const page = await context.newPage(), wire = await context.newCDPSession(page);
  await wire.send('Emulation.setCPUThrottlingRate', { rate });
  await page.addInitScript(listen);
  if (!drawing) await page.addInitScript(leaveOutDrawing);
  const now = () => page.evaluate(() => performance.now());
  const shown = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.goto(server.address + (own ? '' : '?sample=stool'), { waitUntil: 'commit' });
  await page.waitForFunction(settled, null, { polling: 'raf' });
  let begun = 0;
  if (!own) {
    await shown();
    begun = await now();
    await page.locator('#file').setInputFiles(file);
    await page.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.state().name.startsWith('ten'), null, { polling: 'raf' });
  }
  await shown();
  const drawn = await now(), { joints, vertices } = await sessionState(page), joint = joints.at(-1).name;
  const frame = await page.evaluate(() => new Promise((done) => {
    const from = performance.now();
    requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now() - from)));
  }));
  const place = await jointPlace(page, joint);
  const touch = (type, ...points) => wire.send('Input.dispatchTouchEvent', { type, touchPoints: points });
  const from = await now();
  await touch('touchStart', place);
  await touch('touchMove', { x: place.x + 20, y: place.y - 30 });
  await touch('touchEnd');
  await page.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.state().undo === 'end_drag', null, { polling: 'raf' });
  await shown();
  const posed = await now(), marks = await page.evaluate(() => globalThis.marks);
  await context.close();
  return { vertices, ...(own ? marks : {}), 'model on the screen': drawn - begun, 'drag, until it is drawn': posed - from, 'first pose': drawn - begun + posed - from, 'two frames alone': frame };
}

for (const [own, drawing] of [[true, true], [true, false], [false, true], [false, false]]) {
  const all = [];
  for (let run = 0; run < runs; ++run) all.push(await firstPose(own, drawing));
  const way = own ? 'the page is opened, a joint is dragged (1 action)' : 'a file is opened, a joint is dragged (2 actions), in the page that is there';
  console.log(`${way}, slowed ${rate} times${drawing ? '' : ', without the drawing'}`);
  for (const name of Object.keys(all[0])) {
    const least = Math.min(...all.map((one) => one[name]));
    console.log(`  ${name.padEnd(26)}${name === 'vertices' ? String(least).padStart(8) : `${least.toFixed(0).padStart(8)} ms`}`);
  }
}
await browser.close();
server.close();
