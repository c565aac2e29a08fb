// How long the tracker takes for a picture of the card, of 640 x 480 pixels, without the browser: what its worker does
// between the picture's pixels and the camera's place. A camera on its way round the card, with blur and noise.
//
//   node tools/bench_card.mjs
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { drawn, opened, poseFrom, side, height, width } from '../apps/studio/tests/card_film.mjs';
const { createServer } = await import(createRequire(new URL('../apps/studio/package.json', import.meta.url)).resolve('vite').replace(/index\.cjs$/, 'dist/node/index.js'));

const server = await createServer({ root: fileURLToPath(new URL('../apps/studio', import.meta.url)), server: { middlewareMode: true, hmr: false, watch: null }, appType: 'custom', logLevel: 'error' });
const load = (name) => server.ssrLoadModule(`/src/ar/card/${name}.ts`);
const { Tracker } = await load('tracker'), { FocalSearch } = await load('focal_search'), { lensOf } = await load('pose');
const { greyOf } = await load('picture'), { cardId, dictionary } = await load('card');
const { AR } = await server.ssrLoadModule('js-aruco2/src/aruco.js'), code = AR.DICTIONARIES[dictionary].codeList[cardId];

const path = (seconds) => poseFrom(0.4 + 0.1 * Math.sin(seconds), 45 + 10 * Math.cos(seconds), 30 * seconds), lens = lensOf(width, height, 50), count = 24, rounds = 10;
const pictures = Array.from({ length: count }, (_, i) => {
  const { data } = drawn(opened(path, i / 12), lens.focal, code, { seed: i, perSide: 2 }), rgba = new Uint8ClampedArray(4 * data.length);
  data.forEach((value, at) => rgba.fill(value, 4 * at, 4 * at + 4));
  return rgba;
});
const blank = pictures[0].slice().fill(180, 4 * width * 120, 4 * width * 360); // a sheet of paper over it

/** Processor time: other programs do not count. */
function measured(what, all) {
  const spent = [], tracker = new Tracker(side), search = new FocalSearch(side, lens);
  for (let round = 0; round < rounds; ++round) {
    const begun = process.cpuUsage();
    for (const rgba of all) {
      tracker.follow(greyOf(width, height, rgba), search.lens);
      if (tracker.corners) search.learn(tracker.corners);
    }
    const { user, system } = process.cpuUsage(begun);
    spent.push((user + system) / 1000 / all.length);
  }
  spent.shift(); // warms up
  spent.sort((a, b) => a - b);
  console.log(`${what.padEnd(24)} ${spent[spent.length >> 1].toFixed(1)} ms a picture (median of ${spent.length} rounds of ${all.length}, at most ${spent.at(-1).toFixed(1)} ms)`);
}
measured('the card moves', pictures);
measured('no card in it', Array(count).fill(blank));
await server.close();
