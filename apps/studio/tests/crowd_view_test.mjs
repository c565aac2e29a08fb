// A crowd's file in the page: all its bodies, drawn where their matrices have them, moving, and gone once it is closed.
//
//   node apps/studio/tests/crowd_view_test.mjs DIST LIMBER OUTPUT_FOLDER [BODIES]
//
// BODIES: of the larger crowd, whose time a frame is printed; without a graphics card a frame of 500 takes seconds.
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const kPixels = 3; // between where points must be drawn and what is drawn

const [dist, program, output] = process.argv.slice(2, 5).map((path) => resolve(path));
const kBodies = Number(process.argv[5] ?? 40);
mkdirSync(output, { recursive: true });
const at = (name) => join(output, `crowd_${name}`);
const limber = (...words) => execFileSync(program, [...words, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
limber('sample', 'biped', '-o', at('person.glb'));
limber('rig', at('person.glb'), '--template', 'humanoid', '-o', at('rigged.glb'));
limber('sample', 'walk', '-o', at('walk.bvh'));
limber('crowd', at('rigged.glb'), '--motions', at('walk.bvh'), '--count', '3', '--in-place', '--loop', '--turn', '60', '-o', at('few.glb'));
limber('crowd', at('rigged.glb'), '--motions', at('walk.bvh'), '--count', String(kBodies), '--in-place', '--loop', '-o', at('many.glb'));

const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 1000, height: 700, deviceScaleFactor: 1, search: '?sample=biped' });
const all = [errors];

async function open(name, of = page) {
  await of.locator('#file').setInputFiles(at(name));
  await of.locator('#crowd').waitFor();
}

const close = async () => {
  await page.locator('#close-crowd').click();
  await page.locator('#crowd').waitFor({ state: 'detached' });
};

/** The box round what the bodies cover in the picture, and the box round their vertices as the matrices and places have them. */
const boxes = (seconds) => page.evaluate((moment) => {
  const { crowd, pixels, pixelOf } = globalThis.limberCrowd;
  const grown = () => ({ left: Infinity, right: -Infinity, low: Infinity, high: -Infinity });
  const take = (box, x, y) => {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.low = Math.min(box.low, y);
    box.high = Math.max(box.high, y);
  };
  const { width, height, bytes } = pixels(moment, true), { bytes: bare } = pixels(moment, false), drawn = grown(), wanted = grown();
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const i = 4 * (y * width + x);
      if ([0, 1, 2, 3].some((c) => Math.abs(bytes[i + c] - bare[i + c]) > 24)) take(drawn, x + 0.5, y + 0.5);
    }
  }
  const frame = Math.round((moment / crowd.seconds) * crowd.frames);
  for (const { build, table, row, place } of crowd.bodies) {
    const { positions, joints, weights } = crowd.builds[build], { matrices, joints: count } = crowd.tables[table];
    for (let v = 0; v < positions.length / 3; ++v) {
      const moved = [0, 0, 0];
      for (let k = 4 * v; k < 4 * v + 4; ++k) {
        for (let r = 0; r < 3; ++r) {
          const at = 12 * ((row + frame) * count + joints[k]) + 4 * r;
          moved[r] += weights[k] * (matrices[at] * positions[3 * v] + matrices[at + 1] * positions[3 * v + 1] + matrices[at + 2] * positions[3 * v + 2] + matrices[at + 3]);
        }
      }
      const world = [0, 1, 2].map((r) => place[r] * moved[0] + place[4 + r] * moved[1] + place[8 + r] * moved[2] + place[12 + r]);
      const { x, y } = pixelOf(world);
      take(wanted, x, y);
    }
  }
  return { drawn, wanted };
}, seconds);

const cases = {
  async 'a crowd opens over the model, which stays'() {
    const before = await sessionState(page);
    await open('few.glb');
    assert.match(await page.locator('#crowd h2').textContent(), /3 bodies/);
    assert.deepEqual(await barriers(page), []);
    assert.deepEqual((await sessionState(page)).joints, before.joints);
  },
  async 'bodies are drawn where their matrices have them'() {
    const { seconds, frames } = await page.evaluate(() => ({ seconds: globalThis.limberCrowd.crowd.seconds, frames: globalThis.limberCrowd.crowd.frames }));
    for (const frame of [0, Math.floor(frames / 3), frames]) {
      const { drawn, wanted } = await boxes((frame * seconds) / frames);
      for (const side of Object.keys(wanted)) assert.ok(Math.abs(drawn[side] - wanted[side]) < kPixels, `frame ${frame}: ${side} ${drawn[side]}, not ${wanted[side]}`);
    }
    await page.screenshot({ path: at('few.png') });
  },
  async 'it plays and pauses, by the keyboard too'() {
    const moment = () => page.locator('#scrub-crowd').inputValue();
    await page.locator('#play-crowd').focus();
    await page.keyboard.press('Enter');
    const begun = await moment();
    await page.waitForFunction((then) => document.querySelector('#scrub-crowd').value !== then, begun);
    await page.keyboard.press('Enter');
    const stood = await moment();
    await page.waitForTimeout(200);
    assert.equal(await moment(), stood);
    await close();
    await settled(page);
    assert.equal(await page.evaluate(() => globalThis.limberCrowd), undefined);
  },
  async 'a larger crowd is all there'() {
    await open('many.glb');
    await page.waitForFunction(() => globalThis.limberCrowd.placing.length > 0);
    const { bodies, vertices, placing } = await page.evaluate(() => {
      const { crowd, placing: times } = globalThis.limberCrowd;
      return { bodies: crowd.bodies.length, vertices: Math.min(...crowd.builds.map(({ positions }) => positions.length / 3)), placing: times };
    });
    assert.equal(bodies, kBodies);
    assert.ok(vertices >= 5000, `${vertices} vertices`);
    const median = placing.toSorted((a, b) => a - b)[Math.floor(placing.length / 2)];
    console.log(`${bodies} bodies of ${vertices} vertices: placed in ${median.toFixed(2)} ms a frame`);
    await page.keyboard.press('Escape');
    await page.locator('#crowd').waitFor({ state: 'detached' });
  },
  async 'on a small screen, in the dark, by touch'() {
    const hand = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, isMobile: true, colorScheme: 'dark', search: '?sample=biped' });
    all.push(hand.errors);
    await open('few.glb', hand.page);
    assert.deepEqual(await barriers(hand.page), []);
    await hand.page.locator('#play-crowd').tap();
    await hand.page.screenshot({ path: at('narrow.png') });
    await hand.context.close();
  },
  async 'nothing was thrown'() { assert.deepEqual(all.flat(), []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
