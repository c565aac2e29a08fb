// Figures of the page that depend on the machine, so no test asserts them: what a drag of a large model costs, how long a
// large OBJ takes to open.
//
//   node apps/studio/tests/measure.mjs DIST
import { resolve } from 'node:path';
import { jointPlace, launch, openStudio, serve, sessionState, settled } from './page.mjs';

const server = await serve(resolve(process.argv[2])), browser = await launch();
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)]?.toFixed(2);

/** A sphere with bumps, each vertex once, in quads and two caps of triangles. */
function bumpyObj(rings, around) {
  const lines = ['v 0 1 0', 'v 0 -1 0'], at = (ring, i) => 3 + ring * around + (i % around);
  for (let ring = 0; ring < rings; ++ring) {
    for (let i = 0; i < around; ++i) {
      const polar = (Math.PI * (ring + 1)) / (rings + 1), turn = (2 * Math.PI * i) / around, r = 1 + 0.2 * Math.sin(3 * turn) * Math.sin(2 * polar);
      lines.push(`v ${r * Math.sin(polar) * Math.cos(turn)} ${r * Math.cos(polar)} ${r * Math.sin(polar) * Math.sin(turn)}`);
    }
  }
  for (let i = 0; i < around; ++i) {
    lines.push(`f 1 ${at(0, i + 1)} ${at(0, i)}`, `f 2 ${at(rings - 1, i)} ${at(rings - 1, i + 1)}`);
    for (let ring = 1; ring < rings; ++ring) lines.push(`f ${at(ring - 1, i)} ${at(ring - 1, i + 1)} ${at(ring, i + 1)} ${at(ring, i)}`);
  }
  return lines.join('\n');
}

async function drag() {
  const { page, context } = await openStudio(browser, server.address, { search: '?sample=winged', width: 900, height: 600 });
  const [worker] = page.workers();
  await worker.evaluate(() => {
    const take = globalThis.onmessage, post = globalThis.postMessage.bind(globalThis), begun = new Map();
    globalThis.limberTimes = [];
    globalThis.onmessage = (event) => {
      if (event.data.request.command?.do === 'update_drag') begun.set(event.data.id, performance.now());
      take(event);
    };
    globalThis.postMessage = (message, ...more) => {
      post(message, ...more);
      if (message.kind === 'done' && begun.has(message.id)) globalThis.limberTimes.push(performance.now() - begun.get(message.id));
    };
  });
  await page.evaluate(() => {
    globalThis.limberFrames = 0;
    const count = () => { ++globalThis.limberFrames; requestAnimationFrame(count); };
    requestAnimationFrame(count);
  });
  const { joints, vertices } = await sessionState(page), name = joints.at(-1).name, from = await jointPlace(page, name);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  const before = await page.evaluate(() => globalThis.limberFrames);
  for (let i = 1; i <= 300; ++i) await page.mouse.move(from.x + 60 * Math.sin(i / 20), from.y - 60 * Math.sin(i / 33));
  const frames = await page.evaluate(() => globalThis.limberFrames) - before;
  await page.mouse.up();
  await settled(page);
  const times = await worker.evaluate(() => globalThis.limberTimes);
  console.log(`drag, ${vertices} vertices, ${joints.length} joints: median ${median(times)} ms in the worker, from request to answer; ${times.length} answers in ${frames} frames`);
  await context.close();
}

async function large() {
  const { page, context } = await openStudio(browser, server.address, { search: '?sample=stool', width: 900, height: 600 });
  const rings = 199, around = 251, written = rings * around + 2, obj = Buffer.from(bumpyObj(rings, around));
  const times = [];
  for (let i = 0; i < 3; ++i) {
    await page.evaluate(() => {
      document.querySelector('#file').addEventListener('change', () => {
        const begun = performance.now(), look = () => {
          if (globalThis.limberStudio.state().name === globalThis.limberWanted) globalThis.limberTook = performance.now() - begun;
          else setTimeout(look, 5);
        };
        look();
      }, { once: true, capture: true });
    });
    await page.evaluate((name) => { globalThis.limberWanted = name; globalThis.limberTook = 0; }, `large_${i}.obj`);
    await page.locator('#file').setInputFiles({ name: `large_${i}.obj`, mimeType: 'model/obj', buffer: obj });
    await page.waitForFunction(() => globalThis.limberTook > 0);
    times.push(await page.evaluate(() => globalThis.limberTook));
    await settled(page);
  }
  const { vertices } = await sessionState(page);
  console.log(`OBJ of ${written} vertices (${(obj.length / 1e6).toFixed(1)} MB): ${vertices} vertices, with handles after ${times.map((ms) => (ms / 1000).toFixed(2)).join(', ')} s`);
  await context.close();
}

await drag();
await large();
await browser.close();
server.close();
