// Tools for exact posing: several joints by box and by touch, numbers, the magnet, axes of the gizmo, arrow keys, tasks; limbs in colours.
//
//   node apps/studio/tests/tools_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { Quaternion, Vector3 } from 'three';
import { barriers, download, jointPlace, jointPosition, lastJointOf, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { readUsd } from './usd_points.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const desk = await openStudio(browser, server.address, { search: '?sample=biped' });
const { page } = desk;

const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const near = (a, b, within, what) => assert.ok(distance(a, b) <= within, `${what ?? ''} ${a} is not ${b}`);
const turned = (name, of = page) => of.evaluate((joint) => globalThis.limberStudio.turned(joint), name);
const chosen = (of = page) => of.locator('#joints [aria-selected=true]').evaluateAll((rows) => rows.map((row) => Number(row.dataset.joint)));

const jointOf = (part, of = page) => lastJointOf(of, part);
async function parentOf(name) {
  const { joints } = await sessionState(page);
  return joints[joints.find((joint) => joint.name === name).parent].name;
}

async function dragMouse(from, [x, y], keys = []) {
  for (const key of keys) await page.keyboard.down(key);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let i = 1; i <= 4; ++i) await page.mouse.move(from.x + (x * i) / 4, from.y + (y * i) / 4);
  await page.mouse.up();
  for (const key of keys) await page.keyboard.up(key);
  await settled(page);
}
const drag = async (name, by, keys) => dragMouse(await jointPlace(page, name), by, keys);

async function select(name, ...others) {
  for (const [i, joint] of [name, ...others].entries()) {
    const { joints } = await sessionState(page);
    await page.locator(`#joint-${joints.findIndex((known) => known.name === joint)}`).click({ modifiers: i > 0 ? ['Shift'] : [] });
  }
}
async function press(key) {
  await page.locator('main canvas').focus();
  await page.keyboard.press(key);
  await settled(page);
}
/** How far the surface reaches above a joint, in metres. */
async function reachAbove(name) {
  const { points } = readUsd(await download(page, () => page.locator('#export-as').selectOption('usdz')));
  return Math.max(...points.map(([, y]) => y)) - (await jointPosition(page, name))[1];
}
/** Back to the pose at rest, nothing selected. */
async function reset() {
  if ((await sessionState(page)).posed) await press('Alt+r');
  await page.evaluate(() => document.activeElement?.blur());
}
async function type(field, value, end = 'Enter') {
  await page.locator(field).fill(String(value));
  await page.locator(field).press(end);
  await settled(page);
}
const valueOf = async (field) => Number(await page.locator(field).inputValue());

const ringRadius = 62; // pixels; arrows are a little longer
/** Where the pointer meets the X of the gizmo, looked for first where it should be from there, in pixels. */
async function gizmoX(name, [x, y]) {
  const middle = await jointPlace(page, name), places = [0.95, 1, 0.9, 1.05, 0.8].map((times) => [times * x, times * y]);
  for (const radius of [60, 54, 68, 44, 36]) {
    for (let angle = 0; angle < 2 * Math.PI; angle += 0.2) places.push([radius * Math.cos(angle), radius * Math.sin(angle)]);
  }
  for (const out of places) {
    const at = { x: middle.x + out[0], y: middle.y + out[1] };
    await page.mouse.move(at.x, at.y);
    if (await page.evaluate(() => globalThis.limberStudio.gizmoAxis()) === 'X') return { at, out };
  }
  throw new Error('the gizmo has no X');
}
/** Seen from the front: the arrow along that way, and the ring about it where it is at its widest. */
const arrowAlong = ({ x, y }) => [ringRadius * x, -ringRadius * y];
const ringAbout = ({ x, y }) => [ringRadius * (y / Math.hypot(x, y)), ringRadius * (x / Math.hypot(x, y))];

