// The page in a browser, as a user has it: by mouse, by touch and by keyboard.
//
//   node apps/studio/tests/studio_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER [FAULTY_FOLDER]
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';
import { walkBvh } from './walk_bvh.mjs';
import { chooseMotion, download as downloadFrom, jointPlace, jointPosition, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { readUsd } from './usd_points.mjs';

const [dist, program, output, faulty] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist);
const browser = await launch();
const desk = await openStudio(browser, server.address, { search: '?sample=biped' });
const { page } = desk;

const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const jointNames = async (of = page) => (await sessionState(of)).joints.map((joint) => joint.name);

async function setHandles(count) {
  await page.locator('#handles').focus();
  const now = Number(await page.locator('.count').textContent());
  for (let i = 0; i < Math.abs(count - now); ++i) await page.keyboard.press(count > now ? 'ArrowRight' : 'ArrowLeft');
  await settled(page);
}

/** A handle that no other is drawn over: the one that is furthest from all others. */
async function freeHandle(of = page) {
  const names = await jointNames(of);
  const places = await Promise.all(names.map((name) => jointPlace(of, name)));
  const room = places.map((a, i) => Math.min(...places.filter((_, j) => j !== i).map((b) => Math.hypot(a.x - b.x, a.y - b.y))));
  return names[room.indexOf(Math.max(...room))];
}

async function dragByMouse(from, way, of = page) {
  await of.mouse.move(from.x, from.y);
  await of.mouse.down();
  for (let i = 1; i <= 5; ++i) await of.mouse.move(from.x + (way.x * i) / 5, from.y + (way.y * i) / 5);
  await of.mouse.up();
  await settled(of);
}

const download = (click) => downloadFrom(page, click);

/** Through the button of the timeline; waits until the clip is on the model. */
async function openMotion(of, buffer, name) {
  await motionPlayed(of, () => of.locator('#motion-file').setInputFiles({ name, mimeType: 'text/plain', buffer }));
}

/** Neighbours in the timeline of which one covers the other. */
const timelineOverlaps = () => page.$$eval('.timeline .tools :is(button, select)', (all) => all
  .map((one) => ({ id: one.id, box: one.getBoundingClientRect() })).filter(({ box }) => box.width > 0)
  .sort((a, b) => a.box.left - b.box.left)
  .flatMap(({ id, box }, i, sorted) => (i > 0 && sorted[i - 1].box.right > box.left ? [`${sorted[i - 1].id} ${id}`] : [])));

const seconds = async (of = page) => Number((await of.locator('#time').textContent()).split('/')[0]);

async function scrub(to) {
  await page.locator('#scrub').fill(String(to));
  await settled(page);
}

/** The translations and rotations of a GLB's nodes, by name. */
function nodesOf(glb) {
  const { nodes } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
  return new Map(nodes.map((node) => [node.name, [...(node.translation ?? [0, 0, 0]), ...(node.rotation ?? [0, 0, 0, 1])]]));
}

