// The first minute, as a novice has it: hints that come once, what is taken away and comes back by one tap, scenes to
// begin with; by mouse, and by touch on a small screen.
//
//   node apps/studio/tests/first_minute_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { answer, barriers, dragMouse, jointPlace, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { width: 1000, height: 700, search: '?sample=stool' });
let { page } = desk;
const errors = [desk.errors];

const hint = async (at = page) => (await at.locator('#hint').isVisible() ? at.locator('#hint').textContent() : null);
const notice = (at = page) => at.locator('#notice');
const moved = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

const drag = (from, to) => dragMouse(page, from, to);
/** The joint that is farthest from the root on the screen: nothing covers it. */
async function freeJoint(at = page) {
  const { joints } = await sessionState(at), root = await jointPlace(at, joints[0].name);
  let best = { far: 0 };
  for (const { name } of joints) {
    const place = await jointPlace(at, name), far = Math.hypot(place.x - root.x, place.y - root.y);
    if (far > best.far) best = { far, name, place };
  }
  return best;
}
async function openSample(value, at = page) {
  await at.locator('#samples').selectOption(value);
  await at.waitForFunction(() => globalThis.limberStudio.idle());
  await settled(at);
}
/** Does it, is told, brings it back by one press, and is as before. */
async function lostAndBack(lose, measure, at = page) {
  const before = await measure();
  await lose();
  await settled(at);
  assert.notDeepEqual(await measure(), before, 'nothing was lost');
  await notice(at).waitFor();
  await at.locator('#undo-notice').click();
  await settled(at);
  assert.deepEqual(await measure(), before);
  assert.ok(!await notice(at).isVisible());
}

