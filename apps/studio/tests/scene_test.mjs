// Several models in one scene: added, chosen, posed, placed, held by a hand, played, undone together, kept.
//
//   node apps/studio/tests/scene_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, dragMouse, chooseMotion, download, jointPlace, jointPosition, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { width: 1000, height: 700, search: '?sample=biped' });
let { page } = desk;
const { errors } = desk;

async function add(at, sample, { prop = false } = {}) {
  const before = (await sessionState(at)).members.length;
  await at.locator('#open-add').click();
  await at.locator('#as-prop').setChecked(prop);
  await at.locator(`#add-member [data-sample=${sample}]`).click();
  await at.waitForFunction((count) => globalThis.limberStudio.state().members.length === count, before + 1);
  await settled(at);
}
const memberAt = (member, at = page) => at.evaluate((m) => globalThis.limberStudio.memberAt(m), member);
const memberPlace = (member, { at = page, up = 0.5 } = {}) => at.evaluate((asked) => globalThis.limberStudio.memberPlace(...asked), [member, up]);
async function choose(member) {
  await page.locator(`#members [data-member="${member}"] button`).first().click();
  await settled(page);
}
const drag = (from, to) => dragMouse(page, from, to);
/** Of the chosen member: the joint of that part. */
const jointOf = async (part) => (await sessionState(page)).joints.find((joint) => joint.part === part).name;
async function pullHand() {
  const joint = await jointOf('left hand'), { x, y } = await jointPlace(page, joint), before = await jointPosition(page, joint);
  await drag({ x, y }, { x: x + 15, y: y - 60 });
  const after = await jointPosition(page, joint);
  assert.ok(Math.hypot(...after.map((value, i) => value - before[i])) > 0.1, `${joint} stayed`);
  return { before, after };
}
const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

/** All of the scene that can be told from outside. */
async function standing() {
  const { members, member, undo, redo, clip, joints } = await sessionState(page), places = [];
  for (const { name } of joints) places.push(await jointPosition(page, name));
  return { members, member, undo, redo, clip, places };
}
function expectSame(now, before) {
  const { places, ...rest } = now, { places: wanted, ...others } = before;
  assert.deepEqual(rest, others);
  places.forEach((place, joint) => assert.ok(apart(place, wanted[joint]) < 1e-5, `joint ${joint}`));
}
async function reopened() {
  await page.waitForFunction(() => globalThis.limberStudio.kept());
  await page.goto(server.address);
  await page.waitForFunction(() => globalThis.limberStudio?.idle() && globalThis.limberStudio.state());
  await settled(page);
}
/** The JSON of a GLB. */
const jsonOf = (glb) => JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());

/** What a node leaves out where it is as a rule. */
const withRests = (gltf) => ({
  ...gltf, nodes: gltf.nodes.map((node) => ({ ...node, translation: node.translation ?? [0, 0, 0], rotation: node.rotation ?? [0, 0, 0, 1], scale: node.scale ?? [1, 1, 1] })),
});
/** The sines of two machines may differ in the last bit. */
function expectAlike(now, before, path) {
  if (typeof before === 'number') return assert.ok(Math.abs(now - before) < 1e-6, path);
  if (before === null || typeof before !== 'object') return assert.equal(now, before, path);
  assert.deepEqual(Object.keys(now).sort(), Object.keys(before).sort(), path);
  for (const key of Object.keys(before)) expectAlike(now[key], before[key], `${path}/${key}`);
}
/** Without waiting for the picture. */
async function press(button) {
  await page.locator(button).click();
  await page.waitForFunction(() => globalThis.limberStudio.idle());
}

