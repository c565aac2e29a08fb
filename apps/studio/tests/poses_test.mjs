// Poses as things of their own: copied and pasted, a library of them on the user's own character, the user's own kept,
// as files and back.
//
//   node apps/studio/tests/poses_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, download, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { width: 1280, height: 800, search: '?sample=biped' });
const { page, errors } = desk;

const sample = (name, at = page) => at.locator(`#pose-samples [data-pose="${name}"]`);
const own = (name, at = page) => at.locator(`#pose-own [data-pose="${name}"]`);
const openLibrary = async (at = page) => {
  await at.locator('#open-poses').click();
  await at.locator('#poses').waitFor();
};
/** Once it is seen, and how it looks is known. */
async function tried(card) {
  await card.scrollIntoViewIfNeeded();
  await card.and(card.page().locator(':not([aria-busy])')).waitFor();
}
const closed = (at = page) => at.locator('#poses').waitFor({ state: 'hidden' });
const colored = (card) => card.locator('canvas').evaluate((canvas) => {
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return data.filter((value, i) => i % 4 === 3 && value > 200).length;
});
async function places(at = page) {
  const { joints } = await sessionState(at), all = [];
  for (const { name } of joints) all.push(await jointPosition(at, name));
  return all;
}
const farthest = (a, b) => Math.max(...a.map((place, joint) => Math.hypot(...place.map((value, i) => value - b[joint][i]))));
const keys = async (key, at = page) => {
  await at.locator('main canvas').focus();
  await at.keyboard.press(key);
  await settled(at);
};
/** Chosen, and on the model. */
async function apply(card, at = page) {
  await tried(card);
  await card.click();
  await closed(at);
  await at.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.state().undo === 'apply_pose');
  await settled(at);
}

const expectNoBarriers = async (at, state) => assert.deepEqual(await barriers(at), [], state);
/** Files dropped on the page. */
const drop = (files) => page.evaluate((all) => {
  const transfer = new DataTransfer();
  for (const [name, text] of all) transfer.items.add(new File([text], name));
  dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, cancelable: true }));
}, files);
const opened = async (name) => {
  await page.locator('#samples').selectOption(name);
  await page.waitForFunction((wanted) => globalThis.limberStudio.state()?.name === wanted, name);
  await settled(page);
};
let waving = '';