const cases = {
  async 'a sample opens, with handles in it'() {
    const state = await sessionState(page);
    assert.equal(state.name, 'biped');
    assert.ok(state.joints.length >= 5);
    assert.match(await page.locator('#facts').textContent(), /vertices/);
  },
  async 'twenty handles'() {
    await page.locator('#follow [data-value=alone]').click(); // each handle by itself
    await setHandles(20);
    assert.ok([20, 21].includes((await jointNames()).length));
  },
  async 'a handle dragged by mouse follows the pointer, and undo takes it back'() {
    const name = await freeHandle();
    const before = await jointPosition(page, name), place = await jointPlace(page, name);
    await dragByMouse(place, { x: 60, y: -40 });
    const now = await jointPlace(page, name);
    assert.ok(Math.hypot(now.x - place.x - 60, now.y - place.y + 40) < 2, 'the handle is not under the pointer');
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.ok(distance(await jointPosition(page, name), before) < 1e-6);
    await page.keyboard.press('Control+Shift+Z');
    await settled(page);
    assert.ok(distance(await jointPosition(page, name), before) > 0.01);
  },
  async 'what is loaded until the first pose is at most 1.2 MB, packed as hosts do'() {
    const first = await serve(dist), rest = /limber_engine_rest/;
    // Of the rest of the engine nothing arrives, so the first pose cannot have needed it.
    const visit = await openStudio(browser, first.address, { search: '?sample=biped', prepare: (context) => context.route(rest, () => {}) });
    const joint = await freeHandle(visit.page), before = await jointPosition(visit.page, joint), place = await jointPlace(visit.page, joint);
    await dragByMouse(place, { x: 60, y: -40 }, visit.page);
    assert.ok(distance(await jointPosition(visit.page, joint), before) > 0.01, 'nothing was posed');
    await visit.context.close();
    const loaded = [...first.served].reduce((sum, file) => sum + gzipSync(readFileSync(file)).length, 0);
    first.close();
    assert.ok(loaded > 0.4e6 && loaded <= 1.2e6, `${loaded} bytes`);
    assert.ok([...server.served].some((file) => rest.test(file)), 'the rest was not fetched by itself');
  },
  async 'turn mode keeps the distance from the parent'() {
    await page.locator('main canvas').focus();
    await page.keyboard.press('r');
    const name = await freeHandle(), { joints } = await sessionState(page);
    const parent = joints[joints.find((joint) => joint.name === name).parent].name;
    const length = async () => distance(await jointPosition(page, name), await jointPosition(page, parent));
    const before = await jointPosition(page, name), bone = await length();
    await dragByMouse(await jointPlace(page, name), { x: -40, y: -50 });
    assert.ok(distance(await jointPosition(page, name), before) > 0.01, 'nothing turned');
    assert.ok(Math.abs((await length()) - bone) < 1e-5);
    await page.keyboard.press('g');
  },
  async 'another number of handles keeps the pose'() {
    assert.equal((await sessionState(page)).posed, true);
    await setHandles(26);
    assert.equal((await sessionState(page)).posed, true);
    await setHandles(20);
  },
  async 'limbs follow with inverse kinematics'() {
    await page.locator('#follow [data-value=follow]').click();
    await settled(page);
    assert.equal((await sessionState(page)).ik, true);
    assert.equal(await page.locator('#follow [data-value=follow]').getAttribute('aria-pressed'), 'true');
    const name = await freeHandle(), { joints } = await sessionState(page);
    const parent = joints[joints.find((joint) => joint.name === name).parent].name;
    const bone = distance(await jointPosition(page, name), await jointPosition(page, parent));
    const before = await jointPosition(page, name);
    await dragByMouse(await jointPlace(page, name), { x: -30, y: 20 });
    assert.ok(distance(await jointPosition(page, name), before) > 0.005);
    const now = distance(await jointPosition(page, name), await jointPosition(page, parent));
    assert.ok(Math.abs(now - bone) < 1e-4, 'a bone was stretched');
  },
  async 'the exported model has the pose that the native program makes of the commands'() {
    const glb = await download(() => page.locator('#save-glb').click());
    const path = join(output, 'studio.glb');
    writeFileSync(path, glb);
    const commands = await download(() => page.locator('#export-as').selectOption('record'));
    writeFileSync(join(output, 'commands.json'), commands);
    execFileSync(program, ['session', 'replay', join(output, 'commands.json'), '-o', join(output, 'native.glb'), '--quiet']);
    const here = nodesOf(glb), there = nodesOf(readFileSync(join(output, 'native.glb')));
    assert.deepEqual([...here.keys()], [...there.keys()]);
    for (const [name, values] of here) assert.ok(distance(values, there.get(name)) < 1e-5, `${name} stands elsewhere`);
  },
  async 'joints are chosen and moved by keyboard'() {
    await page.locator('#joints').focus();
    await page.keyboard.press('ArrowDown');
    const { name } = (await sessionState(page)).joints[await page.evaluate(() => globalThis.limberStudio.selected())];
    const before = await jointPosition(page, name);
    await page.locator('main canvas').focus();
    await page.keyboard.press('ArrowRight');
    await settled(page);
    assert.ok(distance(await jointPosition(page, name), before) > 1e-4);
    await page.keyboard.press('Delete');
    await settled(page);
  },
  async 'poses become keys that are played, moved and undone'() {
    await page.locator('#add-clip').click();
    await settled(page);
    await page.locator('#add-key').click();
    await settled(page);
    await scrub(1);
    const name = await freeHandle();
    const rest = await jointPosition(page, name);
    await dragByMouse(await jointPlace(page, name), { x: 40, y: -30 });
    const posed = await jointPosition(page, name);
    await page.locator('main canvas').focus();
    await page.keyboard.press('k');
    await settled(page);
    assert.equal(await page.locator('#keys i').count(), 2);
    await scrub(0);
    assert.ok(distance(await jointPosition(page, name), rest) < 1e-4, 'the first key is not the rest pose');
    await scrub(0.5);
    const between = await jointPosition(page, name);
    assert.ok(distance(between, rest) > 1e-3 && distance(between, posed) > 1e-3);
    await page.locator('#interpolation').selectOption('step');
    await settled(page);
    assert.ok(distance(await jointPosition(page, name), rest) < 1e-4);
    await scrub(0);
    const mark = await page.locator('#keys i').last().boundingBox(), track = await page.locator('#keys').boundingBox();
    await page.mouse.move(mark.x + mark.width / 2, mark.y + mark.height / 2);
    await page.mouse.down();
    await page.mouse.move(track.x + track.width * 0.25, mark.y + mark.height / 2, { steps: 3 });
    await page.mouse.up();
    await settled(page);
    const [{ keys }] = (await sessionState(page)).clips;
    assert.ok(keys[1] < 0.7 && keys[1] > 0.3, `the key is at ${keys[1]}`);
    await page.locator('#play').click();
    await page.waitForFunction(() => Number(document.querySelector('#scrub').value) > 0.1);
    await page.locator('#play').click();
    await settled(page);
    await page.locator('#remove-clip').click();
    await settled(page);
    assert.equal((await sessionState(page)).clips.length, 0);
  },
  async 'a joint gets another name, and undo the old one'() {
    await page.locator('#joints li').nth(2).click();
    const before = (await sessionState(page)).joints[await page.evaluate(() => globalThis.limberStudio.selected())].name;
    await page.locator('#rename-joint').click();
    await page.locator('#rename').fill('knee');
    await page.keyboard.press('Enter');
    await settled(page);
    assert.ok((await jointNames()).includes('knee'));
    await page.locator('#undo').click();
    await settled(page);
    assert.ok((await jointNames()).includes(before) && !(await jointNames()).includes('knee'));
  },
  async 'a sample motion plays, and a joint of the template is corrected by dragging and by touching'() {
    const other = await openStudio(browser, server.address, { search: '?sample=biped' });
    const at = other.page;
    await motionPlayed(at, () => chooseMotion(at, 'walk'));
    await at.waitForFunction(() => Number(document.querySelector('#scrub').value) > 0.1);
    await at.locator('#methods summary').click();
    await at.locator('#rigger').selectOption('template');
    await at.locator('#correct').click();
    await settled(at);
    assert.deepEqual([(await sessionState(at)).clip, (await sessionState(at)).posed], [null, false]);
    const elbow = 'leftLowerArm', from = await jointPlace(at, elbow), found = await jointPosition(at, elbow);
    await at.mouse.move(from.x, from.y);
    await at.mouse.down();
    await at.mouse.move(from.x, from.y + 6, { steps: 2 });
    await at.mouse.move(from.x, from.y + 8);
    await at.mouse.up();
    await at.waitForFunction(() => globalThis.limberStudio.state().pins.length === 1);
    await settled(at);
    const dragged = await jointPosition(at, elbow), [pin] = (await sessionState(at)).pins;
    assert.ok(distance(dragged, found) > 1e-3 && distance(dragged, pin.position) < 1e-3, `${found} ${dragged} ${pin.position}`);
    assert.equal((await sessionState(at)).posed, false);
    // Touched beside the handles: half way through the trunk.
    await at.locator('#joints li', { hasText: /^chest$/ }).click();
    const chest = await jointPlace(at, 'chest'), spine = await jointPlace(at, 'spine');
    await at.mouse.click((chest.x + spine.x) / 2 + 14, (chest.y + spine.y) / 2);
    await at.waitForFunction(() => globalThis.limberStudio.state().pins.length === 2);
    await settled(at);
    assert.equal(await at.locator('#pins li').count(), 2);
    await at.locator('#undo').click();
    await at.waitForFunction(() => globalThis.limberStudio.state().pins.length === 1);
    assert.deepEqual(other.errors, []);
    await other.context.close();
  },
  async 'where a skeleton is not sure, its places are asked for one by one'() {
    const other = await openStudio(browser, server.address, { search: '?sample=footstool' });
    const at = other.page, asked = at.locator('#doubts'), doubts = async () => (await sessionState(at)).doubts;
    assert.equal(await asked.isVisible(), false);
    await at.locator('#methods summary').click();
    await at.locator('#rigger').selectOption('template');
    await at.waitForFunction(() => globalThis.limberStudio.state().doubts.length > 0);
    await settled(at);
    const names = (await sessionState(at)).joints.map(({ name }) => name), [first, second] = (await doubts()).map((joint) => names[joint]);
    assert.ok(second);
    await at.locator('#right-as-it-is').click();
    await at.locator('#show-doubt').click();
    await settled(at);
    assert.match(await asked.textContent(), /Touch the model/);
    assert.equal(names[await at.evaluate(() => globalThis.limberStudio.selected())], second);
    const hips = await jointPlace(at, 'hips');
    await at.mouse.click(hips.x + 30, hips.y - 22); // the seat beside the handles
    await at.waitForFunction(() => globalThis.limberStudio.state().pins.length === 1);
    await settled(at);
    assert.deepEqual((await sessionState(at)).pins.map(({ joint }) => joint), [second]);
    assert.ok(!(await doubts()).map((joint) => names[joint]).includes(second), first);
    assert.deepEqual(other.errors, []);
    await other.context.close();
  },
  async 'an arrow of the gizmo moves the joint along its axis'() {
    await page.locator('#gizmo').check();
    const name = await freeHandle();
    await page.locator('#joints li', { hasText: name }).first().click();
    await page.locator('main canvas').focus();
    await page.keyboard.press('1');
    await page.keyboard.press('g');
    await settled(page);
    const place = await jointPlace(page, name), before = await jointPosition(page, name);
    for (const length of [70, 55, 85]) {
      await page.mouse.move(place.x, place.y - length, { steps: 2 });
      await page.mouse.down();
      await page.mouse.move(place.x, place.y - length - 30, { steps: 3 });
      await page.mouse.up();
      await settled(page);
      if (distance(await jointPosition(page, name), before) > 1e-3) break;
    }
    const [x, y, z] = (await jointPosition(page, name)).map((value, i) => value - before[i]);
    assert.ok(y > 0.01 && Math.abs(x) < y / 20 && Math.abs(z) < y / 20, `${[x, y, z]}`);
    await page.locator('#gizmo').uncheck();
    await page.locator('#undo').click();
    await settled(page);
  },
  async 'a motion plays on a model whose handles have no names, and another method takes its place'() {
    await openMotion(page, Buffer.from(walkBvh()), 'walk.bvh');
    for (const [width, height] of [[1024, 600], [844, 390], [1280, 800]]) {
      await page.setViewportSize({ width, height });
      assert.deepEqual(await timelineOverlaps(), [], `controls cover each other at ${width} x ${height}`);
    }
    await page.waitForFunction(() => Number(document.querySelector('#scrub').value) > 0.05);
    await page.locator('#play').click();
    await settled(page);
    const { clips, match } = await sessionState(page);
    assert.equal(clips[0].name, 'walk');
    assert.ok(Math.abs(clips[0].duration - 1) < 0.02);
    assert.ok(match.length >= 12, `${match.length} parts matched`);
    const foot = match.find(({ part }) => part === 'leftFoot').target.at(-1);
    await scrub(0.25);
    const forward = await jointPosition(page, foot);
    await scrub(0.75);
    const back = await jointPosition(page, foot);
    assert.ok(Math.abs(forward[2] - back[2]) > 0.1, 'the foot does not walk');
    await page.locator('#method').selectOption('aligned');
    await settled(page);
    const after = await sessionState(page);
    assert.deepEqual([after.clips.length, after.clips[0].source.method], [1, 'aligned']);
    await page.locator('#retarget summary').click();
    await page.getByLabel('left hand in the model').selectOption('');
    await settled(page);
    assert.ok(!(await sessionState(page)).match.some(({ part }) => part === 'leftHand'));
    assert.ok((await seconds()) > 0.7);
    const glb = await download(() => page.locator('#save-glb').click());
    writeFileSync(join(output, 'walking.glb'), glb);
    const { animations } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
    assert.deepEqual(animations.map((animation) => animation.name), ['walk']);
    // The native program, the same motion beside the list of commands.
    writeFileSync(join(output, 'walk.bvh'), walkBvh());
    writeFileSync(join(output, 'walking.json'), await download(() => page.locator('#export-as').selectOption('record')));
    execFileSync(program, ['session', 'replay', join(output, 'walking.json'), '-o', join(output, 'walking_native.glb'), '--quiet']);
    const there = nodesOf(readFileSync(join(output, 'walking_native.glb')));
    for (const [joint, values] of nodesOf(glb)) assert.ok(distance(values, there.get(joint)) < 1e-5, `${joint} stands elsewhere`);
  },
  async 'the clip is saved as BVH'() {
    const bvh = (await download(() => page.locator('#export-as').selectOption('bvh'))).toString();
    assert.match(bvh, /^HIERARCHY/);
    assert.equal(Number(/Frames:\s*(\d+)/.exec(bvh)[1]), 31);
    assert.equal(bvh.match(/\b(ROOT|JOINT)\b/g).length, (await jointNames()).length);
  },
  async 'a reload comes back to what was worked on'() {
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    const again = await desk.context.newPage();
    await again.goto(server.address);
    await settled(again);
    const state = await sessionState(again), before = await sessionState(page);
    for (const part of ['name', 'clips', 'motions', 'match', 'undo', 'pins']) assert.deepEqual(state[part], before[part], part);
    assert.match(await again.locator('#notice').textContent(), /another tab/);
    await again.close();
  },
  async 'an OBJ opens'() {
    const obj = await download(() => page.locator('#export-as').selectOption('obj'));
    await page.locator('#file').setInputFiles({ name: 'posed.obj', mimeType: 'model/obj', buffer: obj });
    await page.waitForFunction(() => globalThis.limberStudio.state().name === 'posed.obj');
    await settled(page);
    assert.ok((await jointNames()).length >= 3);
    assert.equal(await page.locator('#notice').isVisible(), false);
  },
  async 'a USDZ holds the posed surface'() {
    const usdz = await download(() => page.locator('#export-as').selectOption('usdz'));
    assert.equal(usdz.readUInt32LE(0), 0x04034b50); // a ZIP archive
    const { points, skinned } = readUsd(usdz), written = points.length;
    assert.equal(skinned, 0);
    assert.ok(points.flat().every(Number.isFinite));
    const triangles = Number((await page.locator('#facts').textContent()).match(/([\d,]+) triangles/)[1].replaceAll(',', ''));
    assert.equal(written, 3 * triangles); // three.js gives each triangle points of its own
  },
  async 'the keys are listed under ?'() {
    await page.keyboard.press('?');
    await page.locator('#help').waitFor();
    assert.ok(await page.locator('#help h2').evaluate((title) => title.getBoundingClientRect().top >= 0), 'it begins above the screen');
    await page.keyboard.press('Escape');
    assert.ok(!(await page.locator('#help').isVisible()));
  },
  async 'a finger drags a handle, and what is pressed is as large as a finger'() {
    const phone = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped' });
    const name = await freeHandle(phone.page), place = await jointPlace(phone.page, name);
    const before = await jointPosition(phone.page, name);
    const client = await phone.context.newCDPSession(phone.page);
    const touch = (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points });
    await touch('touchStart', [place]);
    for (let i = 1; i <= 5; ++i) await touch('touchMove', [{ x: place.x + 6 * i, y: place.y - 8 * i }]);
    await touch('touchEnd', []);
    await settled(phone.page);
    assert.ok(distance(await jointPosition(phone.page, name), before) > 0.01);
    assert.equal((await sessionState(phone.page)).undo, 'end_drag');
    const small = await phone.page.$$eval('button:not(.mark), select', (all) => all
      .map((one) => ({ name: one.textContent, box: one.getBoundingClientRect() }))
      .filter(({ box }) => box.height > 0 && (box.height < 44 || box.width < 44)).map(({ name }) => name));
    assert.deepEqual(small, []);
    assert.deepEqual(phone.errors, []);
    await phone.context.close();
  },
  async 'bad files leave a message and a living page'() {
    // A page of its own, small: what it draws costs most of the time.
    const small = await openStudio(browser, server.address, { width: 480, height: 360, search: '?sample=stool' });
    const files = [{ name: 'half.glb', buffer: Buffer.from('glTF\x02\0\0\0 nothing') }, { name: 'model.blend', buffer: Buffer.from('BLENDER') }];
    if (faulty) {
      // Some of them: the program reads them all, by the same engine.
      const all = readdirSync(faulty, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile() && /\.gl(b|tf)$/.test(entry.name));
      for (const { parentPath, name } of all.filter((_, i) => i % 6 === 0)) {
        const buffer = readFileSync(join(parentPath, name));
        if (buffer.length < 4e6) files.push({ name, buffer });
      }
    }
    let told = 0;
    let before = 'stool';
    for (const { name, buffer } of files) {
      await small.page.locator('#file').setInputFiles({ name, mimeType: 'model/gltf-binary', buffer });
      const after = await small.page.waitForFunction(() => {
        if (!globalThis.limberStudio.idle()) return null;
        const notice = document.querySelector('#notice');
        const text = notice.hidden ? null : notice.textContent;
        if (text !== null) document.querySelector('#close-notice').click();
        return { text, model: globalThis.limberStudio.state().name };
      }).then((handle) => handle.jsonValue());
      if (after.text === null) {
        before = name;
      } else {
        ++told;
        assert.match(after.text, /\S{3}/, name);
      }
      assert.equal(after.model, before, name);
    }
    assert.ok(told >= 2, `${told} of ${files.length} refused`);
    await small.page.locator('#open-recent').click();
    await small.page.locator('#recent').getByRole('button', { name: 'Person' }).click();
    await small.page.waitForFunction(() => globalThis.limberStudio.state().name === 'biped');
    assert.deepEqual(small.errors, []);
    await small.context.close();
  },
  async 'nothing was thrown'() {
    assert.deepEqual(desk.errors, []);
  },
};