const cases = {
  async 'one model has no list of models'() {
    assert.equal(await page.locator('#scene').isVisible(), false);
  },
  async 'a person and a prop come beside the first'() {
    await add(page, 'biped');
    await add(page, 'stool', { prop: true });
    const { members, member } = await sessionState(page);
    assert.deepEqual(members.map(({ name }) => name), ['biped', 'biped 2', 'stool']);
    assert.equal(member, 2);
    assert.equal(members[2].joints.length, 1);
    assert.ok((await memberAt(1))[0] > 1 && (await memberAt(2))[0] > (await memberAt(1))[0]);
    assert.equal(await page.locator('#members li').count(), 3);
  },
  async 'a click on another model chooses it, and each is posed'() {
    for (const member of [0, 1]) {
      const { x, y } = await memberPlace(member, { up: 0.7 });
      await page.mouse.click(x, y);
      await page.waitForFunction((wanted) => globalThis.limberStudio.state().member === wanted, member);
      await settled(page);
      await pullHand();
    }
  },
  async 'a hand holds the prop, and takes it along'() {
    await choose(2);
    await page.locator('#attach-member').click();
    await page.locator('#holder optgroup').first().waitFor({ state: 'attached' });
    const hand = page.locator('#holder optgroup[label="biped"] option', { hasText: 'left hand' });
    await page.locator('#holder').selectOption(await hand.getAttribute('value'));
    await page.locator('#hold-yes').click();
    await settled(page);
    assert.equal((await sessionState(page)).members[2].attached.to, 0);
    assert.match(await page.locator('#member-about').textContent(), /biped holds stool: left hand/);
    await choose(0);
    const from = await memberAt(2), { before, after } = await pullHand(), to = await memberAt(2);
    // The hand turns, too: the stool is not farther from it than before.
    assert.ok(apart(from, to) > 0.05, 'the stool stayed');
    assert.ok(Math.abs(apart(from, before) - apart(to, after)) < 1e-4, 'the stool is elsewhere in the hand');
  },
  async 'a clip plays, and the prop goes along'() {
    await motionPlayed(page, () => chooseMotion(page, 'walk'));
    await page.waitForFunction(() => globalThis.limberStudio.state().clip !== null);
    const from = await memberAt(2);
    await page.waitForFunction((before) => globalThis.limberStudio.memberAt(2).some((value, i) => Math.abs(value - before[i]) > 0.01), from);
    await page.locator('#play').click();
    await settled(page);
  },
  async 'clips of two members play on one clock'() {
    await choose(1);
    await motionPlayed(page, () => chooseMotion(page, 'wave'));
    await page.waitForTimeout(300);
    await page.locator('#play').click();
    await settled(page);
    assert.ok((await sessionState(page)).members.filter(({ clip }) => clip !== null).length === 2);
    await page.locator('#scrub').fill('0.4');
    await settled(page);
    await choose(0);
    assert.ok(Math.abs((await sessionState(page)).seconds - 0.4) < 1e-6);
  },
  async 'placed by numbers and over the floor'() {
    await choose(1);
    await page.locator('#member-place summary').click();
    await page.locator('#member-turn').fill('90');
    await page.locator('#member-turn').press('Enter');
    await settled(page);
    await page.locator('#member-size').fill('50');
    await page.locator('#member-size').press('Enter');
    await settled(page);
    const { placement } = (await sessionState(page)).members[1];
    assert.ok(apart(placement.turn, [0, 90, 0]) < 1e-3);
    assert.equal(placement.scale, 0.5);
    await page.locator('#arrange').click();
    const before = await memberAt(1), { x, y } = await memberPlace(1);
    await drag({ x, y }, { x: x + 40, y: y + 30 });
    const after = await memberAt(1);
    assert.ok(apart(before, after) > 0.1 && Math.abs(after[1] - before[1]) < 1e-6);
    await page.locator('#arrange').click();
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.ok(apart(await memberAt(1), before) < 1e-4);
    await page.locator('#redo').click();
    await settled(page);
    assert.ok(apart(await memberAt(1), after) < 1e-4);
  },
  async 'what is taken out comes back whole'() {
    const before = await standing();
    await choose(0);
    await page.locator('#remove-member').click();
    await settled(page);
    assert.deepEqual((await sessionState(page)).members.map(({ name }) => name), ['biped 2', 'stool']);
    await page.locator('#undo').click();
    await settled(page);
    await choose(before.member);
    expectSame({ ...await standing(), redo: before.redo }, before);
  },
  async 'a reload brings the whole scene back'() {
    const before = await standing();
    await reopened();
    expectSame(await standing(), before);
    assert.equal(await page.locator('#members li').count(), 3);
  },
  async 'one file holds the scene, here and from the program'() {
    const glb = await download(page, () => page.locator('#save-glb').click());
    writeFileSync(join(output, 'scene.glb'), glb);
    const { nodes, skins, animations, scenes } = jsonOf(glb);
    assert.equal(skins.length, 3);
    assert.equal(animations.length, 2);
    assert.equal(scenes.length, 1);
    const stool = nodes.findIndex(({ name }) => name === 'stool'), holder = nodes.find(({ children }) => children?.includes(stool));
    assert.equal(holder.name, (await sessionState(page)).members[2].attached.joint);
    const limber = await download(page, () => page.locator('#export-as').selectOption('limber'));
    writeFileSync(join(output, 'scene.limber'), limber);
    execFileSync(program, ['session', 'replay', join(output, 'scene.limber'), '-o', join(output, 'scene_native.glb'), '--quiet']);
    expectAlike(withRests(jsonOf(readFileSync(join(output, 'scene_native.glb')))), withRests(jsonOf(glb)), '');
  },
  async 'a .limber file brings the scene back'() {
    const before = await standing();
    await page.locator('#samples').selectOption('stool');
    await page.waitForFunction(() => globalThis.limberStudio.state().members.length === 1);
    await settled(page);
    assert.equal(await page.locator('#scene').isVisible(), false);
    await page.locator('#file').setInputFiles(join(output, 'scene.limber'));
    await page.waitForFunction(() => globalThis.limberStudio.state().members.length === 3);
    await settled(page);
    expectSame(await standing(), before);
  },
  async 'undo goes back through all of them to the first'() {
    for (let steps = 0; await page.locator('#undo').isEnabled(); ++steps) {
      await press('#undo');
      assert.ok(steps < 60);
    }
    const { members, posed } = await sessionState(page);
    assert.equal(members.length, 1);
    assert.equal(posed, false);
    for (const count of [2, 3]) {
      await press('#redo');
      assert.equal((await sessionState(page)).members.length, count);
    }
  },
  async 'by finger on a phone; everybody can use it'() {
    const { page: phone, context, errors: thrown } = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=stool' });
    const finger = await context.newCDPSession(phone);
    const touch = (type, points) => finger.send('Input.dispatchTouchEvent', { type, touchPoints: points });
    await add(phone, 'stool', { prop: true });
    const seat = await memberPlace(0, { at: phone, up: 0.98 });
    await phone.touchscreen.tap(seat.x, seat.y);
    await phone.waitForFunction(() => globalThis.limberStudio.state().member === 0);
    await phone.locator('#arrange').tap();
    const before = await memberAt(0, phone), at = await memberPlace(0, { at: phone });
    await touch('touchStart', [at]);
    await touch('touchMove', [{ x: at.x - 20, y: at.y + 25 }]);
    await touch('touchEnd', []);
    await settled(phone);
    assert.ok(apart(before, await memberAt(0, phone)) > 0.02);
    for (const colorScheme of ['light', 'dark']) {
      await phone.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
      for (const open of [null, '#open-add', '#attach-member']) {
        if (open) await phone.locator(open).click();
        assert.deepEqual(await barriers(phone), [], `${open}, ${colorScheme}`);
        await phone.keyboard.press('Escape');
      }
    }
    assert.deepEqual(thrown, []);
    await context.close();
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