const cases = {
  async 'the library shows poses on the character, and a click puts it into one'() {
    const before = await sessionState(page), stood = await places();
    await openLibrary();
    await tried(sample('sit'));
    assert.ok(await colored(sample('sit')) > 500, 'nothing is drawn');
    assert.deepEqual(await sessionState(page), before, 'the document was changed');
    await page.screenshot({ path: join(output, 'poses.png') });
    await expectNoBarriers(page, 'the library');
    await apply(sample('wave'));
    assert.ok(farthest(await places(), stood) > 0.3);
    await page.screenshot({ path: join(output, 'poses_wave.png') });
    await page.locator('#undo').click();
    await settled(page);
    assert.equal(farthest(await places(), stood), 0);
  },
  async 'a pose for another kind of body is grey and says why'() {
    await openLibrary();
    await tried(sample('animal-howl'));
    assert.equal(await sample('animal-howl').getAttribute('aria-disabled'), 'true');
    assert.match(await sample('animal-howl').textContent(), /another kind of body/);
    await sample('animal-howl').click({ force: true });
    assert.ok(await page.locator('#poses').isVisible());
  },
  async 'arrows go from card to card, Enter chooses'() {
    await tried(sample('stand'));
    await sample('stand').focus();
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.pose), 'walk');
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('Enter');
    await closed();
    await page.waitForFunction(() => globalThis.limberStudio.state().undo === 'apply_pose');
    await settled(page);
  },
  async 'a pose is copied and pasted at another time, on the same joints to the last bit, and mirrored'() {
    await openLibrary();
    await apply(sample('wave'));
    const waved = await places();
    await keys('Control+c');
    await page.locator('#reset').click();
    await settled(page);
    await keys('Control+v');
    assert.equal(farthest(await places(), waved), 0);
    const steps = (await sessionState(page)).undo;
    await keys('Control+Shift+V');
    assert.equal((await sessionState(page)).undo, steps);
    assert.ok(farthest(await places(), waved) > 0.3);
    // The highest hand is on the other side now.
    const highest = (all) => all.reduce((top, place) => (place[1] > top[1] && Math.abs(place[0]) > 0.15 ? place : top), [0, -1, 0]);
    assert.ok(highest(waved)[0] * highest(await places())[0] < 0);
  },
  async 'with a clip shown what is pasted becomes a key'() {
    await page.locator('#add-clip').click();
    await settled(page);
    await page.locator('#paste-pose').click();
    await settled(page);
    assert.equal((await sessionState(page)).clips[0].keys.length, 1);
    await page.locator('#scrub').fill('1');
    await settled(page);
    await openLibrary();
    await tried(sample('sit'));
    await sample('sit').click();
    await page.waitForFunction(() => globalThis.limberStudio.state().clips[0].keys.length === 2);
    await settled(page);
  },
  async 'a pose is saved under a name, renamed, downloaded and deleted'() {
    await openLibrary();
    await page.locator('#pose-name').fill('on a chair');
    await page.locator('#save-pose').click();
    await tried(own('on a chair'));
    assert.ok(await colored(own('on a chair')) > 500, 'nothing is drawn');
    await page.getByRole('button', { name: 'Rename on a chair' }).click();
    await page.locator('#rename').fill('sitting');
    await page.keyboard.press('Enter');
    await tried(own('sitting'));
    const file = await download(page, () => page.getByRole('button', { name: 'Save sitting as a file' }).click());
    waving = file.toString();
    assert.equal(JSON.parse(waving).name, 'sitting');
    assert.equal(JSON.parse(waving).limber_pose, 1);
    await page.screenshot({ path: join(output, 'poses_own.png') });
    await expectNoBarriers(page, 'own poses');
    await page.getByRole('button', { name: 'Rename sitting' }).click();
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('#poses').isVisible());
    await page.locator('#close-poses').click();
    await closed();
  },
  async 'own poses are there on another model after a reload; one that does not fit keeps its picture'() {
    await page.reload();
    await settled(page);
    await opened('quadruped');
    await openLibrary();
    await tried(own('sitting'));
    assert.equal(await own('sitting').getAttribute('aria-disabled'), 'true');
    await page.waitForFunction(() => {
      const { data } = document.querySelector('#pose-own canvas').getContext('2d').getImageData(0, 0, 264, 198);
      return data.filter((value, i) => i % 4 === 3 && value > 200).length > 500;
    });
    await apply(sample('animal-sit'));
    await page.screenshot({ path: join(output, 'poses_fox.png') });
    await openLibrary();
    await page.getByRole('button', { name: 'Delete sitting' }).click();
    await own('sitting').waitFor({ state: 'detached' });
    await page.locator('#close-poses').click();
    await closed();
  },
  async 'a pose file that is dropped is put on at once and kept; several are kept'() {
    await opened('biped');
    const stood = await places();
    await drop([['my chair.pose.json', waving]]);
    await page.waitForFunction(() => globalThis.limberStudio.state().undo === 'apply_pose');
    await settled(page);
    assert.ok(farthest(await places(), stood) > 0.1);
    await drop([['one.pose.json', waving.replace('"sitting"', '"one"')], ['two.json', waving.replace('"sitting"', '"two"')]]);
    await tried(own('two'));
    await tried(own('one'));
    await tried(own('sitting'));
    await page.locator('#close-poses').click();
    await closed();
  },
  async 'a faulty file says what is wrong, and nothing changes'() {
    const before = await sessionState(page);
    for (const [text, told] of [['{', /JSON/i], ['{"limber_pose": 1, "joints": [{"name": "a", "parent": "b"}]}', /no joint before/], ['{"limber_pose": 9}', /no pose that limber knows/]]) {
      await drop([['bad.pose.json', text]]);
      await page.waitForFunction((source) => new RegExp(source, 'i').test(document.querySelector('#notice')?.textContent ?? ''), told.source);
      assert.match(await page.locator('#notice').textContent(), /bad\.pose\.json/);
    }
    await page.screenshot({ path: join(output, 'poses_faulty.png') });
    assert.deepEqual(await sessionState(page), before);
  },
  async 'only the selected joint and what hangs on it, where that is asked for'() {
    const { joints } = await sessionState(page);
    const head = joints.findIndex(({ part }) => part === 'head');
    assert.ok(head >= 0);
    await page.locator('#joints li').nth(head).click();
    const before = await places();
    await openLibrary();
    await page.locator('#pose-partly').check();
    await apply(sample('bow'));
    const after = await places(), hips = joints.findIndex(({ parent }) => parent < 0);
    assert.deepEqual(after[hips], before[hips]);
    assert.ok(farthest(after.filter((_, joint) => joint !== head && joints[joint].parent !== head), before.filter((_, joint) => joint !== head && joints[joint].parent !== head)) < 1e-6);
  },
  async 'where the browser keeps nothing it says so, and the pose stays while the page lives'() {
    const context = await browser.newContext({ viewport: { width: 900, height: 700 } }), other = await context.newPage();
    await other.addInitScript(() => { Object.defineProperty(globalThis, 'indexedDB', { value: { open: () => { throw new Error('no storage'); } } }); });
    await other.goto(`${server.address}?sample=biped`);
    await settled(other);
    await openLibrary(other);
    await other.locator('#pose-name').fill('mine');
    await other.keyboard.press('Enter');
    await tried(own('mine', other));
    await other.waitForFunction(() => /cannot keep your poses/.test(document.querySelector('#notice')?.textContent ?? ''));
    await other.locator('#close-poses').click();
    await openLibrary(other);
    await tried(own('mine', other));
    await context.close();
  },
  async 'by touch on a small screen in the dark, in German'() {
    const { page: at, context, errors: thrown } = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped&language=de' });
    await at.emulateMedia({ colorScheme: 'dark', reducedMotion: 'reduce' });
    await at.locator('#open-poses').scrollIntoViewIfNeeded();
    await at.screenshot({ path: join(output, 'poses_phone_panel.png') });
    await at.locator('#open-poses').tap();
    await tried(sample('kneel', at));
    await at.locator('#pose-name').fill('ich');
    await at.locator('#save-pose').tap();
    await tried(own('ich', at));
    await at.screenshot({ path: join(output, 'poses_phone.png') });
    await expectNoBarriers(at, 'the library on a small screen');
    await sample('kneel', at).tap();
    await closed(at);
    await at.waitForFunction(() => globalThis.limberStudio.state().undo === 'apply_pose');
    await settled(at);
    await at.screenshot({ path: join(output, 'poses_phone_kneel.png') });
    assert.deepEqual(thrown, []);
    await context.close();
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
