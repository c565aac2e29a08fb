// Augmented reality on a headset that emulates WebXR: placed, posed by controllers and bare hands, turned and scaled with
// both, the panel in space, and all that can end a drag.
//
//   node apps/studio/tests/headset_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { download, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { emulateHeadset } from './xr_headset.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 480, height: 480, search: '?sample=biped', prepare: (context) => emulateHeadset(context) });

const frames = (count = 3) => page.evaluate((n) => new Promise((done) => {
  const next = () => (n-- > 0 ? requestAnimationFrame(next) : done());
  next();
}), count);
/** Calls of xr_headset.mjs, one after the other, and frames behind them. */
async function act(...calls) {
  await page.evaluate((all) => all.forEach(([name, ...given]) => headset[name](...given)), calls);
  await frames();
}
const ask = (name, ...given) => page.evaluate(([call, all]) => limberHeadset[call](...all), [name, given]);
/** As it is seen in the headset, which shows nothing of the page. */
const shot = (name) => page.screenshot({ path: join(output, `headset_${name}.png`), style: '#ar { visibility: hidden }' });
const sum = (a, b) => a.map((value, i) => value + b[i]);
const minus = (a, b) => a.map((value, i) => value - b[i]);
const apart = (a, b) => Math.hypot(...minus(a, b));
const close = (a, b, most, what) => assert.ok(apart(a, b) < most, `${what}: ${a} instead of ${b}`);
const about = ([x, y, z], degrees) => [...[x, y, z].map((part) => part * Math.sin((degrees * Math.PI) / 360)), Math.cos((degrees * Math.PI) / 360)];
const jointOf = async (part) => (await sessionState(page)).joints.find((joint) => joint.part === part).name;
const worldTurn = (name) => page.evaluate((joint) => limberStudio.turned(joint).rotation, name);
/** Degrees between two rotations. */
const between = (a, b) => (360 / Math.PI) * Math.acos(Math.min(1, Math.abs(a.reduce((all, value, i) => all + value * b[i], 0))));
const ready = [['hold', 'left', [-0.25, 1.1, -0.3]], ['hold', 'right', [0.25, 1.1, -0.3]]];

/** By the right controller's ray. */
async function pressCell(id) {
  await pressOnly(id);
  await settled(page);
}
/** It follows the left hand lazily, and keeps still once it is pointed at. */
async function pressOnly(id) {
  for (let tries = 0; await ask('over', 'right') !== id; ++tries) {
    const cell = await ask('cell', id);
    assert.ok(cell && tries < 50, `the panel has no ${id}, or it does not come to rest`);
    await act(['aim', 'right', sum(cell, [0.1, -0.1, 0.35]), cell]);
  }
  await press();
}
async function press(side = 'right') {
  await act(['press', side, true]);
  await act(['press', side, false]);
}

