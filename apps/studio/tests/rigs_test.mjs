// Rigs that no method makes: of another model, and of the motion that is in a model's file.
//
//   node apps/studio/tests/rigs_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { zipSync } from 'three/examples/jsm/libs/fflate.module.js';
import { answer, barriers, download, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const made = (name, ...command) => {
  execFileSync(program, [...command, '-o', join(output, name), '--quiet'], { stdio: 'ignore' });
  return readFileSync(join(output, name));
};
const bare = made('rigs_bare.glb', 'sample', 'biped');
const hero = made('rigs_hero.glb', 'rig', join(output, 'rigs_bare.glb'), '--rigger', 'template');
const flying = made('rigs_flying.glb', 'sample', 'flying');

const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { search: '?sample=biped' });
const { page } = desk;

const glb = (name, buffer) => ({ name, mimeType: 'model/gltf-binary', buffer });
const names = async (of = page) => (await sessionState(of)).joints.map(({ name }) => name);

async function take(file, of = page) {
  if (!await of.locator('#take-rig').isVisible()) await of.locator('#methods summary').click();
  await of.locator('#rig-file').setInputFiles(file);
}
/** The model that is saved by the page. */
const saved = () => download(page, async () => page.locator('#save-glb').click());

const cases = {
  async 'a rig of another model: its joints, where the surfaces stay apart, and undo'() {
    const handles = await names();
    await take(glb('hero.glb', hero));
    await settled(page);
    assert.ok((await names()).includes('leftHand'), await page.locator('#notice').textContent());
    assert.match(await page.locator('#rig-gaps').textContent(), /^Both surfaces lie 0\.\d % of the height apart\./);
    await page.screenshot({ path: join(output, 'rigs_taken.png') });
    assert.deepEqual(await barriers(page), []);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.deepEqual(await names(), handles);
    assert.equal(await page.locator('#rig-gaps').isVisible(), false);
    await page.keyboard.press('Control+Shift+Z');
    await settled(page);
    assert.ok((await names()).includes('leftHand'));
  },
  async 'a .limber file holds it, and the program makes the same model of that'() {
    const file = await download(page, () => page.locator('#export-as').selectOption('limber'));
    writeFileSync(join(output, 'rigs.limber'), file);
    const replayed = made('rigs_replayed.glb', 'session', 'replay', join(output, 'rigs.limber'));
    assert.ok(replayed.includes('leftHand'));
    assert.equal(Buffer.compare(await saved(), replayed), 0, 'the bytes differ');
    await page.locator('#file').setInputFiles({ name: 'rigs.limber', mimeType: 'application/zip', buffer: file });
    await settled(page);
    assert.ok((await names()).includes('leftHand'));
  },
  async 'what cannot be taken is told, in German too, and changes nothing'() {
    const before = await names();
    await take(glb('bare.glb', bare));
    if (await page.locator('#ask').isVisible()) await answer(page, true);
    await page.locator('#notice').waitFor();
    assert.match(await page.locator('#notice').textContent(), /The model has no rig that could be taken/);
    assert.deepEqual(await names(), before);
    await page.locator('#close-notice').click();
    // Compressed, which the page unpacks; the engine then looks for the arrays.
    await take({ name: 'body.npz', mimeType: 'application/zip', buffer: Buffer.from(zipSync({ 'f.npy': new Uint8Array(5000) }, { level: 9 })) });
    if (await page.locator('#ask').isVisible()) await answer(page, true);
    await page.locator('#notice').waitFor();
    assert.match(await page.locator('#notice').textContent(), /body\.npz.*\bv_template/);
    await page.locator('#close-notice').click();
    const german = await openStudio(browser, server.address, { search: '?sample=biped', locale: 'de-DE' });
    await take(glb('kahl.glb', bare), german.page);
    await german.page.locator('#notice').waitFor();
    assert.match(await german.page.locator('#notice').textContent(), /Das Modell hat kein Skelett, das sich übernehmen ließe/);
    assert.match(await german.page.locator('#take-rig').textContent(), /Skelett eines anderen Modells/);
    assert.deepEqual(german.errors, []);
    await german.context.close();
  },
  async 'bones from the motion in the file, where there is one'() {
    assert.equal(await page.locator('#rig-from-animation').isVisible(), false);
    await page.locator('#file').setInputFiles(glb('flying.glb', flying));
    await page.waitForFunction(() => globalThis.limberStudio.state().animated);
    await settled(page);
    const before = await names(), { clips } = await sessionState(page);
    if (!await page.locator('#take-rig').isVisible()) await page.locator('#methods summary').click();
    await page.locator('#rig-from-animation').click();
    await answer(page, true);
    await page.waitForFunction((count) => globalThis.limberStudio.state().undo === 'rig_from_animation' && count > 0, before.length);
    const state = await sessionState(page);
    assert.ok(state.joints.every(({ name }) => name.startsWith('bone_')), state.joints.map(({ name }) => name).join());
    assert.deepEqual(state.clips.map(({ name }) => name), clips.map(({ name }) => name));
    await page.screenshot({ path: join(output, 'rigs_bones.png') });
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.deepEqual(await names(), before);
  },
  async 'nothing was thrown'() { assert.deepEqual(desk.errors, []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exitCode = failed > 0 ? 1 : 0;
