// Weights by brush and joints by hand, as a person does it: with the mouse, with fingers, by the list.
//
//   node apps/studio/tests/paint_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { answer, barriers, download, jointPlace, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
let { page, errors } = await openStudio(browser, server.address, { search: '?sample=biped' });

const picture = (name) => page.screenshot({ path: join(output, `${name}.png`) });
const expectNoBarriers = async (state) => assert.deepEqual(await barriers(page), [], state);

/** The sum over all vertices of what each joint of a GLB holds, by name. */
function heldWeights(bytes) {
  const length = bytes.readUInt32LE(12), gltf = JSON.parse(bytes.subarray(20, 20 + length)), binary = bytes.subarray(28 + length);
  const read = (index) => {
    const { bufferView, byteOffset = 0, componentType, count } = gltf.accessors[index], view = gltf.bufferViews[bufferView];
    const at = (view.byteOffset ?? 0) + byteOffset;
    const one = { 5121: (i) => binary.readUInt8(at + i), 5123: (i) => binary.readUInt16LE(at + 2 * i), 5126: (i) => binary.readFloatLE(at + 4 * i) }[componentType];
    return Array.from({ length: 4 * count }, (_, i) => one(i));
  };
  const held = {};
  for (const node of gltf.nodes) {
    if (node.skin === undefined) continue;
    for (const { attributes } of gltf.meshes[node.mesh].primitives) {
      const joints = read(attributes.JOINTS_0), weights = read(attributes.WEIGHTS_0);
      weights.forEach((weight, i) => {
        const { name } = gltf.nodes[gltf.skins[node.skin].joints[joints[i]]];
        held[name] = (held[name] ?? 0) + weight;
      });
    }
  }
  return held;
}
const exported = async () => heldWeights(await download(page, () => page.locator('#save-glb').click()));

const names = async () => (await sessionState(page)).joints.map(({ name }) => name);
async function select(name) {
  await page.locator('#joints li').nth((await page.locator('#joints li').allTextContents()).findIndex((text) => text === name)).click();
}
/** Drags the mouse along points of the page. */
async function drag(points, keys = []) {
  for (const key of keys) await page.keyboard.down(key);
  await page.mouse.move(points[0].x, points[0].y);
  await page.mouse.down();
  await page.waitForFunction(() => globalThis.limberStudio.idle()); // whether it paints or turns the view is known
  for (const { x, y } of points.slice(1)) await page.mouse.move(x, y, { steps: 6 });
  await page.mouse.up();
  for (const key of keys) await page.keyboard.up(key);
  await settled(page);
}
/** What the canvas shows round a point, to see whether it has changed. */
const shownAt = async ({ x, y }) => (await page.screenshot({ clip: { x: x - 25, y: y - 25, width: 50, height: 50 } })).toString('base64');