const cases = {
  async 'begins, and the ray looks for a place on the floor'() {
    await page.locator('#view-in-ar').click();
    await page.waitForFunction(() => globalThis.limberHeadset);
    await act(...ready, ['aim', 'right', [0.2, 1.2, -0.2], [0, 0, -1.6]]);
    assert.match(await ask('says'), /Pinch, or press the trigger/);
    close(await ask('member', 0, 0), [0, 0, -1.6], 0.01, 'the model goes with the ray');
    await shot('placing');
    await act(['press', 'right', true], ['press', 'left', false]);
    await act(['press', 'right', false]);
    await settled(page);
    await act(['aim', 'right', [0.2, 1.2, -0.2], [1, 0, -1.6]]);
    close(await ask('member', 0, 0), [0, 0, -1.6], 0.01, 'it stays where it was placed');
    await shot('placed');
  },
  async 'the panel shows the handles'() {
    await act(...ready);
    await pressCell('ar-pose');
    await act(...ready);
    assert.ok(await ask('cell', 'mode-move'));
    await shot('posing');
  },
  async 'a far handle is highlighted, then dragged by the ray'() {
    await pressCell('mode-move');
    const name = await jointOf('left hand'), at = await ask('handle', name), from = [0.2, 1.3, -0.3];
    await act(['aim', 'right', from, at]);
    const joint = (await sessionState(page)).joints.findIndex((one) => one.name === name);
    assert.equal(await ask('hovered'), joint);
    await shot('far_highlight');
    await act(['press', 'right', true]);
    const to = sum(at, [-0.05, 0.12, 0]), scale = apart(at, from) / apart(to, from);
    await act(['aim', 'right', from, to]);
    await settled(page);
    const wanted = sum(from, minus(to, from).map((value) => value * scale));
    close(await ask('handle', name), wanted, 0.03, 'the handle stays on the ray');
    await shot('far_drag');
    await act(['press', 'right', false]);
    await settled(page);
    assert.equal((await sessionState(page)).undo, 'end_drag');
  },
  async 'a near handle is pinched, carried and twisted: one step to undo'() {
    await page.evaluate(() => { headset.device.primaryInputMode = 'hand'; });
    await act(...ready);
    const name = await jointOf('right hand'), joint = (await sessionState(page)).joints.findIndex((one) => one.name === name);
    const before = await ask('handle', name), turned = await worldTurn(name);
    // Between thumb and finger.
    const { grip } = await ask('hand', 'right'), rests = minus(before, minus(grip, [0.25, 1.1, -0.3]));
    await act(['hold', 'right', rests]);
    assert.equal(await ask('hovered'), joint);
    await shot('near_highlight');
    await act(['press', 'right', true]);
    close(await ask('handle', name), before, 0.005, 'taking hold moves nothing');
    const { carrier: wrist } = await ask('hand', 'right'), way = [0.06, 0.1, 0.08], twist = 35;
    await act(['hold', 'right', sum(rests, way), about([0, 0, 1], twist)]);
    await settled(page);
    await shot('near_drag');
    // With the wrist: it is turned about the ray's origin, and goes along.
    const { carrier: now } = await ask('hand', 'right'), [x, y, z] = minus(before, wrist), [c, s] = [Math.cos((twist * Math.PI) / 180), Math.sin((twist * Math.PI) / 180)];
    close(await ask('handle', name), sum(now, [c * x - s * y, s * x + c * y, z]), 0.006, 'the handle goes with the hand');
    const angle = between(turned, await worldTurn(name));
    assert.ok(Math.abs(angle - twist) < 1.5, `twisted by ${angle} degrees`);
    await act(['press', 'right', false]);
    await settled(page);
    const released = await ask('handle', name);
    await pressCell('ar-undo');
    close(await ask('handle', name), before, 1e-4, 'one step back');
    await act(...ready);
    await pressCell('ar-redo');
    close(await ask('handle', name), released, 1e-4, 'and forth');
  },
  async 'turned by the ray, it swings about its parent'() {
    await page.evaluate(() => { headset.device.primaryInputMode = 'controller'; });
    await act(...ready);
    await pressCell('mode-turn');
    const name = await jointOf('left hand'), { joints } = await sessionState(page), parent = joints[joints.find((one) => one.name === name).parent].name;
    const at = await ask('handle', name), bone = apart(at, await ask('handle', parent));
    await act(['aim', 'right', [0.2, 1.3, -0.3], at]);
    await act(['press', 'right', true]);
    await act(['aim', 'right', [0.2, 1.3, -0.3], sum(at, [0, 0.25, 0])]);
    await act(['press', 'right', false]);
    await settled(page);
    const after = await ask('handle', name);
    assert.ok(apart(at, after) > 0.05, 'it has not moved');
    assert.ok(Math.abs(apart(after, await ask('handle', parent)) - bone) < 1e-3, 'the bone keeps its length');
  },
  async 'scaled by the ray it grows, and limbs follow or stretch by the switch that the desk has'() {
    await act(...ready);
    await pressCell('mode-scale');
    const hand = await jointOf('left hand'), { joints } = await sessionState(page), elbow = joints[joints.find((one) => one.name === hand).parent].name;
    const bone = async () => apart(await ask('handle', hand), await ask('handle', elbow)), before = await bone(), at = await ask('handle', elbow);
    await act(['aim', 'right', [0.2, 1.3, -0.3], at]);
    await act(['press', 'right', true]);
    await act(['aim', 'right', [0.2, 1.3, -0.3], sum(at, [0, 0.1, 0])]);
    await act(['press', 'right', false]);
    await settled(page);
    assert.ok(await bone() > 1.1 * before, `${before} to ${await bone()} m`);
    await act(...ready);
    await pressCell('limb-alone');
    assert.equal((await sessionState(page)).ik, false);
    await act(...ready);
    await shot('scaled');
    for (let step = 0; step < 2; ++step) {
      await pressCell('ar-undo');
      await act(...ready);
    }
    assert.equal((await sessionState(page)).ik, true);
    assert.ok(Math.abs(await bone() - before) < 1e-4);
  },
  async 'a press on a handle selects it, and is no step'() {
    const { undo } = await sessionState(page), name = await jointOf('head'), at = await ask('handle', name);
    await act(['aim', 'right', [0.2, 1.3, -0.3], at]);
    await act(['press', 'right', true]);
    await act(['press', 'right', false]);
    await settled(page);
    const { joints, undo: now } = await sessionState(page);
    assert.equal(joints[await page.evaluate(() => limberStudio.selected())].name, name);
    assert.equal(now, undo);
  },
  async 'with one hand alone the panel is beside the model, within reach'() {
    await page.evaluate(() => { headset.device.controllers.left.connected = false; });
    await act(...ready.slice(1));
    await pressCell('mode-move');
    const away = apart(await ask('cell', 'mode-move'), [0, 1.6, 0]);
    assert.ok(away > 0.4 && away < 0.8, `${away} m from the eyes`);
    await shot('one_hand');
    await page.evaluate(() => { headset.device.controllers.left.connected = true; });
    await act(...ready);
  },
  async 'hidden, blurred or out of sight: a drag ends where it was'() {
    const name = await jointOf('left hand'), from = [0.2, 1.3, -0.3];
    for (const [what, begin, back, says] of [
      ['hidden', () => headset.device.updateVisibilityState('hidden'), () => headset.device.updateVisibilityState('visible'), /Waiting/],
      ['blurred', () => headset.device.updateVisibilityState('visible-blurred'), () => headset.device.updateVisibilityState('visible'), /Waiting/],
      ['lost', () => { headset.device.controllers.right.connected = false; }, () => { headset.device.controllers.right.connected = true; }, /out of sight/],
    ]) {
      const at = await ask('handle', name);
      await act(['aim', 'right', from, at]);
      await act(['press', 'right', true]);
      await act(['aim', 'right', from, sum(at, [0.03, 0.03, 0])]);
      await page.evaluate(begin);
      await frames();
      await settled(page);
      const state = await sessionState(page), held = await ask('handle', name);
      assert.equal(state.dragged, null, what);
      assert.equal(state.undo, 'end_drag', what);
      assert.ok(apart(held, at) > 0.02, `${what}: what was done is lost`);
      assert.match(await ask('says'), says);
      if (what !== 'hidden') await shot(what);
      await page.evaluate(back);
      await act(['aim', 'right', from, sum(at, [0.2, 0.2, 0])]);
      await act(['press', 'right', false]);
      await settled(page);
      close(await ask('handle', name), held, 1e-4, `${what}: it is held no more`);
      await act(...ready);
    }
  },
  async 'a pinching hand that is lost'() {
    await page.evaluate(() => { headset.device.primaryInputMode = 'hand'; });
    await act(...ready);
    const name = await jointOf('right hand'), at = await ask('handle', name), { grip } = await ask('hand', 'right'), rests = minus(at, minus(grip, [0.25, 1.1, -0.3]));
    await act(['hold', 'right', rests]);
    await act(['press', 'right', true]);
    await act(['hold', 'right', sum(rests, [0, 0.05, 0.03])]);
    await page.evaluate(() => { headset.device.hands.right.connected = false; });
    await frames();
    await settled(page);
    const state = await sessionState(page), held = await ask('handle', name);
    assert.equal(state.dragged, null);
    assert.ok(apart(held, at) > 0.03);
    assert.match(await ask('says'), /out of sight/);
    await act(['press', 'right', false]);
    await page.evaluate(() => { headset.device.hands.right.connected = true; });
    await act(...ready);
    close(await ask('handle', name), held, 1e-4, 'it stays');
  },
  async 'a finger tip presses the panel'() {
    await frames(30); // it comes to rest
    const before = (await sessionState(page)).joints.length;
    const cell = await ask('cell', 'more-handles'), { tip } = await ask('hand', 'right'), offset = minus([0.25, 1.1, -0.3], tip);
    const front = minus([0, 1.6, 0], cell), near = (metres) => sum(sum(cell, offset), front.map((value) => (metres * value) / Math.hypot(...front)));
    await act(['hold', 'right', near(0.05)]);
    await shot('finger');
    await act(['hold', 'right', near(-0.01)]);
    await page.waitForFunction((count) => limberStudio.state().joints.length > count, before);
    await settled(page);
    const after = (await sessionState(page)).joints.length;
    await frames(20);
    assert.equal((await sessionState(page)).joints.length, after, 'one press');
    await act(['hold', 'right', near(0.1)], ...ready.slice(1));
  },
  async 'the body follows a ray over the floor, and the hand in space'() {
    await page.evaluate(() => { headset.device.primaryInputMode = 'controller'; });
    await act(...ready);
    await pressCell('ar-pose');
    await act(...ready);
    const before = await ask('member', 0, 0), chest = await ask('member', 0, 0.7), from = [0.2, 1.3, -0.3];
    await act(['aim', 'right', from, chest]);
    await act(['press', 'right', true]);
    await frames(6);
    await act(['aim', 'right', from, sum(chest, [-0.4, 0, 0])]);
    await act(['press', 'right', false]);
    await settled(page);
    const moved = minus(await ask('member', 0, 0), before);
    assert.ok(moved[0] < -0.3 && moved[0] > -0.5, `moved by ${moved}`);
    assert.ok(Math.abs(moved[1]) < 1e-3, 'it stays on the floor');
    assert.equal((await sessionState(page)).undo, 'place_member');
    // In the hand: lifted, carried, turned.
    const hip = await ask('member', 0, 0.5);
    await act(['hold', 'right', hip]);
    const { grip } = await ask('hand', 'right'), rests = minus(hip, minus(grip, hip));
    await act(['hold', 'right', rests]);
    await act(['press', 'right', true]);
    await act(['hold', 'right', sum(rests, [0.2, 0.3, 0.1]), about([0, 1, 0], 40)]);
    await shot('body_in_hand');
    await act(['press', 'right', false]);
    await settled(page);
    const { members } = await sessionState(page);
    assert.ok(Math.abs(Math.hypot(...members[0].placement.turn) - 40) < 1, `turned by ${members[0].placement.turn}`);
    assert.ok(members[0].placement.position[1] > 0.25);
    await pressCell('ar-undo');
    await act(...ready);
  },
  async 'two hands turn and scale it, with its real size as a detent'() {
    const [x, , z] = await ask('member', 0, 0), y = 1, hands = (wide, degrees) => {
      const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
      return [['aim', 'left', [x - c * wide, y, z + s * wide], [x, 0.5, z]], ['aim', 'right', [x + c * wide, y, z - s * wide], [x, 0.5, z]]];
    };
    const placement = async () => (await sessionState(page)).members[0].placement, before = await placement();
    await act(...hands(0.3, 0));
    await act(['press', 'left', true], ['press', 'right', true]);
    await act(...hands(0.45, 30));
    await shot('two_hands');
    await act(['press', 'left', false], ['press', 'right', false]);
    await settled(page);
    const larger = await placement();
    assert.ok(Math.abs(larger.scale - 1.5) < 0.06, `scaled to ${larger.scale}`);
    const turned = Math.hypot(...larger.turn) - Math.hypot(...before.turn);
    assert.ok(Math.abs(Math.abs(turned) - 30) < 2, `turned by ${turned}`);
    assert.match(await ask('says'), /Not its real size/);
    await act(...hands(0.45, 30));
    await act(['press', 'left', true], ['press', 'right', true]);
    await act(...hands(0.31, 30));
    await act(['press', 'left', false], ['press', 'right', false]);
    await settled(page);
    assert.equal((await placement()).scale, 1);
    await act(...ready);
  },
  async 'another model comes from the panel, and stands where the ray says'() {
    await pressCell('open-add');
    await shot('adding');
    await pressCell('sample-stool');
    await page.waitForFunction(() => limberStudio.state().members.length === 2);
    await settled(page);
    await act(...ready);
    if (await ask('cell', 'ar-again')) await pressCell('ar-again');
    await act(['aim', 'right', [0.2, 1.4, -0.2], [1.1, 0.7, -1.5]]);
    close(await ask('member', 1, 0), [1.1, 0.7, -1.5], 0.01, 'on the table');
    await shot('on_the_table');
    await act(['press', 'right', true]);
    await act(['press', 'right', false]);
    await settled(page);
    assert.equal((await sessionState(page)).undo, 'place_member');
  },
  async 'the panel lists the models of the scene, and takes a picture'() {
    await act(...ready);
    await pressCell('open-members');
    await shot('members');
    await pressCell('member-0');
    assert.equal((await sessionState(page)).member, 0);
    await act(...ready);
    await pressCell('open-members');
    await pressCell('member-1');
    assert.equal((await sessionState(page)).member, 1);
    await act(...ready);
    const png = await download(page, () => pressOnly('ar-picture'));
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    writeFileSync(join(output, 'headset_picture.png'), png);
    await page.waitForFunction(() => limberHeadset.says().includes('The picture is saved'));
    await act(...ready);
    await pressCell('close-notice');
    await act(...ready);
  },
  async 'the end puts the desk back; the native program makes the same of the record'() {
    await act(...ready);
    await pressCell('ar-close');
    await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
    await settled(page);
    const glb = await download(page, () => page.locator('#save-glb').click());
    writeFileSync(join(output, 'headset.glb'), glb);
    writeFileSync(join(output, 'headset.json'), await download(page, () => page.locator('#export-as').selectOption('record')));
    assert.match(readFileSync(join(output, 'headset.json'), 'utf8'), /move_drag/);
    execFileSync(program, ['session', 'replay', join(output, 'headset.json'), '-o', join(output, 'headset_native.glb'), '--quiet']);
    const here = nodesOf(glb), there = nodesOf(readFileSync(join(output, 'headset_native.glb')));
    assert.deepEqual([...here.keys()], [...there.keys()]);
    for (const [name, values] of here) assert.ok(apart(values, there.get(name)) < 1e-5, `${name} stands elsewhere`);
  },
  async 'it begins again, for both eyes'() {
    await page.evaluate(() => { headset.device.stereoEnabled = true; });
    await page.locator('#view-in-ar').click();
    await page.waitForFunction(() => headset.session && !document.querySelector('#app').checkVisibility());
    await act(...ready, ['aim', 'right', [0.2, 1.2, -0.2], [0, 0, -1.6]]);
    await act(['press', 'right', true]);
    await act(['press', 'right', false]);
    await settled(page);
    await shot('both_eyes');
    await page.evaluate(() => headset.session.end());
    await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
  },
  async 'what has to be answered is asked on the panel'() {
    await page.locator('#file').setInputFiles(join(output, 'headset.glb'));
    await page.waitForFunction(() => limberStudio.state().own_rig);
    await settled(page);
    await page.evaluate(() => { headset.device.stereoEnabled = false; });
    await page.locator('#view-in-ar').click();
    await page.waitForFunction(() => headset.session && !document.querySelector('#app').checkVisibility());
    await act(...ready, ['aim', 'right', [0.2, 1.2, -0.2], [0, 0, -1.6]]);
    await press();
    await pressCell('ar-pose');
    const before = (await sessionState(page)).joints.length;
    await pressOnly('more-handles');
    await page.waitForFunction(() => limberHeadset.cell('ask-no'));
    assert.match(await ask('says'), /Replace the rig/);
    await shot('question');
    await pressCell('ask-no');
    assert.equal((await sessionState(page)).joints.length, before);
    assert.ok(await ask('cell', 'more-handles'), 'the panel goes on');
    await page.evaluate(() => headset.session.end());
    await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

/** Of a GLB: translation and rotation of each node. */
function nodesOf(glb) {
  const { nodes } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
  return new Map(nodes.map(({ name, translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1] }, i) => [`${i} ${name}`, [...translation, ...rotation, ...scale]]));
}

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