/** Compressed files are among the faulty ones, whole and in good order. */
const compressed = {
  async 'glTF compressed by Draco or meshopt opens as the program reads it'() {
    const files = readdirSync(faulty, { recursive: true, withFileTypes: true }).filter(({ name }) => /(draco|meshopt)\.glb$/i.test(name));
    for (const codec of [/draco/i, /meshopt/i]) assert.ok(files.some(({ name }) => codec.test(name)));
    const { page: small, context, errors } = await openStudio(browser, server.address, { width: 480, height: 360, search: '?sample=stool' });
    for (const { parentPath, name } of files) {
      const path = join(parentPath, name);
      const { vertices, triangles, bounds } = JSON.parse(execFileSync(program, ['info', '--json', path], { stdio: ['ignore', 'pipe', 'ignore'] }));
      await small.locator('#file').setInputFiles(path);
      await small.waitForFunction((wanted) => globalThis.limberStudio.idle() && globalThis.limberStudio.state().name === wanted, name);
      const state = await sessionState(small);
      assert.deepEqual([state.vertices, state.triangles], [vertices, triangles], name);
      assert.ok(distance(state.box.min, bounds.min) < 1e-5 && distance(state.box.max, bounds.max) < 1e-5, name);
    }
    const whole = files.filter(({ name }) => /draco/i.test(name)).map(({ parentPath, name }) => readFileSync(join(parentPath, name)));
    const largest = whole.reduce((a, b) => (a.length > b.length ? a : b));
    const cut = Buffer.from(largest).fill(0, Math.round(0.7 * largest.length));
    await small.locator('#file').setInputFiles({ name: 'cut.glb', mimeType: 'model/gltf-binary', buffer: cut });
    await small.locator('#notice').waitFor();
    assert.match(await small.locator('#notice').textContent(), /Draco data are broken/);
    assert.deepEqual(errors, []);
    await context.close();
  },
};

const failed = await runCases({ ...cases, ...faulty ? compressed : {} }, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
