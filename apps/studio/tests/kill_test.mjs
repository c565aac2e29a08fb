// The tab is killed at any moment of a session; what was on the screen 0.3 s before is there when the page is opened again.
//
//   node apps/studio/tests/kill_test.mjs DIST OUTPUT_FOLDER
//
// LIMBER_ROUNDS: how often it is killed (default 6); LIMBER_SEED: another session (1 to 2^31 - 2). Prints by how much the oldest thing that was lost had been shown.
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { resolve } from 'node:path';
import { jointPlace, launch, runCases, sessionState, serve, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
const rounds = Number(process.env.LIMBER_ROUNDS ?? 6), sessionLength = 100; // deeds, then the next session begins
const leeway = 300; // milliseconds
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch(), errors = [];
const context = await browser.newContext({ viewport: { width: 900, height: 600 } });
let page = null, shown = [], slowest = 0, oldestLost = 0;

/** What is on the screen, told with each frame in which it differs. */
await context.exposeBinding('limberShown', (_, entry) => shown.push(entry));
await context.addInitScript(() => {
  const picture = () => {
    const state = globalThis.limberStudio?.state();
    if (!state) return '';
    const places = state.joints.map(({ name }) => globalThis.limberStudio.position(name).map((value) => Math.round(value * 1e4)));
    return JSON.stringify([state.name, state.ik, state.clip, state.clips.map(({ name, joint_keys: keys }) => [name, keys]), state.targets, places]);
  };
  let before = '', at = 0;
  globalThis.limberPicture = picture;
  const frame = () => {
    const now = performance.timeOrigin + performance.now(), drawn = picture();
    if (drawn !== before && drawn !== '') globalThis.limberShown({ drawn, from: now, steps: globalThis.limberStudio.steps() });
    before = drawn;
    globalThis.limberGap = Math.max(globalThis.limberGap ?? 0, at > 0 ? now - at : 0);
    at = now;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);

  // How long the browser's store takes for a write of somebody else.
  let begun = 0;
  const write = (database) => {
    begun = performance.now();
    const transaction = database.transaction('moments', 'readwrite');
    transaction.objectStore('moments').put(begun, 0);
    transaction.oncomplete = () => {
      globalThis.limberWrite = Math.max(globalThis.limberWrite ?? 0, performance.now() - begun);
      begun = 0;
      setTimeout(() => write(database), 50);
    };
  };
  const opened = indexedDB.open('another', 1);
  opened.onupgradeneeded = () => opened.result.createObjectStore('moments');
  opened.onsuccess = () => write(opened.result);
  /** Milliseconds of the longest frame and the longest write, those that are not over included. */
  globalThis.limberDelays = () => {
    const now = performance.now(), frameNow = performance.timeOrigin + now - at, writeNow = begun > 0 ? now - begun : 0;
    return { frame: Math.max(globalThis.limberGap ?? 0, frameNow), write: Math.max(globalThis.limberWrite ?? 0, writeNow) };
  };
});

// The same each time: a generator of its own.
let seed = Number(process.env.LIMBER_SEED ?? 11);
const random = (below) => {
  seed = (seed * 48271) % 2147483647;
  return seed % below;
};
const row = () => page.locator('#joints li').nth(random(8)).click();
const keys = async (key) => {
  await page.locator('main canvas').focus();
  await page.keyboard.press(key);
};
const enabled = async (id, act) => { if (await page.locator(id).isEnabled()) await act(page.locator(id)); };
const deeds = [
  async () => { await row(); await keys('ArrowRight'); },
  async () => { await row(); await keys('r'); await keys('ArrowUp'); await keys('g'); },
  async () => {
    const { joints } = await sessionState(page), { x, y } = await jointPlace(page, joints[random(joints.length)].name);
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let i = 1; i <= 6; ++i) await page.mouse.move(x + 6 * i, y - 4 * i);
    await page.mouse.up();
  },
  () => keys('Control+z'),
  () => keys('Control+Shift+Z'),
  () => keys('m'),
  () => keys('i'),
  () => enabled('#add-clip', (button) => button.click()),
  () => keys('k'),
  () => enabled('#scrub', (slider) => slider.fill(String(random(20) / 10))),
  () => enabled('#play', (button) => button.click()),
  async () => { await row(); await enabled('#pin', (button) => button.click()); },
];

async function open(search = '') {
  page = await context.newPage();
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  await page.goto(server.address + search);
  await settled(page);
}

/** Gives when the tab died. */
async function kill() {
  const devtools = await context.newCDPSession(page), died = new Promise((resolve) => page.once('crash', resolve));
  const { frame, write } = await page.evaluate(() => globalThis.limberDelays());
  slowest = Math.max(slowest, frame, write);
  const at = Date.now();
  devtools.send('Page.crash').catch(() => {});
  await died;
  return at;
}

const cases = {
  async 'killed at any moment, what was shown 0.3 s before is there again'() {
    let done = sessionLength;
    for (let round = 0; round < rounds; ++round) {
      if (done >= sessionLength) {
        await page?.close();
        await open('?sample=biped');
        done = 0;
      }
      shown = shown.slice(-1);
      let end, alive = true;
      const ended = new Promise((resolve) => { end = resolve; });
      await page.evaluate(() => { globalThis.limberGap = globalThis.limberWrite = 0; });
      const busy = (async () => {
        while (alive) {
          const deed = deeds[random(deeds.length)]().catch((error) => { if (alive) throw error; });
          await Promise.race([deed, ended]); // some wait for ever on a page that was killed
          ++done;
        }
      })();
      await Promise.race([busy, new Promise((wait) => setTimeout(wait, 300 + random(3000)))]);
      alive = false;
      end();
      const died = await kill();
      await busy;
      const last = shown.filter(({ from }) => from <= died);
      await page.close().catch(() => {});
      await open();
      const { drawn, steps } = await page.evaluate(() => ({ drawn: globalThis.limberPicture(), steps: globalThis.limberStudio.steps() }));
      const there = last.findLastIndex((entry) => entry.drawn === drawn);
      // What came back may never have been drawn, as a moment between two frames: then the first picture of more steps is lost.
      const lost = there >= 0 ? last[there + 1] : last.find((entry) => entry.steps > steps);
      const age = lost ? died - lost.from : 0;
      oldestLost = Math.max(oldestLost, age);
      assert.ok(age <= leeway + slowest, `round ${round}: what had been shown for ${age.toFixed(0)} ms is lost`);
    }
    console.log(`   ${rounds} kills: what was lost had been shown for ${oldestLost.toFixed(0)} ms at most (longest frame or write ${slowest.toFixed(0)} ms)`);
  },
  'nothing was thrown'() { assert.deepEqual(errors, []); },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exitCode = failed > 0 ? 1 : 0;
