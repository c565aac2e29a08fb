// The shelf of motions: each plays on the user's own character on hover, and is put on it by a click.
//
//   node apps/studio/tests/shelf_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { answer, barriers, chooseMotion, download, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { walkBvh } from './walk_bvh.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 1280, height: 800, search: '?sample=biped' });

const card = (name, at = page) => at.locator(`#shelf [data-motion="${name}"]`);
/** Once it is seen, and how it looks is known. */
async function tried(name, at = page) {
  await card(name, at).scrollIntoViewIfNeeded();
  await card(name, at).and(at.locator(':not([aria-busy])')).waitFor();
}
/** The picture of a card, as text that can be compared. */
const pictureOf = (name, at = page) => card(name, at).locator('canvas').evaluate((canvas) => canvas.toDataURL());
const colored = (name, at = page) => card(name, at).locator('canvas').evaluate((canvas) => {
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return data.filter((value, i) => i % 4 === 3 && value > 200).length;
});
const closed = (at = page) => at.locator('#shelf').waitFor({ state: 'hidden' });

async function changes(name, at = page) {
  const first = await pictureOf(name, at);
  await at.waitForFunction(([motion, before]) =>
    document.querySelector(`#shelf [data-motion="${motion}"] canvas`).toDataURL() !== before, [name, first]);
}
async function stands(name, at = page) {
  const first = await pictureOf(name, at);
  await at.waitForTimeout(250);
  assert.equal(await pictureOf(name, at), first, `${name} moves`);
}

const expectNoBarriers = async (at, state) => assert.deepEqual(await barriers(at), [], state);

const bvhs = (count) => Array.from({ length: count }, (_, i) => ({ name: `step ${i + 1}.bvh`, mimeType: 'text/plain', buffer: Buffer.from(walkBvh(7 + i)) }));
/** A folder with a folder in it, by the browser's own drag from the desktop. */
async function dropFolder(files) {
  const folder = join(output, 'dropped');
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(join(folder, 'more'), { recursive: true });
  for (const [i, { name, buffer }] of files.entries()) writeFileSync(join(folder, i === 0 ? 'more' : '', name), buffer);
  const devtools = await page.context().newCDPSession(page), data = { items: [], files: [folder], dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver', 'drop']) await devtools.send('Input.dispatchDragEvent', { type, x: 500, y: 400, data });
  await devtools.detach();
}
/** Files that are dropped on the page. */
const drop = (files) => page.evaluate((all) => {
  const transfer = new DataTransfer();
  for (const [name, text] of all) transfer.items.add(new File([text], name));
  dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, cancelable: true }));
}, files.map(({ name, buffer }) => [name, buffer.toString()]));

