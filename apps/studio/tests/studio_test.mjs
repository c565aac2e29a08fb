// The page in a browser, as a user has it: by mouse, by touch and by keyboard.
//
//   node apps/studio/tests/studio_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER [FAULTY_FOLDER]
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { jointPlace, jointPosition, launch, openStudio, serve, sessionState, settled } from './page.mjs';

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

async function dragByMouse(from, way) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(from.x + (way.x * i) / 5, from.y + (way.y * i) / 5);
  await page.mouse.up();
  await settled(page);
}

async function download(click) {
  const [file] = await Promise.all([page.waitForEvent('download'), click()]);
  return readFileSync(await file.path());
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
  async 'turn mode keeps the distance from the parent'() {
    await page.locator('canvas').focus();
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
    await page.locator('#ik').click();
    await settled(page);
    assert.equal((await sessionState(page)).ik, true);
    assert.equal(await page.locator('#ik').getAttribute('aria-pressed'), 'true');
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
    await page.locator('canvas').focus();
    await page.keyboard.press('ArrowRight');
    await settled(page);
    assert.ok(distance(await jointPosition(page, name), before) > 1e-4);
    await page.keyboard.press('Delete');
    await settled(page);
  },
  async 'the keys are listed under ?'() {
    await page.keyboard.press('?');
    assert.ok(await page.locator('#help').isVisible());
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
    const before = await sessionState(page);
    const files = [{ name: 'half.glb', buffer: Buffer.from('glTF\x02\0\0\0 nothing') }, { name: 'model.blend', buffer: Buffer.from('BLENDER') }];
    if (faulty) {
      for (const entry of readdirSync(faulty, { recursive: true, withFileTypes: true })) {
        if (!entry.isFile() || !/\.gl(b|tf)$/.test(entry.name)) continue;
        const buffer = readFileSync(join(entry.parentPath, entry.name));
        if (buffer.length < 4e6) files.push({ name: entry.name, buffer });
      }
    }
    let told = 0;
    for (const { name, buffer } of files) {
      await page.locator('#file').setInputFiles({ name, mimeType: 'model/gltf-binary', buffer });
      await page.waitForFunction((file) => !document.querySelector('#notice').hidden || globalThis.limberStudio.state().name === file, name);
      await settled(page);
      if (await page.locator('#notice').isVisible()) {
        ++told;
        assert.match(await page.locator('#notice').textContent(), /\S{3}/, name);
        await page.locator('#close-notice').click();
      }
    }
    assert.ok(told >= 2, `${told} of ${files.length} refused`);
    if (!faulty) assert.equal((await sessionState(page)).name, before.name);
    await page.locator('#samples').selectOption('stool');
    await page.waitForFunction(() => globalThis.limberStudio.state().name === 'stool');
  },
  async 'nothing was thrown'() {
    assert.deepEqual(desk.errors, []);
  },
};

let passed = 0, failed = 0;
for (const [name, run] of Object.entries(cases)) {
  try {
    await run();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error.stack ?? error}`);
    await page.screenshot({ path: join(output, `failed_${failed}.png`) });
  }
}
await browser.close();
server.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
