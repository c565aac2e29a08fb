// Keys of each joint: in the sheet by mouse, touch and keyboard, as curves, as corrections of recorded motion; ghosts.
//
//   node apps/studio/tests/dope_test.mjs DIST OUTPUT_FOLDER
//
// Pictures of what it sees go into the folder. Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, chooseMotion, jointPosition, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { search: '?sample=biped' });
const { page } = desk;
const errors = [desk.errors];


const clipOf = async (of = page) => {
  const state = await sessionState(of);
  return state.clips[state.clip];
};
/** Moments of a joint's keys, or of all. */
const timesOf = async (joint, of = page) => {
  const { joint_keys: keys } = await clipOf(of);
  return keys.find((entry) => entry.joint === joint)?.seconds ?? [];
};
const near = (value, wanted, tolerance = 2e-3) => assert.ok(Math.abs(value - wanted) < tolerance, `${value} is not ${wanted}`);
const scrub = async (seconds, of = page) => {
  await of.locator('#scrub').fill(String(seconds));
  await settled(of);
};
const press = async (key, times = 1) => {
  await page.locator('main canvas').focus();
  for (let i = 0; i < times; ++i) await page.keyboard.press(key);
  await settled(page);
};
const keyOf = (joint, at, of = page) => of.locator(`.lane[data-joint="${joint}"] .key`).nth(at);
const middle = async (locator) => {
  await locator.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await locator.boundingBox();
  return { x: x + width / 2, y: y + height / 2 };
};
async function drag(from, to, hold = []) {
  for (const key of hold) await page.keyboard.down(key);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2, { steps: 3 });
  await page.mouse.move(to.x, to.y, { steps: 3 });
  await page.mouse.up();
  for (const key of hold) await page.keyboard.up(key);
  await settled(page);
}
/** Pixels of the sheet for a second. */
const pixelsPerSecond = async (joint) => {
  const [first, last] = [await middle(keyOf(joint, 0)), await middle(keyOf(joint, 1))];
  const times = await timesOf(joint);
  return (last.x - first.x) / (times[1] - times[0]);
};
const chosen = async () => page.locator('#keys-told').textContent();

let arm = 0, leg = 0;