const cases = {
  async 'the first hint says what to do, and goes once it was done'() {
    assert.equal(await hint(), 'Drag a red ball');
    const { name, place } = await freeJoint(), before = await jointPosition(page, name);
    await drag(place, { x: place.x + 30, y: place.y - 40 });
    assert.ok(moved(await jointPosition(page, name), before) > 0.01);
    assert.equal(await hint(), 'Drag beside the model to look from elsewhere');
  },
  async 'the second one, too'() {
    await drag({ x: 60, y: 560 }, { x: 120, y: 540 });
    assert.equal(await hint(), null);
  },
  async 'and neither comes again, on other models and other days'() {
    await openSample('biped');
    assert.equal(await hint(), null);
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    assert.equal(await page.evaluate(() => localStorage.getItem('limber.documents')), 'some', 'the next visit asks for what was kept, not for a sample');
    await page.reload();
    await settled(page);
    assert.equal(await hint(), null);
  },
  async 'a model that was taken out of the scene comes back'() {
    await page.locator('#open-add').click();
    await page.locator('#add-member [data-sample=stool]').click();
    await page.waitForFunction(() => globalThis.limberStudio.state().members.length === 2);
    await settled(page);
    assert.equal(await hint(), 'Click or tap a model to choose it');
    await lostAndBack(() => page.locator('#remove-member').click(), async () => (await sessionState(page)).members.map(({ name }) => name));
    await page.locator('#members [data-member="0"] button').first().click();
    await settled(page);
    assert.equal(await hint(), null);
    await page.locator('#undo').click();
    await settled(page);
  },
  async 'so does a joint that was deleted'() {
    await openSample('quadruped');
    await page.locator('.joints li').nth(3).click();
    await lostAndBack(() => page.locator('#delete-joint').click(), async () => (await sessionState(page)).joints.map(({ name }) => name));
  },
  async 'and a clip, and a key of it'() {
    await page.locator('#add-clip').click();
    await settled(page);
    await page.locator('#add-key').click();
    await settled(page);
    const clips = async () => (await sessionState(page)).clips.map(({ name, keys }) => [name, keys]);
    await lostAndBack(() => page.locator('#delete-key').click(), clips);
    await lostAndBack(() => page.locator('#remove-clip').click(), clips);
  },
  async 'a rig that a model came with comes back, with its clip'() {
    await openSample('flying');
    const rig = async () => {
      const { joints, clips, own_rig: own } = await sessionState(page);
      return [own, joints.length, clips.length];
    };
    assert.deepEqual(await rig(), [true, 48, 1]);
    await lostAndBack(async () => {
      await page.locator('#more-handles').click();
      await answer(page, true);
    }, rig);
  },
  async 'what is done next takes the offer away: it would undo that'() {
    await openSample('quadruped');
    await page.locator('.joints li').nth(3).click();
    await page.locator('#delete-joint').click();
    await settled(page);
    assert.ok(await page.locator('#undo-notice').isVisible());
    const { name, place } = await freeJoint();
    await drag(place, { x: place.x + 30, y: place.y - 30 });
    assert.ok((await sessionState(page)).joints.some((joint) => joint.name === name));
    assert.ok(!await notice().isVisible());
  },
  async 'a document that was forgotten is remembered again'() {
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await page.locator('#open-recent').click();
    const rows = () => page.locator('.recent-list li').count();
    await page.locator('.recent-list li').first().waitFor();
    const before = await rows();
    assert.ok(before > 0);
    await page.locator('.recent-list li').first().locator('button').last().click();
    await page.locator('#undo-forget').waitFor();
    await page.waitForFunction((count) => document.querySelectorAll('.recent-list li').length === count, before - 1);
    assert.deepEqual(await barriers(page), []);
    await page.locator('#undo-forget').click();
    await page.waitForFunction((count) => document.querySelectorAll('.recent-list li').length === count, before);
    await page.locator('.recent-list .pick').first().click();
    await settled(page);
    assert.ok((await sessionState(page)).joints.length > 0);
  },
  async 'a pose of one\'s own that was deleted, too'() {
    await page.locator('#open-poses').click();
    await page.locator('#pose-name').fill('mine');
    await page.locator('#save-pose').click();
    const card = page.locator('#pose-own li');
    await card.first().waitFor();
    await card.first().locator('.pose-actions button').last().click();
    await page.waitForFunction(() => document.querySelectorAll('#pose-own li').length === 0);
    await page.locator('#undo-pose').click();
    await card.first().waitFor();
    await page.locator('#close-poses').click();
  },
  async 'scenes are among the samples, come when they are asked for, and can be undone'() {
    const record = readdirSync(join(dist, 'assets')).find((file) => file.startsWith('eating-dinosaur'));
    const served = () => [...server.served].some((file) => file.endsWith(record));
    assert.ok(!served(), 'it was loaded before');
    await openSample('eating-dinosaur');
    assert.ok(served());
    const { joints, undo } = await sessionState(page);
    assert.equal(joints.length, 20);
    assert.equal(undo, 'attach_member', 'its prey');
    const low = (await jointPosition(page, joints.at(-1).name))[1];
    assert.ok(low < 0.45, `the snout is at ${low} m, at rest at 0.85`);
    await page.locator('#undo').click();
    await settled(page);
    assert.equal((await sessionState(page)).redo, 'attach_member');
    assert.deepEqual(await barriers(page), []);
  },
  async 'each by its name in the address, with the handles that it is told of'() {
    for (const [name, handles] of [['dancing-stool', 10], ['standing-dinosaur', 20], ['sitting-dragon', 20]]) {
      await page.goto(`${server.address}?scene=${name}`);
      await settled(page);
      assert.equal((await sessionState(page)).joints.length, handles, name);
    }
  },
  async 'a scene that there is not opens the first sample'() {
    await page.goto(`${server.address}?scene=unicorn`);
    await settled(page);
    await page.waitForFunction(() => globalThis.limberStudio.state());
    assert.ok((await sessionState(page)).joints.length > 0);
  },
  async 'by touch on a small screen: the first pose, and what was lost comes back by a tap'() {
    const phone = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=quadruped' });
    ({ page } = phone);
    errors.push(phone.errors);
    const wire = await phone.context.newCDPSession(page);
    const touch = (type, ...points) => wire.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });
    assert.equal(await hint(), 'Drag a red ball');
    const { name, place } = await freeJoint(), before = await jointPosition(page, name);
    await touch('touchStart', place);
    for (let i = 1; i <= 4; ++i) await touch('touchMove', { x: place.x, y: place.y - 10 * i });
    await touch('touchEnd');
    await settled(page);
    assert.ok(moved(await jointPosition(page, name), before) > 0.01);
    await page.locator('.joints li').nth(3).tap();
    const joints = async () => (await sessionState(page)).joints.length, all = await joints();
    await page.locator('#delete-joint').tap();
    await settled(page);
    assert.equal(await joints(), all - 1);
    const box = await page.locator('#undo-notice').boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= 390 && Math.min(box.width, box.height) >= 36, JSON.stringify(box));
    assert.deepEqual(await barriers(page), []);
    await page.locator('#undo-notice').tap();
    await settled(page);
    assert.equal(await joints(), all);
    await openSample('sitting-dragon');
    assert.equal((await sessionState(page)).joints.length, 20);
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'first_minute_phone.png') });
  },
  async 'nothing was thrown'() { assert.deepEqual(errors.flat().filter((text) => !/unicorn|Failed to load/.test(text)), []); },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
