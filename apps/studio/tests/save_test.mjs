// Models that leave the page for other programs, and files of other programs that come into it.
//
//   node apps/studio/tests/save_test.mjs DIST PROGRAM OUTPUT_FOLDER
//
// The program reads what the page saves, and makes what it opens. Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { zipSync } from 'three/examples/jsm/libs/fflate.module.js';
import { barriers, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { readUsd } from './usd_points.mjs';
import { walkBvh } from './walk_bvh.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const at = (name) => join(output, `save_${name}`);
const limber = (...options) => execFileSync(program, [...options, '--quiet']);
limber('sample', 'biped', '-o', at('bare.glb'));
limber('sample', 'stool', '-o', at('stool.glb'));
limber('rig', at('bare.glb'), '--rigger', 'template', '-o', at('hero.glb'));
writeFileSync(at('walk.bvh'), walkBvh());
limber('retarget', at('hero.glb'), at('walk.bvh'), '-o', at('moving.glb'));
for (const name of ['moving.fbx', 'moving.vrm', 'moving.usdz']) limber('convert', at('moving.glb'), at(name));
limber('convert', at('walk.bvh'), at('walk.vrma'));
limber('convert', at('walk.bvh'), at('walk.fbx'));

const server = await serve(dist), browser = await launch();
const { page, context, errors } = await openStudio(browser, server.address, { search: '?sample=biped' });

async function open(file) {
  await page.locator('#file').setInputFiles(file);
  await page.waitForFunction((name) => globalThis.limberStudio.state()?.name === name, file.split('/').pop());
  await settled(page);
}
const dialogOf = (shown) => ({ format: shown.locator('#save-format'), target: shown.locator('#save-target'), clip: shown.locator('#save-clip'), save: shown.locator('#save-model') });
async function openDialog(shown = page) {
  await shown.locator('#export-as').selectOption('model');
  await shown.locator('#save-as').waitFor();
  return dialogOf(shown);
}

/** The file that is offered, with its name; what the page says that is not in it. */
async function saved(format, { target, clip } = {}) {
  const dialog = await openDialog();
  await dialog.format.selectOption(format);
  if (target) await dialog.target.selectOption(target);
  if (clip !== undefined) await dialog.clip.selectOption(clip);
  const [file] = await Promise.all([page.waitForEvent('download'), dialog.save.click()]);
  const path = at(`saved_${file.suggestedFilename()}`);
  await file.saveAs(path);
  await settled(page);
  const lost = await page.locator('#save-lost li').allTextContents();
  if (await page.locator('#save-as').isVisible()) await page.locator('#save-close').click();
  return { path, name: file.suggestedFilename(), bytes: readFileSync(path), lost };
}
const infoOf = (path) => JSON.parse(execFileSync(program, ['info', path, '--json']).toString());
const convertedInfo = (path) => {
  limber('convert', path, at('back.glb'));
  return infoOf(at('back.glb'));
};
const jointNames = (path) => {
  const glb = readFileSync(path), document = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
  return document.skins[0].joints.map((joint) => document.nodes[joint].name);
};

/** An AMASS motion whose left elbow bends, as NumPy writes arrays: version 1.0, doubles, row by row. */
function amass(frames) {
  const array = (shape, values) => {
    const head = `{'descr': '<f8', 'fortran_order': False, 'shape': (${shape.join(', ')}${shape.length === 1 ? ',' : ''}), }`;
    const padded = head.padEnd(64 * Math.ceil((head.length + 11) / 64) - 11) + '\n';
    const size = Buffer.alloc(2);
    size.writeUInt16LE(padded.length);
    return Buffer.concat([Buffer.from([0x93]), Buffer.from('NUMPY\x01\x00', 'latin1'), size, Buffer.from(padded), Buffer.from(Float64Array.from(values).buffer)]);
  };
  const poses = Array.from({ length: frames }, (_, f) => Array.from({ length: 156 }, (_, i) => (i === 3 * 18 + 1 ? -1.5 * f / frames : 0))).flat();
  return Buffer.from(zipSync({
    'poses.npy': array([frames, 156], poses), 'trans.npy': array([frames, 3], Array.from({ length: 3 * frames }, () => 0)),
    'mocap_framerate.npy': array([1], [30]), 'betas.npy': array([16], Array.from({ length: 16 }, () => 0)),
  }));
}
const notice = () => page.locator('#notice').textContent();

const cases = {
  async 'the dialog has labels, and shows what the format has'() {
    await open(at('moving.glb'));
    const { format, target, clip } = await openDialog();
    assert.deepEqual(await barriers(page), []);
    assert.equal(await format.inputValue(), 'fbx');
    assert.equal(await target.inputValue(), 'gltf');
    assert.equal(await clip.isVisible(), false);
    await page.screenshot({ path: at('dialog.png') });
    await format.selectOption('vrm');
    assert.equal(await target.isVisible(), false);
    await format.selectOption('usdz');
    assert.equal(await clip.isVisible(), true);
    assert.deepEqual(await clip.locator('option').evaluateAll((all) => all.map(({ value }) => value)), ['', ...(await sessionState(page)).clips.map(({ name }) => name)]);
    await page.keyboard.press('Escape');
    await page.locator('#save-as').waitFor({ state: 'detached' });
  },
  async 'it is reached and answered by the keyboard'() {
    const dialog = await openDialog();
    await dialog.format.selectOption('glb');
    await dialog.format.focus();
    for (let i = 0; i < 4; ++i) {
      await page.keyboard.press('Tab');
      if (await page.evaluate(() => document.activeElement?.id) === 'save-model') break;
    }
    const [file] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('Enter')]);
    assert.equal(file.suggestedFilename(), 'save_moving.glb');
    await page.locator('#save-as').waitFor({ state: 'detached' }); // nothing is lost
  },
  async 'an FBX for Unreal has its names, and the program reads it'() {
    const { path, name } = await saved('fbx', { target: 'unreal' });
    assert.equal(name, 'save_moving_unreal.fbx');
    limber('convert', path, at('back.glb'));
    const names = jointNames(at('back.glb'));
    for (const wanted of ['root', 'pelvis', 'upperarm_l', 'hand_r']) assert.ok(names.includes(wanted), `${wanted} in ${names}`);
  },
  async 'each program has names of its own'() {
    const plain = jointNames((await saved('glb')).path), all = [];
    for (const target of ['unity', 'blender', 'mixamo', 'rigify', 'actorcore', 'roblox']) all.push(jointNames((await saved('glb', { target })).path).join());
    assert.equal(new Set([plain.join(), ...all]).size, 7);
  },
  async 'a VRM says what is to be filled in'() {
    const { bytes, lost } = await saved('vrm');
    assert.match(bytes.toString('latin1'), /VRMC_vrm/);
    assert.ok(lost.some((line) => /filled in/.test(line)), lost);
  },
  async 'glTF comes with its buffers in an archive, USD as one file where it has no pictures'() {
    const gltf = await saved('gltf');
    assert.equal(gltf.name, 'save_moving_gltf.zip');
    assert.match(gltf.bytes.toString('latin1'), /model\.gltf[^]*model\.bin/);
    const text = await saved('usda');
    assert.equal(text.name, 'save_moving.usda');
    assert.ok(text.bytes.toString().startsWith('#usda 1.0'));
    assert.equal((await saved('usdc')).bytes.subarray(0, 8).toString(), 'PXR-USDC');
  },
  async 'a USDZ moves with the clip that is asked for, or stands'() {
    const clip = (await sessionState(page)).clips[0].name;
    const moving = readUsd((await saved('usdz', { clip })).bytes), still = readUsd((await saved('usdz', { clip: '' })).bytes);
    assert.ok(moving.skinned > 0 && moving.clips === 1, JSON.stringify({ ...moving, points: 0 }));
    assert.ok(still.skinned > 0 && still.clips === 0, JSON.stringify({ ...still, points: 0 }));
  },
  async 'what has another deformer is told that it is lost'() {
    await page.locator('#methods summary').first().click();
    await page.locator('#deformer').selectOption('dual-quaternion');
    await settled(page);
    assert.ok((await saved('glb')).lost.some((line) => /linearly/.test(line)));
  },
  async 'a model that is no person is refused as VRM, and the page says why'() {
    await open(at('stool.glb'));
    const dialog = await openDialog();
    await dialog.format.selectOption('vrm');
    await dialog.save.click();
    await page.locator('#notice').waitFor();
    await page.locator('#save-as').waitFor({ state: 'detached' });
    assert.ok((await notice()).length > 20);
  },
  async 'FBX and VRM open with their rig and clips'() {
    for (const name of ['moving.fbx', 'moving.vrm']) {
      await open(at(name));
      const { own_rig, joints } = await sessionState(page);
      assert.ok(own_rig && joints.length > 15, name);
    }
    await open(at('moving.fbx'));
    assert.equal((await sessionState(page)).clips.length, 1);
  },
  async 'motions of VRMA, FBX, NPZ and BVH play on the model'() {
    await open(at('hero.glb'));
    writeFileSync(at('elbow.npz'), amass(20));
    for (const name of ['walk.vrma', 'walk.fbx', 'elbow.npz', 'walk.bvh']) {
      await motionPlayed(page, () => page.locator('#file').setInputFiles(at(name)));
      const { clips, clip } = await sessionState(page);
      assert.ok(clips[clip].duration > 0.5, `${name}: ${JSON.stringify(clips[clip])}`);
    }
  },
  async 'they may be dropped on the page'() {
    const before = (await sessionState(page)).clips.length;
    const transfer = await page.evaluateHandle((base64) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)), made = new DataTransfer();
      made.items.add(new File([bytes], 'dropped.vrma'));
      return made;
    }, readFileSync(at('walk.vrma')).toString('base64'));
    await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
    await page.waitForFunction((count) => globalThis.limberStudio.state().clips.length > count, before);
  },
  async 'USD is refused with what to do'() {
    await page.locator('#file').setInputFiles(at('moving.usdz'));
    await page.locator('#notice').waitFor();
    assert.match(await notice(), /writes USD.*open the model that it was made of/);
  },
  async 'on a phone, in German'() {
    const phone = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped', locale: 'de-DE' });
    const { format, save } = await openDialog(phone.page);
    await format.selectOption('usdz');
    assert.deepEqual(await barriers(phone.page), []);
    const { x, y, width, height } = await phone.page.locator('#save-as').boundingBox();
    assert.ok(x >= 0 && y >= 0 && x + width <= 390 && y + height <= 844);
    assert.ok((await save.boundingBox()).height >= 40);
    await phone.page.screenshot({ path: at('phone.png') });
    const [file] = await Promise.all([phone.page.waitForEvent('download'), save.tap()]);
    assert.match(file.suggestedFilename(), /\.usdz$/);
    assert.deepEqual(phone.errors, []);
    await phone.context.close();
  },
  async 'nothing was thrown'() { assert.deepEqual(errors, []); },
};

let failed = 1;
try {
  failed = await runCases(cases, page, output);
} finally {
  await context.close();
  await browser.close();
  server.close();
}
process.exit(failed === 0 ? 0 : 1);