const cases = {
  async 'on hover a motion plays on the character'() {
    const before = await sessionState(page);
    await page.locator('#open-shelf').click();
    await tried('jumping-jack');
    assert.ok(await colored('jumping-jack') > 500, 'nothing is drawn');
    await card('jumping-jack').hover();
    await changes('jumping-jack');
    await changes('jumping-jack');
    await page.screenshot({ path: join(output, 'shelf.png') });
    await page.locator('#shelf-title').hover();
    await stands('jumping-jack');
    assert.deepEqual(await sessionState(page), before, 'the document was changed');
    await expectNoBarriers(page, 'the shelf');
  },
  async 'a click puts the motion on'() {
    await motionPlayed(page, () => card('run').click());
    await closed();
    const state = await sessionState(page);
    assert.equal(state.clips[0].source.motion, 'run');
    assert.equal(await page.locator('#play').getAttribute('aria-pressed'), 'true');
    await page.locator('#play').click();
    await settled(page);
  },
  async 'what does not suit is grey and says why'() {
    await page.locator('#open-shelf').click();
    await tried('gallop');
    assert.equal(await card('gallop').getAttribute('aria-disabled'), 'true');
    assert.match(await card('gallop').textContent(), /another kind of body/);
    await card('gallop').hover({ force: true });
    assert.match(await page.locator('#shelf-about').textContent(), /too little in common/);
    assert.equal(await card('sit-down').getAttribute('aria-disabled'), 'false');
    await card('gallop').click({ force: true });
    assert.ok(await page.locator('#shelf').isVisible());
  },
  async 'by keyboard: arrows go from card to card, Enter chooses, Escape leaves'() {
    await card('walk').focus();
    await changes('walk');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowRight');
    assert.equal(await page.evaluate(() => document.activeElement.dataset.motion), 'sneak');
    await changes('sneak');
    await page.keyboard.press('ArrowDown');
    assert.notEqual(await page.evaluate(() => document.activeElement.dataset.motion), 'sneak');
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('Escape');
    await closed();
    await page.locator('#open-shelf').focus();
    await page.keyboard.press('Enter');
    await card('wave').focus();
    const before = (await sessionState(page)).clips.length;
    await page.keyboard.press('Enter');
    await page.waitForFunction((count) => globalThis.limberStudio.state().clips.length > count, before);
    await closed();
    await page.locator('#play').click();
    await settled(page);
  },
  async 'closed and opened in one moment, it is open'() {
    for (const [opener, closer, dialog] of [['#open-shelf', '#close-shelf', '#shelf'], ['#open-poses', '#close-poses', '#poses'], ['#help-button', '#help button', '#help']]) {
      await page.locator(opener).click();
      await page.locator(dialog).waitFor();
      await page.evaluate(([close, open]) => [close, open].forEach((one) => document.querySelector(one).click()), [closer, opener]);
      // The event of the closing comes before the next frame is drawn.
      await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
      assert.ok(await page.locator(dialog).isVisible(), `${dialog} was closed`);
      await page.keyboard.press('Escape');
      await page.locator(dialog).waitFor({ state: 'hidden' });
    }
  },
  async 'three motions that are dropped at once become a shelf'() {
    await dropFolder(bvhs(3));
    const own = page.locator('#shelf-own li');
    await own.nth(2).waitFor();
    assert.equal(await own.count(), 3);
    await tried('step 2.bvh');
    await card('step 2.bvh').hover();
    await changes('step 2.bvh');
    assert.equal(await page.locator('#shelf-search').isVisible(), false);
    const before = (await sessionState(page)).clips.length;
    await card('step 2.bvh').click();
    await page.waitForFunction((count) => globalThis.limberStudio.state().clips.length > count, before);
    assert.match((await sessionState(page)).clips.at(-1).source.motion, /step 2/);
    await page.locator('#play').click();
    await settled(page);
  },
  async 'more of them are searched by name; what cannot be read is grey'() {
    await page.locator('#open-shelf').click();
    await page.locator('#shelf-files').setInputFiles([...bvhs(13), { name: 'broken.bvh', mimeType: 'text/plain', buffer: Buffer.from('HIERARCHY nothing') }]);
    await page.waitForFunction(() => document.querySelectorAll('#shelf-own li').length === 14);
    await page.locator('#shelf-search').fill('brok');
    assert.equal(await page.locator('#shelf-own li:visible').count(), 1);
    await card('broken.bvh').and(page.locator('[aria-disabled=true]')).waitFor();
    await page.screenshot({ path: join(output, 'shelf_own.png') });
    await expectNoBarriers(page, 'motions of the user\'s own');
    await page.locator('#shelf-search').fill('');
    await page.keyboard.press('Escape');
    if (await page.locator('#shelf').isVisible()) await page.locator('#close-shelf').click();
  },
  async 'one that is dropped is put on at once'() {
    const [one] = bvhs(1);
    await motionPlayed(page, () => drop([{ ...one, name: 'alone.bvh' }]));
    assert.equal(await page.locator('#shelf').isVisible(), false);
    assert.match((await sessionState(page)).clips.at(-1).source.motion, /alone/);
  },
  async 'by touch the first tap plays and the second chooses, on a small screen in the dark'() {
    const small = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=quadruped' });
    const at = small.page;
    await at.emulateMedia({ colorScheme: 'dark' });
    await at.locator('#open-shelf').tap();
    await tried('trot', at);
    await card('trot', at).tap();
    await changes('trot', at);
    assert.ok(await at.locator('#shelf').isVisible());
    await at.screenshot({ path: join(output, 'shelf_small.png') });
    await expectNoBarriers(at, 'the shelf on a small screen');
    await motionPlayed(at, () => card('trot', at).tap());
    assert.deepEqual(small.errors, []);
    await small.context.close();
  },
  async 'another model: its own pictures'() {
    await page.locator('#samples').selectOption('quadruped');
    await page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'quadruped');
    await settled(page);
    await motionPlayed(page, () => chooseMotion(page, 'gallop'));
    await page.locator('#play').click();
    await settled(page);
    await page.locator('#open-shelf').click();
    await tried('gallop');
    assert.equal(await card('gallop').getAttribute('aria-disabled'), 'false');
    await card('gallop').hover();
    await changes('gallop');
    await page.screenshot({ path: join(output, 'shelf_animal.png') });
    await page.keyboard.press('Escape');
  },
  async 'of several glTF files those that move are motions'() {
    const buffer = await download(page, () => page.locator('#save-glb').click());
    await page.locator('#file').setInputFiles(['one.glb', 'two.glb'].map((name) => ({ name, mimeType: 'model/gltf-binary', buffer })));
    await tried('two.glb');
    assert.equal((await sessionState(page)).name, 'quadruped');
    assert.equal(await card('two.glb').getAttribute('aria-disabled'), 'false');
    await card('two.glb').hover();
    await changes('two.glb');
    await page.locator('#close-shelf').click();
  },
  async 'where handles are too few, the picture has the skeleton that the page then asks for'() {
    await page.locator('#samples').selectOption('biped');
    await page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'biped');
    await page.locator('#handles').evaluate((slider) => { slider.value = '250'; slider.dispatchEvent(new Event('input')); });
    await settled(page);
    const before = await sessionState(page);
    assert.ok(before.joints.length < 6);
    await page.locator('#open-shelf').click();
    await tried('wave');
    await card('wave').hover();
    await changes('wave');
    assert.deepEqual(await sessionState(page), before, 'the document was changed');
    await card('wave').click();
    await answer(page, true);
    await page.waitForFunction(() => globalThis.limberStudio.state().clips.length === 1);
    assert.ok((await sessionState(page)).joints.length > 15);
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