const cases = {
  async 'what is posed becomes keys in rows'() {
    await page.locator('#add-clip').click();
    await settled(page);
    assert.ok(await page.locator('#key-editor').isHidden(), 'it is closed at first');
    await page.locator('#open-keys').click();
    assert.match(await page.locator('#dope-sheet').textContent(), /No keys yet/);
    await press('i'); // each joint moves alone, and has keys of its own
    const count = (await sessionState(page)).joints.length;
    [arm, leg] = [count - 1, count - 2];
    for (const [seconds, times] of [[0, 1], [0.5, 6], [1, 6]]) {
      if (seconds > 0) await scrub(seconds);
      for (const joint of [arm, leg]) {
        await page.locator(`#joint-${joint}`).click();
        await press('ArrowUp', times);
      }
    }
    assert.equal((await timesOf(arm)).length, 3);
    assert.equal(await page.locator(`.lane[data-joint="${arm}"] .key`).count(), 3);
    assert.ok(await page.locator(`.lane[data-joint="${leg}"]`).evaluate((row) => row.classList.contains('selected')));
    await page.screenshot({ path: join(output, 'dope_sheet.png') });
  },
  async 'a click chooses, Shift adds, a box takes what lies in it'() {
    await page.mouse.click(...Object.values(await middle(keyOf(arm, 1))));
    assert.match(await chosen(), /^1 key chosen/);
    await page.keyboard.down('Shift');
    await page.mouse.click(...Object.values(await middle(keyOf(arm, 2))));
    await page.keyboard.up('Shift');
    assert.match(await chosen(), /^2 keys/);
    const { x, y } = await middle(keyOf(arm, 1)), { x: far } = await middle(keyOf(arm, 2));
    await drag({ x: x - 20, y: y - 8 }, { x: far + 20, y: y + 8 });
    assert.match(await chosen(), /^2 keys/);
    await page.keyboard.press('Escape');
    assert.doesNotMatch(await chosen(), /chosen/);
  },
  async 'chosen keys are moved, and undone'() {
    const scale = await pixelsPerSecond(arm), from = await middle(keyOf(arm, 1));
    await drag(from, { x: from.x + 0.2 * scale, y: from.y });
    near((await timesOf(arm))[1], 0.7);
    near((await timesOf(leg))[1], 0.5);
    await page.locator('#dope-sheet').focus();
    await page.keyboard.press('ArrowLeft');
    await settled(page);
    near((await timesOf(arm))[1], 0.7 - 1 / 30);
    await page.keyboard.press('Control+z');
    await settled(page);
    await page.keyboard.press('Control+z');
    await settled(page);
    near((await timesOf(arm))[1], 0.5);
  },
  async 'handles and buttons scale them in time'() {
    await page.locator('#choose-keys').click();
    const before = await timesOf(arm), scale = await pixelsPerSecond(arm);
    const grip = await middle(page.locator('.grip.last'));
    await drag(grip, { x: grip.x + scale, y: grip.y });
    (await timesOf(arm)).forEach((seconds, i) => near(seconds, 2 * before[i]));
    near((await clipOf()).duration, 2);
    await page.locator('#scale-down').click();
    await settled(page);
    (await timesOf(arm)).forEach((seconds, i) => near(seconds, before[i]));
    const last = await middle(keyOf(arm, 2));
    await drag(last, { x: last.x + 0.5 * (await pixelsPerSecond(arm)), y: last.y }, ['Alt']);
    near((await timesOf(arm))[1], 0.75, 0.02);
    await page.keyboard.press('Control+z');
    await settled(page);
    (await timesOf(arm)).forEach((seconds, i) => near(seconds, before[i]));
  },
  async 'copied to the playhead, and deleted'() {
    await page.mouse.click(...Object.values(await middle(keyOf(leg, 1))));
    await page.keyboard.press('Control+c');
    await scrub(1.5);
    await page.locator('#dope-sheet').focus();
    await page.keyboard.press('Control+v');
    await settled(page);
    assert.equal((await timesOf(leg)).length, 4);
    near((await timesOf(leg))[3], 1.5);
    assert.equal((await timesOf(arm)).length, 3);
    assert.match(await chosen(), /^1 key chosen/, 'the copy is chosen');
    await page.keyboard.press('Delete');
    await settled(page);
    assert.equal((await timesOf(leg)).length, 3);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal((await timesOf(leg)).length, 4);
  },
  async 'zoomed in, keys lie farther apart and are chosen and moved as before'() {
    const marks = page.locator('.lane[data-joint]').first().locator('.key');
    const gap = async () => {
      const boxes = await Promise.all([marks.first().boundingBox(), marks.last().boundingBox()]);
      return boxes[1].x - boxes[0].x;
    };
    const before = await gap();
    assert.ok(before > 0);
    await page.locator('#zoom-in').click();
    await page.locator('#zoom-in').click();
    assert.ok(await gap() > 3.5 * before, 'they lie no farther apart');
    await marks.last().click();
    assert.match(await page.locator('#keys-told').textContent(), /^1 key/);
    await page.locator('#dope-sheet').focus();
    await page.keyboard.press('-');
    await page.keyboard.press('-');
    assert.ok(Math.abs(await gap() - before) < 1);
    assert.ok(await page.locator('#zoom-out').isDisabled());
  },
  async 'a key of a curve is dragged up and along'() {
    await page.locator(`#joint-${arm}`).click();
    await page.getByRole('button', { name: 'Curves', exact: true }).click();
    await page.locator('#curves circle').first().waitFor();
    await settled(page);
    assert.equal(await page.locator('#curves circle').count(), 9, 'three keys, three axes');
    const values = () => page.locator('#curves circle.x').evaluateAll((dots) => dots.map((dot) => Number(dot.getAttribute('cy'))));
    await page.getByRole('button', { name: 'Move', exact: true }).last().click();
    const before = await values(), dot = await middle(page.locator('#curves circle.x').nth(1)), position = await scrubbed(0.5);
    await drag(dot, { x: dot.x, y: dot.y - 30 });
    const after = await scrubbed(0.5);
    assert.ok(Math.hypot(...after.map((value, i) => value - position[i])) > 0.005, 'the joint has moved');
    assert.equal((await values()).length, before.length);
    const along = await middle(page.locator('#curves circle.y').nth(1));
    await drag(along, { x: along.x + 60, y: along.y });
    assert.ok((await timesOf(arm))[1] > 0.52);
    await page.screenshot({ path: join(output, 'dope_curves.png') });
    assert.deepEqual(await barriers(page), []);
  },
  async 'a tangent is dragged by its grip, undone, and made smooth again'() {
    const grips = page.locator('#curves circle.tangent'), slope = async () => {
      const { tangents } = await page.evaluate(() => globalThis.limberStudio.curve());
      return tangents[1];
    };
    assert.equal(await grips.count(), 0, 'straight lines have no tangents');
    await page.locator('#interpolation').selectOption('cubic');
    await settled(page);
    const key = page.locator('#curves circle.y:not(.tangent)').nth(1);
    await drag(await middle(key), await middle(key));
    assert.equal(await grips.count(), 6, 'two for each axis');
    assert.equal((await slope()).kind, 'auto');
    const right = page.locator('#curves circle.tangent.y[data-side="1"]'), from = await middle(right), before = await slope();
    await drag(from, { x: from.x, y: from.y - 30 });
    const after = await slope();
    assert.equal(after.kind, 'free');
    assert.ok(after.offset[1] > before.offset[1] + 0.01, `${after.offset} after ${before.offset}`);
    near(after.offset[0], before.offset[0], 1e-4);
    assert.ok(Math.abs((await middle(right)).y - (from.y - 30)) < 12, 'the grip stays where it was let go');
    await page.screenshot({ path: join(output, 'dope_tangents.png') });
    assert.deepEqual(await barriers(page), []);
    await page.locator('#undo').click();
    await settled(page);
    assert.equal((await slope()).kind, 'auto');
    await page.locator('#redo').click();
    await settled(page);
    assert.equal((await slope()).kind, 'free');
    await drag(await middle(key), await middle(key)); // undo chooses no key
    await page.locator('#tangents-flat').click();
    await settled(page);
    const { kind, offset } = await slope();
    assert.equal(kind, 'flat');
    offset.forEach((value) => near(value, 0, 1e-4));
    await page.locator('#tangents-auto').click();
    await settled(page);
    assert.equal((await slope()).kind, 'auto');
    await page.locator('#interpolation').selectOption('linear');
    await settled(page);
    await page.getByRole('button', { name: 'Sheet', exact: true }).click();
    assert.deepEqual(await barriers(page), []);
  },
  async 'keys are pasted into another clip'() {
    await page.mouse.click(...Object.values(await middle(keyOf(leg, 1))));
    await page.locator('#copy-keys').click();
    const { joints } = await sessionState(page), { name } = joints[leg];
    await page.locator('#add-clip').click();
    await settled(page);
    await press('Alt+r');
    await page.locator('#add-key').click();
    await settled(page);
    await scrub(0.4);
    const before = await jointPosition(page, name);
    await page.locator('#paste-keys').click();
    await settled(page);
    assert.equal((await sessionState(page)).undo, 'paste_keys');
    assert.ok((await timesOf(leg)).some((seconds) => Math.abs(seconds - 0.4) < 2e-3));
    assert.match(await chosen(), /^1 key chosen/, 'the pasted one is chosen');
    assert.ok(Math.hypot(...(await jointPosition(page, name)).map((value, i) => value - before[i])) > 0.01, 'the joint has moved');
    await page.locator('#remove-clip').click();
    await settled(page);
    await page.locator('#clips').selectOption({ index: 1 });
    await settled(page);
  },
  async 'it opens again as it was left'() {
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await page.goto(server.address);
    await settled(page);
    assert.ok(await page.locator('#dope-sheet').isVisible());
    assert.equal((await timesOf(leg)).length, 4);
  },
  async 'a correction of recorded motion stays when the motion is made anew'() {
    await page.goto(`${server.address}?sample=biped`);
    await settled(page);
    await motionPlayed(page, () => chooseMotion(page, 'walk'));
    await scrub(0); // it played
    const { match, joints } = await sessionState(page), [name] = match.find(({ part }) => part === 'leftHand').target;
    const hand = joints.findIndex((joint) => joint.name === name);
    assert.deepEqual((await clipOf()).keys, []);
    await page.locator('#blend').selectOption('0.6');
    await scrub(0.5);
    const before = await jointPosition(page, name);
    await page.locator(`#joint-${hand}`).click();
    await press('ArrowUp', 12);
    await scrub(0.5);
    const corrected = await jointPosition(page, name);
    assert.ok(corrected[1] - before[1] > 0.03, `${corrected} over ${before}`);
    const { joint_keys: keys } = await clipOf();
    assert.ok(keys.length >= 1 && keys.every(({ seconds }) => seconds.length === 1));
    await page.screenshot({ path: join(output, 'dope_layer.png') });
    await page.locator('#method').selectOption('aligned');
    await settled(page);
    assert.ok(await page.locator('#ask').isHidden(), 'nothing is lost, so nothing is asked');
    assert.equal((await clipOf()).source.method, 'aligned');
    assert.deepEqual((await clipOf()).joint_keys, keys);
    await page.locator('#method').selectOption('limb-ik');
    await settled(page);
    await scrub(0.5);
    (await jointPosition(page, name)).forEach((value, i) => near(value, corrected[i], 1e-6));
    // Without the key it is the motion again.
    await page.locator('#choose-keys').click();
    await page.locator('#delete-keys').click();
    await settled(page);
    (await jointPosition(page, name)).forEach((value, i) => near(value, before[i], 1e-6));
    await page.keyboard.press('Control+z');
    await settled(page);
  },
  async 'ghosts are drawn before and after'() {
    const picture = async () => (await page.locator('main canvas').screenshot()).toString('base64');
    const without = await picture();
    await page.locator('#ghosts').click();
    await page.waitForTimeout(200);
    await settled(page);
    const share = await differing(without, await picture());
    assert.ok(share > 0.002, `${share} of the picture has changed`);
    await page.screenshot({ path: join(output, 'dope_ghosts.png') });
    await page.locator('#ghosts').click();
    await page.waitForTimeout(200);
    assert.ok(await differing(without, await picture()) < 0.001);
  },
  async 'and onto another character, by the parts of its body'() {
    const partsOf = async () => {
      const { joints } = await sessionState(page);
      return (await clipOf()).joint_keys.map(({ joint }) => joints[joint].part);
    };
    await page.locator('#choose-keys').click();
    await page.locator('#copy-keys').click();
    const copied = await partsOf(), handles = (await sessionState(page)).joints.length;
    await page.locator('#samples').selectOption('biped');
    await page.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.state().clips.length === 0);
    await page.locator('#more-handles').click();
    await settled(page);
    assert.notEqual((await sessionState(page)).joints.length, handles);
    await page.locator('#add-clip').click();
    await settled(page);
    await page.locator('#paste-keys').click();
    await settled(page);
    assert.deepEqual(new Set(await partsOf()), new Set(copied));
  },
  async 'by touch on a small screen'() {
    const { page: phone, context, errors: phoneErrors } = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped' });
    errors.push(phoneErrors);
    await phone.locator('#add-clip').tap();
    await settled(phone);
    await phone.locator('#joints li').last().tap();
    for (const seconds of [0, 1]) {
      if (seconds > 0) await scrub(seconds, phone);
      await phone.locator('#add-key').tap();
      await settled(phone);
    }
    await phone.locator('#open-keys').tap();
    const root = (await clipOf(phone)).joint_keys[0].joint;
    await keyOf(root, 1, phone).tap();
    assert.match(await phone.locator('#keys-told').textContent(), /^1 key chosen/);
    await phone.locator('#copy-keys').tap();
    await scrub(0.5, phone);
    await phone.locator('#paste-keys').tap();
    await settled(phone);
    assert.equal((await timesOf(root, phone)).length, 3);
    await phone.screenshot({ path: join(output, 'dope_phone.png') });
    // A finger takes the key along.
    const { x, y, width, height } = await keyOf(root, 1, phone).boundingBox(), client = await context.newCDPSession(phone);
    const touch = (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points });
    const from = { x: x + width / 2, y: y + height / 2 };
    await touch('touchStart', [from]);
    for (let i = 1; i <= 5; ++i) await touch('touchMove', [{ x: from.x + 8 * i, y: from.y }]);
    await phone.waitForTimeout(300); // a flick would swallow the next tap
    await touch('touchEnd', []);
    await settled(phone);
    assert.ok((await timesOf(root, phone))[1] > 0.55, `${await timesOf(root, phone)}`);
    await phone.locator('#keys-told', { hasText: /^1 key chosen/ }).waitFor();
    await phone.locator('#delete-keys').tap();
    await phone.waitForFunction(() => globalThis.limberStudio.state().clips[0].joint_keys[0].seconds.length === 2);
    assert.deepEqual(await barriers(phone), []);
    await context.close();
  },
  async 'no error on the console'() {
    assert.deepEqual(errors.flat(), []);
  },
};

async function scrubbed(seconds) {
  await scrub(seconds);
  const { joints } = await sessionState(page);
  return jointPosition(page, joints[arm].name);
}

/** Share of the pixels that differ clearly. */
const differing = (a, b) => page.evaluate(async ([one, other]) => {
  const pixels = async (base64) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
  };
  const [x, y] = [await pixels(one), await pixels(other)];
  let count = 0;
  for (let i = 0; i < x.length; i += 4) if (Math.abs(x[i] - y[i]) + Math.abs(x[i + 1] - y[i + 1]) + Math.abs(x[i + 2] - y[i + 2]) > 40) ++count;
  return count / (x.length / 4);
}, [a, b]);

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed === 0 ? 0 : 1);