let joint = '', far = '', place = null, before = null;
const cases = {
  async 'the brush paints what is shown and what is exported'() {
    const { joints } = await sessionState(page);
    joint = joints.at(-1).name;
    far = joints[0].name;
    before = await exported();
    place = await jointPlace(page, joint);
    await page.locator('#paint').click();
    await settled(page);
    await select(far);
    await page.locator('#brush-strength').fill('100');
    await page.locator('#brush-size').fill('60');
    await page.mouse.move(5, 400);
    await settled(page);
    const seen = await shownAt(place);
    await page.mouse.move(place.x - 10, place.y);
    await page.mouse.down();
    await page.mouse.move(place.x, place.y, { steps: 4 });
    await page.waitForTimeout(400);
    await picture('painting');
    assert.equal((await sessionState(page)).undo, null, 'the stroke is not over yet');
    assert.notEqual(await shownAt(place), seen, 'it is seen while it is painted');
    await page.mouse.up();
    await settled(page);
    await page.mouse.move(5, 400);
    await settled(page);
    assert.notEqual(await shownAt(place), seen);
    const state = await sessionState(page);
    assert.equal(state.undo, 'paint_weights');
    assert.equal(state.edited_rig, true);
    const after = await exported();
    assert.ok(after[far] > before[far] + 1, `${before[far]} -> ${after[far]}`);
    assert.ok(Math.abs(Object.values(after).reduce((a, b) => a + b) - Object.values(before).reduce((a, b) => a + b)) < 0.01);
    await expectNoBarriers('painting');
  },
  async 'one undo takes the stroke back'() {
    await page.keyboard.press('Control+z');
    await settled(page);
    const now = await exported();
    for (const [name, weight] of Object.entries(before)) assert.ok(Math.abs((now[name] ?? 0) - weight) < 1e-3, name);
    assert.ok(await page.locator('#brush-size').isVisible(), 'the brush stays in hand');
  },
  async 'Escape leaves the weights as they were'() {
    await page.mouse.move(place.x, place.y);
    await page.mouse.down();
    await page.mouse.move(place.x + 8, place.y, { steps: 3 });
    await page.waitForTimeout(200);
    await page.keyboard.press('Escape');
    await page.mouse.up();
    await settled(page);
    assert.equal((await sessionState(page)).undo, null);
  },
  async 'a locked joint keeps what it has, and others give'() {
    await select(joint);
    await page.locator('#lock-joint').click();
    await settled(page);
    assert.equal((await sessionState(page)).locked.length, 1);
    await select(far);
    await drag([{ x: place.x - 10, y: place.y }, place]);
    const after = await exported();
    assert.ok(Math.abs(after[joint] - before[joint]) < 1e-3, `${before[joint]} -> ${after[joint]}`);
    await picture('locked');
    await select(joint);
    await page.keyboard.press('l');
    await settled(page);
    assert.equal((await sessionState(page)).locked.length, 0);
  },
  async 'Ctrl takes away, Shift smooths'() {
    await page.locator('#brush-size').fill('70');
    await select(far);
    await drag([{ x: place.x - 10, y: place.y }, place]);
    const full = (await exported())[far];
    await drag([{ x: place.x - 5, y: place.y }, place], ['Shift']);
    const record = await page.evaluate(() => globalThis.limberStudio.state().undo);
    assert.equal(record, 'paint_weights');
    const smooth = (await exported())[far];
    assert.notEqual(smooth, full);
    await drag([{ x: place.x - 10, y: place.y }, place], ['Control']);
    assert.ok((await exported())[far] < smooth);
  },
  async 'both sides are painted, and one taken for the other'() {
    for (let steps = 0; (await sessionState(page)).undo !== null && steps < 20; ++steps) {
      await page.keyboard.press('Control+z');
      await settled(page);
    }
    const { joints } = await sessionState(page), rest = joints.find(({ name }) => name === joint).rest;
    const other = joints.filter(({ name }) => name !== joint)
      .sort((a, b) => Math.hypot(a.rest[0] + rest[0], a.rest[1] - rest[1], a.rest[2] - rest[2]) - Math.hypot(b.rest[0] + rest[0], b.rest[1] - rest[1], b.rest[2] - rest[2]))[0].name;
    await select(joint);
    await page.locator('#paint-both-sides').check();
    const { x, y } = await jointPlace(page, joints[joints.find(({ name }) => name === joint).parent].name);
    await drag([{ x: (x + place.x) / 2 - 5, y: (y + place.y) / 2 }, { x: (x + place.x) / 2, y: (y + place.y) / 2 }]);
    const both = await exported();
    const gained = both[joint] - before[joint], there = both[other] - before[other];
    assert.ok(gained > 0.5 && Math.abs(gained - there) < 0.1 * gained + 0.05, `${gained} and ${there}`);
    await page.locator('#paint-both-sides').uncheck();
    await select(far);
    await drag([{ x: place.x - 10, y: place.y }, place]);
    await page.locator(rest[0] > 0 ? '#mirror-weights-left' : '#mirror-weights-right').click();
    await settled(page);
    assert.equal((await sessionState(page)).undo, 'mirror_weights');
    const mirrored = await exported();
    assert.ok(Math.abs(mirrored[joint] - mirrored[other]) < 0.05, `${mirrored[joint]} and ${mirrored[other]}`);
  },
  async 'beside the model and with Alt the view turns, and brackets change the brush'() {
    const { undo } = await sessionState(page), at = await jointPlace(page, joint), size = Number(await page.locator('#brush-size').inputValue());
    await drag([{ x: 60, y: 700 }, { x: 160, y: 700 }]);
    const turned = await jointPlace(page, joint);
    assert.ok(Math.hypot(turned.x - at.x, turned.y - at.y) > 3, 'beside the model');
    await drag([turned, { x: turned.x - 100, y: turned.y }], ['Alt']);
    assert.notDeepEqual(await jointPlace(page, joint), turned, 'with Alt');
    assert.equal((await sessionState(page)).undo, undo, 'nothing was painted');
    await page.keyboard.press(']');
    assert.ok(Number(await page.locator('#brush-size').inputValue()) > size);
    const { name, rest } = (await sessionState(page)).joints.at(-2);
    await page.locator('#view-front').click();
    await page.keyboard.down('Alt');
    const clicked = await jointPlace(page, name);
    await page.mouse.click(clicked.x, clicked.y);
    await page.keyboard.up('Alt');
    await settled(page);
    const picked = (await sessionState(page)).joints[await page.evaluate(() => globalThis.limberStudio.selected())];
    assert.ok(Math.hypot(picked.rest[0] - rest[0], picked.rest[1] - rest[1]) < 0.1, `${picked.name} for ${name}`);
    await page.getByRole('button', { name: 'Handles', exact: true }).click();
    await settled(page);
    assert.equal(await page.locator('#brush-size').isVisible(), false, 'with handles shown nobody paints');
  },
  async 'a rig that was painted is not replaced unasked'() {
    await page.locator('.mark').first().click();
    await answer(page, false);
    assert.equal((await sessionState(page)).edited_rig, true);
  },
  async 'a joint is added where the model is clicked, hung elsewhere, and deleted'() {
    await page.locator('#view-front').click();
    const known = await names(), parent = (await sessionState(page)).joints.at(-1).name;
    await select(parent);
    await page.locator('#add-joint').click();
    assert.ok(await page.locator('#place-hint').isVisible());
    await picture('placing');
    await expectNoBarriers('placing a joint');
    const at = await jointPlace(page, parent);
    await page.mouse.click(at.x + 3, at.y + 3);
    await settled(page);
    const [added] = (await names()).filter((name) => !known.includes(name));
    assert.ok(added);
    const seen = await jointPlace(page, added);
    assert.ok(Math.hypot(seen.x - at.x - 3, seen.y - at.y - 3) < 3, 'inside, below the pointer');
    const parentOf = async (name) => {
      const { joints } = await sessionState(page), { parent: above } = joints.find((known) => known.name === name);
      return joints[above]?.name;
    };
    assert.equal(await parentOf(added), parent);
    const stood = await jointPosition(page, added);
    await page.locator('#hang-joint').click();
    await page.locator('#choose-from').selectOption(far);
    await expectNoBarriers('choosing a joint');
    await picture('hanging');
    await page.locator('#choose-yes').click();
    await settled(page);
    assert.equal(await parentOf(added), far);
    (await jointPosition(page, added)).forEach((value, i) => assert.ok(Math.abs(value - stood[i]) < 1e-5));
    await page.locator('#delete-joint').click();
    await settled(page);
    assert.deepEqual((await names()).sort(), known.sort());
    assert.equal((await sessionState(page)).undo, 'delete_joint');
  },
  async 'a finger paints, two turn'() {
    const phone = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped' });
    page = phone.page;
    errors.push(...phone.errors);
    await page.locator('#paint').tap();
    await settled(page);
    await page.locator('#brush-strength').fill('100');
    const target = (await sessionState(page)).joints.at(-1).name, at = await jointPlace(page, target);
    const wire = await phone.context.newCDPSession(page);
    const touch = (type, ...points) => wire.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });
    await touch('touchStart', at);
    for (let i = 1; i <= 4; ++i) await touch('touchMove', { x: at.x + i, y: at.y });
    await touch('touchEnd');
    await settled(page);
    assert.equal((await sessionState(page)).undo, 'paint_weights');
    const two = (shift) => [{ x: 120 + shift, y: 250 }, { x: 260 + shift, y: 250 }];
    const [first] = two(0);
    await touch('touchStart', first);
    await touch('touchStart', ...two(0));
    for (let shift = 10; shift <= 60; shift += 10) await touch('touchMove', ...two(shift));
    await touch('touchEnd');
    await settled(page);
    const turned = await jointPlace(page, target);
    assert.ok(Math.hypot(turned.x - at.x, turned.y - at.y) > 3);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal((await sessionState(page)).undo, null, 'two fingers painted nothing');
    await picture('phone');
    await expectNoBarriers('painting with fingers');
    errors.push(...phone.errors);
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
