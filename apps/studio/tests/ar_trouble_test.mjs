// What can go wrong in augmented reality on a phone, and what the device can lack: each leaves a message and nothing lost.
//
//   node apps/studio/tests/ar_trouble_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { resolve } from 'node:path';
import { apart, openPhone } from './ar_phone.mjs';
import { jointPosition, launch, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
let phone, whole = false;

/** The phone at the desk with a person, the one of the case before where that ended well; with `options` another one. */
async function onPhone(steps, { search = '?sample=biped', ...options } = {}) {
  if (options.without || !whole) {
    await phone?.context.close();
    phone = await openPhone(browser, server.address, output, search, options);
  }
  whole = false;
  await steps(phone);
  assert.deepEqual(phone.errors, []);
  whole = true;
}

const cases = {
  async 'no surface: help after some seconds, and a place all the same'() {
    await onPhone(async ({ page, shot, line, says, memberBase, enter, leave }) => {
      await page.evaluate(() => { phone.room.floor = false; });
      await enter();
      assert.match(await line(), /Point the device/);
      await says('No surface found yet');
      await shot('no_surface');
      await page.locator('#ar-place').tap();
      await page.locator('#ar-pose').waitFor();
      assert.ok(Math.abs((await memberBase(0))[2] + 1.2) < 0.01);
      await leave();
      await page.evaluate(() => { phone.room.floor = true; });
    });
  },
  async 'lost places, hidden pages and a session that ends in the middle of a drag lose nothing'() {
    await onPhone(async ({ page, touch, shot, says, jointSpot, jointOf, enter, place, leave, pose }) => {
      await enter();
      await place();
      await pose('move');
      const name = await jointOf('left hand');
      for (const [what, interrupt, resume] of [
        ['The place is lost', () => { phone.poseLost = true; }, () => { phone.poseLost = false; }],
        ['Waiting', () => phone.device.updateVisibilityState('hidden'), () => phone.device.updateVisibilityState('visible')],
        ['Waiting', () => {
          Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
          document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
        }, () => {
          delete document.visibilityState;
          document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
        }],
      ]) {
        const at = await jointSpot(name);
        await touch('touchStart', [at]);
        await touch('touchMove', [{ x: at.x - 15, y: at.y - 20 }]);
        await page.evaluate(interrupt);
        await says(what);
        await settled(page);
        if (what !== 'Waiting') await shot('lost');
        const { dragged, undo } = await sessionState(page), stood = await jointPosition(page, name);
        assert.equal(dragged, null);
        assert.equal(undo, 'end_drag');
        await page.evaluate(resume);
        await says('Drag a handle');
        await touch('touchMove', [{ x: at.x - 40, y: at.y - 40 }]);
        await touch('touchEnd', []);
        await settled(page);
        assert.ok(apart(stood, await jointPosition(page, name)) < 1e-6);
      }
      const at = await jointSpot(name);
      await touch('touchStart', [at]);
      await touch('touchMove', [{ x: at.x + 15, y: at.y + 20 }]);
      await page.evaluate(() => phone.session.end());
      await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
      await settled(page);
      assert.match(await page.locator('#notice').textContent(), /The device has ended augmented reality/);
      assert.equal((await sessionState(page)).dragged, null);
      await touch('touchEnd', []);
      await shot('ended');
      // Once more works.
      await page.locator('#close-notice').tap();
      await enter();
      await place();
      await leave();
    });
  },
  async 'a browser that refuses says so, and the desk stays'() {
    await onPhone(async ({ page, enter, leave }) => {
      await page.evaluate(() => { phone.refuse = 'NotSupportedError'; });
      await page.locator('#view-in-ar').tap();
      await page.locator('#notice').waitFor();
      assert.match(await page.locator('#notice').textContent(), /does not begin augmented reality/);
      assert.equal(await page.locator('#ar').count(), 0);
      assert.equal(await page.locator('#app').isVisible(), true);
      await page.evaluate(() => { phone.refuse = null; });
      await enter();
      assert.equal(await page.locator('#ar #notice').isVisible(), false, 'what failed before is told no more');
      await leave();
    });
  },
  async 'the real light, where the device estimates it'() {
    await onPhone(async ({ page, frames, shot, middleOf, enter, place, leave }) => {
      await enter();
      await place();
      const brightness = async () => {
        const { x, y } = await middleOf(0, 0.7), png = await page.screenshot({ clip: { x: x - 3, y: y - 3, width: 6, height: 6 } });
        return page.evaluate(async (bytes) => {
          const bitmap = await createImageBitmap(new Blob([new Uint8Array(bytes)])), canvas = document.createElement('canvas');
          canvas.getContext('2d').drawImage(bitmap, 0, 0);
          const { data } = canvas.getContext('2d').getImageData(2, 2, 1, 1);
          return data[0] + data[1] + data[2];
        }, [...png]);
      };
      const soft = await brightness();
      await page.evaluate(() => {
        phone.room.light = { sphericalHarmonicsCoefficients: new Float32Array(27).fill(0.02), primaryLightIntensity: { x: 0.05, y: 0.05, z: 0.05 }, primaryLightDirection: { x: 0, y: 1, z: 0 } };
      });
      await frames(6);
      const dark = await brightness();
      assert.ok(dark < 0.6 * soft, `${dark} against ${soft}`);
      await shot('dark_room');
      await leave();
    });
  },
  async 'without an overlay, anchors, light and hit tests it is still placed and posed'() {
    await onPhone(async ({ page, frames, jointSpot, enter, pose }) => {
      await enter();
      const screen = async (phase, spot) => {
        await page.evaluate(([name, at]) => phone.touchScreen(name, at), [phase, spot]);
        await frames(4);
      };
      await page.locator('#ar-place').tap();
      await page.locator('#ar-pose').waitFor();
      await pose('move');
      const name = (await sessionState(page)).joints.at(-1).name, at = await jointSpot(name), before = await jointPosition(page, name);
      await screen('down', at);
      await screen('move', { x: at.x + 20, y: at.y - 20 });
      const held = await jointSpot(name);
      assert.ok(Math.hypot(held.x - at.x - 20, held.y - at.y + 20) < 2, JSON.stringify([at, held]));
      await screen('up', at);
      await settled(page);
      assert.ok(apart(before, await jointPosition(page, name)) > 0.01);
    }, { search: '?sample=stool', without: ['dom-overlay', 'anchors', 'light-estimation', 'hit-test'] });
  },
};

const failed = await runCases(cases, () => phone.page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