let left, right, elbow;
const cases = {
  async 'a box with Shift beside the model adds the joints in it, and the camera stays'() {
    left = await jointOf('left hand');
    right = await jointOf('right hand');
    elbow = await parentOf(left);
    const a = await jointPlace(page, left), b = await jointPlace(page, elbow);
    const corner = { x: Math.min(a.x, b.x) - 30, y: Math.min(a.y, b.y) - 30 };
    const by = [Math.max(a.x, b.x) + 30 - corner.x, Math.max(a.y, b.y) + 30 - corner.y];
    await dragMouse(corner, by, ['Shift']);
    const { joints } = await sessionState(page), both = await chosen();
    for (const name of [left, elbow]) assert.ok(both.includes(joints.findIndex((joint) => joint.name === name)), `${name} is not in the box`);
    near(Object.values(await jointPlace(page, left)), Object.values(a), 0.1, 'the camera moved:');
    const far = await jointPlace(page, right);
    await dragMouse({ x: far.x - 20, y: far.y - 30 }, [40, 60], ['Shift']);
    assert.ok((await chosen()).length > both.length);
    assert.equal((await sessionState(page)).undo, null);
    assert.equal(await page.locator('.select-box').count(), 0);
    await page.locator('#selected-told', { hasText: `${(await chosen()).length} selected` }).waitFor();
    await dragMouse({ x: 30, y: 700 }, [60, -40]);
    assert.ok(distance(Object.values(await jointPlace(page, left)), Object.values(a)) > 1, 'a drag beside no longer turns the view');
    await press('1');
  },
  async 'what is done to several joints is one step'() {
    await select(left, right);
    assert.equal((await chosen()).length, 2);
    const targets = (await sessionState(page)).targets.length;
    await page.locator('#pin').click();
    await settled(page);
    assert.equal((await sessionState(page)).targets.length, targets + 2);
    await press('p');
    assert.equal((await sessionState(page)).targets.length, targets);
    await page.locator('#lock-joint').click();
    await settled(page);
    assert.equal((await sessionState(page)).locked.length, 2);
    await press('l');
    assert.equal((await sessionState(page)).locked.length, 0);
    await press('r');
    await press('ArrowUp');
    for (const name of [left, right]) near([Math.hypot(...(await turned(name)).turn)], [5], 1e-3, name);
    await press('Delete');
    for (const name of [left, right]) near((await turned(name)).turn, [0, 0, 0], 1e-3, name);
    await press('Control+z');
    near([Math.hypot(...(await turned(right)).turn)], [5], 1e-3);
    await press('g');
    await reset();
  },
  async 'typed numbers put the joint exactly there, each one step'() {
    await select(elbow);
    await page.locator('#exact summary').click();
    assert.ok((await page.locator('#turn-y').boundingBox()).width > 30, 'the number has no room');
    await type('#turn-y', 25.5);
    near((await turned(elbow)).turn, [0, 25.5, 0], 1e-4);
    await type('#turn-z', -40, 'Tab');
    near((await turned(elbow)).turn, [0, 25.5, -40], 1e-4);
    assert.equal(await page.evaluate(() => document.activeElement.id), 'place-x');
    assert.equal((await sessionState(page)).undo, 'set_turn');
    await page.locator('#turn-z').press('ArrowUp');
    await settled(page);
    near((await turned(elbow)).turn, [0, 25.5, -39], 1e-4);
    for (let step = 0; step < 3; ++step) await press('Control+z');
    near((await turned(elbow)).turn, [0, 0, 0], 1e-4);
    assert.equal(await valueOf('#turn-y'), 0);

    await select(left);
    const from = await jointPosition(page, left), bone = distance(from, await jointPosition(page, elbow));
    await type('#place-y', (from[1] + 0.12).toFixed(3));
    const now = await jointPosition(page, left);
    near(now, [from[0], Number((from[1] + 0.12).toFixed(3)), from[2]], 1e-3);
    assert.ok(Math.abs(distance(now, await jointPosition(page, elbow)) - bone) < 1e-4, 'the arm was stretched');
    assert.equal(await valueOf('#place-y'), Number(now[1].toFixed(3)));
    await page.locator('#place-y').fill('0.5');
    await page.locator('#place-y').press('Escape');
    assert.equal(await valueOf('#place-y'), Number(now[1].toFixed(3)));
    await page.screenshot({ path: join(output, 'tools_exact.png') });
    await press('Control+z');
    assert.equal((await sessionState(page)).posed, false);
  },
  async 'the numbers follow a drag, and several joints turn alike'() {
    const { x, y } = await jointPlace(page, left), before = await valueOf('#place-x');
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x - 15, y - 10);
    await page.mouse.move(x - 30, y - 20);
    await page.waitForFunction((value) => Number(document.querySelector('#place-x').value) !== value, before);
    await page.mouse.up();
    await settled(page);
    await reset();
    await select(left, right);
    await type('#turn-x', 20);
    for (const name of [left, right]) near((await turned(name)).turn, [20, 0, 0], 1e-3, name);
    assert.match(await page.locator('#exact-of').textContent(), /\+ 1$/);
    await press('Control+z');
    await select(left);
    await page.locator('#both-sides').click();
    await type('#turn-x', 30);
    near([Math.hypot(...(await turned(right)).turn)], [30], 1e-3, 'the other side');
    await page.locator('#both-sides').click();
    await reset();
  },
  async 'a joint is scaled by a number, a drag, keys and the gizmo, each one step; the surface grows, and a file keeps it'() {
    const head = await jointOf('head');
    await select(head);
    const rest = await reachAbove(head);
    assert.equal(await valueOf('#scale'), 1);
    await type('#scale', 1.5);
    assert.equal((await sessionState(page)).undo, 'set_scale');
    const grown = await reachAbove(head) / rest;
    assert.ok(grown > 1.35 && grown < 1.55, `${grown} times as high`);
    await page.screenshot({ path: join(output, 'tools_scaled.png') });
    await press('Control+z');
    assert.equal(await valueOf('#scale'), 1);
    near([await reachAbove(head)], [rest], 1e-5);

    await page.locator('#both-sides').click();
    await select(left);
    await type('#scale', 1.25);
    await select(right);
    assert.equal(await valueOf('#scale'), 1.25);
    await page.locator('#both-sides').click();
    await press('Control+z');

    await press('Shift+S');
    assert.equal(await page.locator('.pose [data-value=scale]').getAttribute('aria-pressed'), 'true');
    const { x, y } = await jointPlace(page, head);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y - 20);
    await page.mouse.move(x, y - 40);
    await page.waitForFunction(() => Number(document.querySelector('#scale').value) > 1); // already while it is dragged
    await page.mouse.up();
    await settled(page);
    assert.ok(await reachAbove(head) > 1.1 * rest);
    await press('Control+z');
    assert.equal(await valueOf('#scale'), 1);
    await press('ArrowUp');
    await press('ArrowUp');
    near([await valueOf('#scale')], [1.05 ** 2], 0.006);
    await press('Control+z');
    await page.locator('.checks label', { hasText: 'Arrows' }).click();
    const box = await gizmoX(head, [ringRadius, 0]);
    await dragMouse(box.at, box.out.map((value) => 0.4 * value));
    near([await valueOf('#scale')], [1.4], 0.1);
    await page.screenshot({ path: join(output, 'tools_scaling.png') });
    await page.locator('.checks label', { hasText: 'Arrows' }).click();
    await type('#scale', 0);
    assert.equal(await valueOf('#scale'), 0.01);
    await type('#scale', 0.8);

    const file = await download(page, () => page.locator('#export-as').selectOption('limber'));
    const again = await openStudio(browser, server.address, { search: '?sample=stool' });
    await again.page.locator('#file').setInputFiles({ name: 'scaled.limber', mimeType: 'application/octet-stream', buffer: file });
    await again.page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'biped');
    await settled(again.page);
    await again.page.locator('#exact summary').click();
    await again.page.locator(`#joint-${(await sessionState(page)).joints.findIndex(({ name }) => name === head)}`).click();
    await again.page.waitForFunction(() => document.querySelector('#scale').value === '0.8');
    assert.deepEqual(again.errors, []);
    await again.context.close();
    await press('g');
    await reset();
    await select(left);
    assert.equal(await valueOf('#scale'), 1);
  },
  async 'what is typed at the moment of a clip becomes a key'() {
    await page.locator('#add-clip').click();
    await settled(page);
    await select(left);
    await type('#turn-z', 15);
    assert.deepEqual((await sessionState(page)).clips[0].keys, [0]);
    for (let step = 0; step < 3; ++step) await press('Control+z');
    assert.equal((await sessionState(page)).clips.length, 0);
  },
  async 'the magnet: places on the grid, feet on the floor, turns in steps; Ctrl turns it round'() {
    const { snap: { step }, joints, targets } = await sessionState(page);
    await page.locator('#magnet').click();
    await drag(left, [-37, -53]);
    for (const value of await jointPosition(page, left)) assert.ok(Math.abs(value / step - Math.round(value / step)) < 0.03, `${value} is not on the grid`);
    await drag(left, [21, 13], ['Control']);
    const free = await jointPosition(page, left);
    assert.ok(free.some((value) => Math.abs(value / step - Math.round(value / step)) > 0.05), `${free} is on the grid`);
    await reset();
    const foot = joints[targets[0].joint].name, floor = (await jointPosition(page, foot))[1];
    await drag(foot, [0, -60]);
    assert.ok((await jointPosition(page, foot))[1] > floor + 2 * step);
    const lifted = await jointPlace(page, foot), above = (await jointPosition(page, foot))[1] - floor;
    const pixels = 60 / above; // for a metre, more or less
    await drag(foot, [0, (above - 0.4 * step) * pixels]);
    near([(await jointPosition(page, foot))[1]], [floor], 2e-3, `from ${lifted.y}, the foot`);
    await reset();
    await press('r');
    await drag(left, [-20, -71]);
    const degrees = Math.hypot(...(await turned(elbow)).turn, ...(await turned(left)).turn);
    assert.ok(degrees > 10 && Math.abs(degrees / 15 - Math.round(degrees / 15)) < 1e-3, `${degrees} degrees`);
    await press('g');
    await press('n');
    assert.equal(await page.locator('#magnet').getAttribute('aria-pressed'), 'false');
    await reset();
  },
  async 'arrows and rings stand as the chosen space does'() {
    await page.locator('#follow [data-value=alone]').click();
    await select(elbow);
    await type('#turn-y', 30);
    await type('#turn-z', 50);
    await page.locator('.checks label', { hasText: 'Arrows' }).click();
    const above = await parentOf(elbow), axis = new Vector3(1, 0, 0);
    const spaces = {
      world: async () => new Quaternion(), parent: async () => new Quaternion(...(await turned(above)).rotation),
      local: async () => new Quaternion(...(await turned(elbow)).rotation),
    };
    for (const [space, frame] of Object.entries(spaces)) {
      await page.locator('#gizmo-space').selectOption(space);
      const way = axis.clone().applyQuaternion(await frame());
      await press('g');
      const arrow = await gizmoX(elbow, arrowAlong(way)), from = new Vector3(...await jointPosition(page, elbow));
      await dragMouse(arrow.at, arrow.out.map((value) => value * 0.6));
      const moved = new Vector3(...await jointPosition(page, elbow)).sub(from);
      assert.ok(moved.length() > 0.01, `${space}: nothing moved`);
      assert.ok(Math.abs(moved.normalize().dot(way)) > 1 - 1e-5, `${space}: moved along ${moved.toArray()}, not ${way.toArray()}`);
      await press('Control+z');
      await press('r');
      const ring = await gizmoX(elbow, ringAbout(way)), before = new Quaternion(...(await turned(elbow)).rotation);
      await dragMouse(ring.at, ring.out.map((value) => value * 0.5)); // across the axis, as seen
      const turn = new Quaternion(...(await turned(elbow)).rotation).multiply(before.invert()), about = new Vector3(turn.x, turn.y, turn.z);
      assert.ok(about.length() > 0.02, `${space}: nothing turned`);
      assert.ok(Math.abs(about.normalize().dot(way)) > 1 - 1e-4, `${space}: turned about ${about.toArray()}, not ${way.toArray()}`);
      if (space === 'local') await page.screenshot({ path: join(output, 'tools_gizmo.png') });
      await press('Control+z');
    }
    await press('g');
    await page.locator('#magnet').click();
    const { snap: { step } } = await sessionState(page), own = axis.clone().applyQuaternion(await spaces.local());
    const arrow = await gizmoX(elbow, arrowAlong(own));
    await dragMouse(arrow.at, arrow.out.map((value) => value * 0.5));
    const along = new Vector3(...await jointPosition(page, elbow)).dot(own);
    assert.ok(Math.abs(along / step - Math.round(along / step)) < 0.02, `${along} along its own axis is no step`);
    await page.locator('#magnet').click();
    await press('Control+z');
    await page.locator('#gizmo-space').selectOption('view');
    await press('3');
    const across = await gizmoX(elbow, [ringRadius, 0]), from = await jointPosition(page, elbow);
    await dragMouse(across.at, across.out.map((value) => value * 0.5));
    const [x, y, z] = (await jointPosition(page, elbow)).map((value, i) => value - from[i]);
    assert.ok(Math.abs(z) > 0.01 && Math.hypot(x, y) < 1e-4, `across the view from the side: ${[x, y, z]}`);
    await page.reload();
    await settled(page);
    assert.equal(await page.locator('#gizmo-space').inputValue(), 'view', 'the space was not remembered');
  },
  async 'arrow keys take the limb along, and a run of presses is one step'() {
    await page.goto('about:blank'); // what the last case moved apart would stay so over a reload
    await page.goto(`${server.address}?sample=biped`);
    await settled(page);
    await press('1');
    await select(left);
    const from = await jointPosition(page, left), bone = distance(from, await jointPosition(page, elbow)), { undo } = await sessionState(page);
    await page.locator('main canvas').focus();
    for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowUp');
    await settled(page);
    const now = await jointPosition(page, left);
    assert.ok(now[1] > from[1] + 0.03, `${from} to ${now}`);
    assert.ok(Math.abs(distance(now, await jointPosition(page, elbow)) - bone) < 1e-4, 'the arm was stretched');
    await press('Control+z');
    near(await jointPosition(page, left), from, 1e-5, 'the run is more than a step:');
    assert.equal((await sessionState(page)).undo, undo);
  },
  async 'tasks are asked for by mouse and keyboard, say what became of them, and are one step each'() {
    await page.goto('about:blank');
    await page.goto(`${server.address}?sample=biped`);
    await settled(page);
    const tasks = async () => (await sessionState(page)).tasks, rows = page.locator('#task-list li');
    await page.locator('#tasks summary').click();
    await page.locator('#task-look').waitFor();
    assert.ok(await page.locator('#task-look').isDisabled(), 'no joint is selected');
    const head = await jointOf('head'), rest = (await turned(head)).rotation;
    await press('3');
    await select(head);
    await page.locator('#task-look').focus();
    await page.keyboard.press('Enter');
    await settled(page);
    assert.deepEqual((await tasks()).map(({ met, task }) => [met, task.startsWith(`look-at:${head}=`)]), [[true, true]]);
    const looks = (await turned(head)).rotation, turn = new Quaternion(...looks).angleTo(new Quaternion(...rest)) * (180 / Math.PI);
    assert.ok(turn > 60 && turn < 120, `seen from the side it turned by ${turn} degrees`);
    await page.locator('#task-balance').click();
    await settled(page);
    assert.equal((await tasks()).length, 2);
    assert.equal(await page.locator('#task-balance').getAttribute('aria-pressed'), 'true');
    await select(left);
    await page.locator('#task-ground').click();
    await settled(page);
    await page.locator('#task-kind').selectOption('position');
    assert.ok((await page.locator('#task-text').inputValue()).startsWith(`position:${left}=`));
    await type('#task-text', `position:${left}=9,9,9@priority=1`);
    assert.deepEqual((await tasks()).map(({ met }) => met), [true, true, true, false]);
    assert.match(await rows.nth(3).textContent(), /\d\.\d+ m left: other tasks are in the way/);
    await type('#task-text', 'stare:head=1,2,3');
    await page.locator('#notice', { hasText: 'no kind of task' }).waitFor();
    await page.locator('#close-notice').click();
    assert.equal((await tasks()).length, 4);
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'tools_tasks.png') });
    await rows.nth(3).locator('button').last().focus();
    await page.keyboard.press('Enter');
    assert.equal(await rows.count(), 3);
    await press('Alt+r');
    await page.locator('#tasks-again').click();
    await settled(page);
    assert.deepEqual((await tasks()).map(({ met }) => met), [true, true, true]);
    await press('Control+z');
    assert.deepEqual((await sessionState(page)).tasks, []);
    assert.equal(await rows.filter({ hasText: 'not in this pose' }).count(), 3);
    await page.locator('#tasks summary').click();
  },
  async 'limbs are shown in their colours, by name, and anew for another rig'() {
    const handles = page.locator('.pose [data-value=handles]'), legend = page.locator('#legend li');
    await page.locator('.pose [data-value=parts]').click();
    await legend.first().waitFor();
    await page.locator('#methods summary').click();
    await page.locator('#rigger').selectOption('template');
    await legend.filter({ hasText: 'left arm' }).waitFor();
    await settled(page);
    const names = await legend.allTextContents();
    assert.ok(['right arm', 'left leg', 'right leg'].every((name) => names.includes(name)), names.join());
    assert.equal(new Set(await legend.locator('.swatch').evaluateAll((all) => all.map(({ style }) => style.background))).size, names.length);
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'tools_limbs.png') });
    await handles.click();
    assert.ok(await page.locator('#legend').isHidden());
    await press('Control+z');
    await page.locator('#methods summary').click();
  },
  async 'by touch: taps and a box select, two fingers still move the camera'() {
    const phone = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, search: '?sample=biped' });
    const { page: small } = phone;
    const wire = await phone.context.newCDPSession(small);
    const touch = (kind, ...points) => wire.send('Input.dispatchTouchEvent', { type: kind, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });
    const tap = async ({ x, y }) => {
      await small.touchscreen.tap(x, y);
      await settled(small);
    };
    const hands = [await jointOf('left hand', small), await jointOf('right hand', small)];
    await small.locator('#select-several').tap();
    await small.locator('#selected-told', { hasText: 'Tap joints' }).waitFor();
    for (const name of hands) await tap(await jointPlace(small, name));
    assert.equal((await chosen(small)).length, 2);
    await tap(await jointPlace(small, hands[1]));
    assert.equal((await chosen(small)).length, 1);
    const at = await jointPlace(small, hands[1]);
    await touch('touchStart', { x: at.x - 25, y: at.y - 30 });
    for (let i = 1; i <= 5; ++i) await touch('touchMove', { x: at.x - 25 + 10 * i, y: at.y - 30 + 12 * i });
    await small.screenshot({ path: join(output, 'tools_phone_box.png') });
    await touch('touchEnd');
    await settled(small);
    assert.ok((await chosen(small)).length >= 2);
    near(Object.values(await jointPlace(small, hands[1])), Object.values(at), 0.5, 'the camera moved:');
    const count = (await chosen(small)).length, two = (gap) => [{ x: 190 - gap, y: 260 }, { x: 200 + gap, y: 260 }];
    await touch('touchStart', two(30)[0]);
    await touch('touchStart', ...two(30));
    for (let i = 1; i <= 5; ++i) await touch('touchMove', ...two(30 + 8 * i));
    await touch('touchEnd');
    await settled(small);
    assert.ok(distance(Object.values(await jointPlace(small, hands[1])), Object.values(at)) > 3, 'two fingers did not zoom');
    assert.equal((await chosen(small)).length, count);
    assert.equal((await sessionState(small)).undo, null);
    await small.locator('#select-several').tap();
    await small.locator('#magnet').tap();
    await small.locator('#exact summary').scrollIntoViewIfNeeded();
    await small.locator('#exact summary').tap();
    await small.locator('#turn-z').scrollIntoViewIfNeeded();
    await small.locator('#turn-z').tap();
    await small.locator('#turn-z').fill('12');
    await small.locator('#turn-z').press('Enter');
    await settled(small);
    near((await turned(hands[0], small)).turn, [0, 0, 12], 1e-3);
    await small.screenshot({ path: join(output, 'tools_phone.png') });
    assert.deepEqual(await barriers(small), []);
    const narrow = await small.$$eval('.pose-tools button, .exact input', (all) => all.filter((one) => one.checkVisibility() && one.closest('label, button').getBoundingClientRect().height < 44).map(({ id }) => id));
    assert.deepEqual(narrow, [], 'smaller than a finger');
    assert.deepEqual(phone.errors, []);
    await phone.context.close();
  },
  async 'everybody can use the tools, in the light and in the dark'() {
    await select(left, right);
    await page.locator('#select-several').click();
    if (!await page.locator('#turn-x').isVisible()) await page.locator('#exact summary').click();
    await page.locator('.checks label', { hasText: 'Arrows' }).click();
    for (const colorScheme of ['light', 'dark']) {
      await page.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
      assert.deepEqual(await barriers(page), [], colorScheme);
      await page.screenshot({ path: join(output, `tools_${colorScheme}.png`) });
    }
    await press('Escape');
    assert.equal(await page.locator('#select-several').getAttribute('aria-pressed'), 'false');
  },
  async 'nothing was thrown'() { assert.deepEqual(desk.errors, []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exitCode = failed > 0 ? 1 : 0;
