// Posing as a person means it: limbs follow, feet stand, both sides and several joints at once.
//
//   node apps/studio/tests/pose_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, jointPlace, jointPosition, lastJointOf, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { search: '?sample=biped' });
const { page } = desk;

const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const pressed = (of, selector) => of.locator(selector).getAttribute('aria-pressed');

const jointOf = (part, of = page) => lastJointOf(of, part);

async function drag(name, [x, y], of = page) {
  const from = await jointPlace(of, name);
  await of.mouse.move(from.x, from.y);
  await of.mouse.down();
  for (let i = 1; i <= 4; ++i) await of.mouse.move(from.x + (x * i) / 4, from.y + (y * i) / 4);
  await of.mouse.up();
  await settled(of);
}

async function tap(name, modifiers = []) {
  const { x, y } = await jointPlace(page, name);
  for (const key of modifiers) await page.keyboard.down(key);
  await page.mouse.click(x, y);
  for (const key of modifiers) await page.keyboard.up(key);
  await settled(page);
}

async function reset() {
  await page.locator('main canvas').focus();
  await page.keyboard.press('Alt+r');
  await settled(page);
}

const cases = {
  async 'limbs follow and both feet are held, with nothing pressed'() {
    const { ik, targets, undo } = await sessionState(page);
    assert.equal(ik, true);
    assert.equal(targets.length, 2);
    assert.equal(undo, null);
    assert.equal(await pressed(page, '#follow [data-value=follow]'), 'true');
  },
  async 'four drags: both hands up, the knees bent, the feet on the floor'() {
    const hands = [await jointOf('left hand'), await jointOf('right hand')], { joints, targets } = await sessionState(page);
    const feet = targets.map(({ joint }) => joints[joint].name), hips = joints.find(({ parent }) => parent < 0).name;
    const before = new Map(await Promise.all([...hands, ...feet, hips].map(async (name) => [name, await jointPosition(page, name)])));
    await drag(hands[0], [-20, -120]);
    await drag(hands[1], [20, -120]);
    await drag(hips, [0, 35]);
    await drag(await jointOf('head'), [12, 8]);
    for (const hand of hands) assert.ok((await jointPosition(page, hand))[1] > before.get(hand)[1] + 0.15, `${hand} is not up`);
    assert.ok((await jointPosition(page, hips))[1] < before.get(hips)[1] - 0.04);
    for (const foot of feet) assert.ok(distance(await jointPosition(page, foot), before.get(foot)) < 0.004, `${foot} slid`);
    await page.screenshot({ path: join(output, 'pose_four_drags.png') });
    await reset();
    for (const foot of feet) assert.ok(distance(await jointPosition(page, foot), before.get(foot)) < 1e-4);
    assert.equal((await sessionState(page)).targets.length, 2);
  },
  async 'both sides: what one hand does, the other does in the mirror'() {
    await page.locator('#both-sides').click();
    const left = await jointOf('left hand'), right = await jointOf('right hand');
    await drag(left, [-30, -100]);
    const [x, y, z] = await jointPosition(page, left), image = await jointPosition(page, right);
    assert.ok(y > 1, 'the hand did not rise');
    assert.ok(distance([-x, y, z], image) < 2e-3, `${[x, y, z]} and ${image}`);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal((await sessionState(page)).posed, false);
    await page.keyboard.press('s');
    assert.equal(await pressed(page, '#both-sides'), 'false');
  },
  async 'joints selected with Shift go along'() {
    await page.keyboard.press('i');
    await settled(page);
    const names = [await jointOf('left hand'), await jointOf('right hand')];
    await tap(names[0]);
    await tap(names[1], ['Shift']);
    assert.equal(await page.locator('#joints [aria-selected=true]').count(), 2);
    const before = await Promise.all(names.map((name) => jointPosition(page, name)));
    await drag(names[0], [10, -60]);
    const now = await Promise.all(names.map((name) => jointPosition(page, name)));
    const moved = now.map((place, i) => place.map((value, k) => value - before[i][k]));
    assert.ok(Math.hypot(...moved[0]) > 0.05);
    assert.ok(distance(moved[0], moved[1]) < 1e-4, `${moved}`);
    await reset();
    await tap(names[1]);
    assert.equal(await page.locator('#joints [aria-selected=true]').count(), 1);
    await page.keyboard.press('i');
    await settled(page);
  },
  async 'a stool\'s limbs follow too, and stretch where that is turned off'() {
    const stool = await openStudio(browser, server.address, { search: '?sample=stool' });
    assert.equal((await sessionState(stool.page)).ik, true);
    const followed = async () => {
      await settled(stool.page);
      const { ik } = await sessionState(stool.page);
      for (const [state, on] of [['follow', ik], ['alone', !ik]]) assert.equal(await pressed(stool.page, `#follow [data-value=${state}]`), String(on), state);
      return ik;
    };
    await stool.page.keyboard.press('i');
    assert.equal(await followed(), false);
    await stool.page.getByRole('button', { name: 'Follow', exact: true }).click();
    assert.equal(await followed(), true);
    const { undo } = await sessionState(stool.page);
    await stool.page.getByRole('button', { name: 'Follow', exact: true }).click();
    assert.equal(await followed(), true);
    assert.equal((await sessionState(stool.page)).undo, undo);
    await stool.page.getByRole('button', { name: 'Stretch', exact: true }).click();
    assert.equal(await followed(), false);
    assert.deepEqual(stool.errors, []);
    await stool.context.close();
  },
  async 'on a phone'() {
    const phone = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped' });
    const { page: small } = phone;
    await small.locator('#both-sides').tap();
    assert.deepEqual(await barriers(small), []);
    const left = await jointOf('left hand', small), right = await jointOf('right hand', small);
    await drag(left, [-10, -40], small);
    const [x, y, z] = await jointPosition(small, left);
    assert.ok(distance([-x, y, z], await jointPosition(small, right)) < 2e-3);
    await small.screenshot({ path: join(output, 'pose_phone.png') });
    assert.deepEqual(phone.errors, []);
    await phone.context.close();
  },
  async 'nothing was thrown'() { assert.deepEqual(desk.errors, []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exitCode = failed > 0 ? 1 : 0;
