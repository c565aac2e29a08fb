// Augmented reality on a phone that emulates WebXR: placed, posed, moved, scaled, kept, with all that can go wrong.
//
//   node apps/studio/tests/ar_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, chooseMotion, download, jointPosition, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { emulatePhone, table } from './xr_phone.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const first = { x: 0, y: 1.5, z: 0 }; // metres: where the phone is at first
let { page, context, errors, finger } = await openPhone('?sample=biped');

async function openPhone(search, options = {}) {
  const opened = await openStudio(browser, server.address, {
    width: 390, height: 844, touch: true, search, prepare: (before) => emulatePhone(before, options),
  });
  opened.page.setDefaultTimeout(20_000);
  return { ...opened, finger: await opened.context.newCDPSession(opened.page) };
}
/** Another phone, for the steps alone. */
async function onPhone(search, options, steps) {
  const before = { page, context, errors, finger };
  ({ page, context, errors, finger } = await openPhone(search, options));
  try {
    await steps();
    assert.deepEqual(errors, []);
  } finally {
    await context.close();
    ({ page, context, errors, finger } = before);
  }
}
const frames = (count = 3) => page.evaluate((n) => new Promise((done) => {
  const next = () => (n-- > 0 ? requestAnimationFrame(next) : done());
  next();
}), count);
const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
async function stand(at, turn = 0, tilt = -20) {
  await page.evaluate((asked) => phone.stand(...asked), [at, turn, tilt]);
  await frames();
}
async function touch(type, points) {
  await page.evaluate((all) => { phone.fingers = new Map(all.map((point, id) => [id, point])); }, points);
  await finger.send('Input.dispatchTouchEvent', { type, touchPoints: points.map((point, id) => ({ ...point, id })) });
  await frames(2);
}
async function drag(from, to, steps = 4) {
  await touch('touchStart', [from]);
  for (let i = 1; i <= steps; ++i) await touch('touchMove', [{ x: from.x + ((to.x - from.x) * i) / steps, y: from.y + ((to.y - from.y) * i) / steps }]);
  await touch('touchEnd', []);
  await settled(page);
}
async function tap(spot) {
  await touch('touchStart', [spot]);
  await touch('touchEnd', []);
  await settled(page);
}
const shot = (name) => page.screenshot({ path: join(output, `ar_${name}.png`) });
const line = () => page.locator('#ar-line').textContent();
const says = (words) => page.waitForFunction((wanted) => document.querySelector('#ar-line').textContent.includes(wanted), words);
const ar = (what, ...asked) => page.evaluate(([name, all]) => globalThis.limberStudio.ar[name](...all), [what, asked]);
/** Pixels of the screen, and metres of the room. */
const jointSpot = (name) => page.evaluate((joint) => globalThis.limberStudio.place(joint), name);
const memberBase = (member) => ar('base', member);
const middleOf = (member, up = 0.5) => page.evaluate((asked) => globalThis.limberStudio.memberPlace(...asked), [member, up]);
const jointOf = async (part) => (await sessionState(page)).joints.find((joint) => joint.part === part).name;
const placement = async (member = 0) => (await sessionState(page)).members[member].placement;
async function enter() {
  await page.locator('#view-in-ar').tap();
  await page.waitForFunction(() => phone.session && document.querySelector('#ar-place')?.checkVisibility());
  await frames();
}
async function place() {
  await touch('touchStart', [{ x: 200, y: 400 }]);
  await touch('touchEnd', []);
  await page.locator('#ar-pose').waitFor();
  if (!await page.evaluate(() => document.querySelector('#ar-play path').getAttribute('d').startsWith('M7'))) await settled(page); // a clip that plays is never idle
}
async function leave() {
  await page.locator('#ar-close').tap();
  await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
  await settled(page);
}
async function pose(mode) {
  if (await page.locator('#ar-pose').getAttribute('aria-pressed') !== 'true') await page.locator('#ar-pose').tap();
  await page.locator(`#ar .choice [data-value=${mode}]`).tap();
  await frames();
}
/** Metres from the phone to a joint. */
const distanceTo = async (name) => apart(await ar('joint', name), await page.evaluate(() => [phone.device.position.x, phone.device.position.y, phone.device.position.z]));
const nodesOf = (glb) => new Map(JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString()).nodes
  .map(({ name, translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1] }) => [name, [...translation, ...rotation, ...scale]]));
/** The emulation shows the frames in a canvas of its own, outside the overlay. */
const overlayBarriers = async () => (await barriers(page)).filter((barrier) => !/^region: [^ ]* > canvas/.test(barrier));

const cases = {
  async 'begins where the device can, and looks for a surface'() {
    await enter();
    assert.equal(await page.locator('#app').isVisible(), false);
    assert.match(await line(), /Tap to place/);
    assert.deepEqual(await page.evaluate(() => [phone.options.requiredFeatures ?? [], phone.options.domOverlay.root.id]), [[], 'ar']);
    assert.deepEqual(await overlayBarriers(), []);
    await shot('placing');
  },
  async 'a tap places the model on the floor, at its real size, facing the phone'() {
    await place();
    await shot('placed');
    const base = await memberBase(0), wanted = [0, 0, -1.5 / Math.tan((20 * Math.PI) / 180)];
    assert.ok(apart(base, wanted) < 0.01, `${base} is not ${wanted}`);
    const left = await ar('joint', await jointOf('left hand')), right = await ar('joint', await jointOf('right hand'));
    assert.ok(left[0] - right[0] > 1 && left[0] - right[0] < 2, 'its left hand is to the right of who looks at it');
    assert.equal(await page.locator('#ar-pose').getAttribute('aria-pressed'), 'false');
  },
  async 'dragged by its body it goes over the floor, under the finger'() {
    const before = await memberBase(0), from = await middleOf(0, 0.7);
    await drag(from, { x: from.x + 40, y: from.y + 30 });
    const after = await memberBase(0);
    assert.ok(after[0] - before[0] > 0.1 && after[2] - before[2] > 0.1 && Math.abs(after[1] - before[1]) < 1e-4, `${before} to ${after}`);
    assert.ok(apart(Object.values(await middleOf(0, 0.7)), [from.x + 40, from.y + 30]) < 12);
    await page.locator('#ar-undo').tap();
    await settled(page);
    assert.ok(apart(await memberBase(0), before) < 1e-4);
  },
  async 'onto the table, and back to the floor'() {
    const before = await memberBase(0), from = await middleOf(0, 0.7);
    const onTable = await ar('spot', [(table.x[0] + table.x[1]) / 2, table.height, (table.z[0] + table.z[1]) / 2]);
    await drag(from, onTable, 12);
    assert.ok(Math.abs((await memberBase(0))[1] - table.height) < 1e-3, `${await memberBase(0)}`);
    await shot('table');
    await page.locator('#ar-undo').tap();
    await settled(page);
    assert.ok(apart(await memberBase(0), before) < 1e-4);
  },
  async 'two fingers turn and scale it, with its real size as a detent'() {
    const at = await middleOf(0), base = await memberBase(0);
    const pinch = async (spread, turn) => {
      const point = (sign, s, a) => ({ x: at.x + sign * s * Math.cos(a), y: at.y + sign * s * Math.sin(a) });
      const both = (s, a) => [point(1, s, a), point(-1, s, a)];
      await touch('touchStart', both(100, 0));
      for (let i = 1; i <= 4; ++i) await touch('touchMove', both(100 + ((spread - 100) * i) / 4, (turn * i) / 4));
      await touch('touchEnd', []);
      await settled(page);
    };
    await pinch(50, Math.PI / 6);
    const { scale, turn } = await placement();
    assert.ok(Math.abs(scale - 0.5) < 1e-3, `scale ${scale}`);
    assert.ok(apart(turn, [0, -30, 0]) < 0.1, `turn ${turn}`);
    assert.ok(apart(await memberBase(0), base) < 1e-3, 'it stands where it stood');
    assert.match(await line(), /Not its real size/);
    await shot('half');
    await pinch(194, -Math.PI / 6);
    assert.equal((await placement()).scale, 1);
    assert.match(await line(), /Tap the model/);
    // A tap of both takes back the last step.
    await touch('touchStart', [at, { x: at.x + 60, y: at.y }]);
    await touch('touchEnd', []);
    await settled(page);
    assert.ok(Math.abs((await placement()).scale - 0.5) < 1e-3);
    await page.locator('#ar-redo').tap();
    await settled(page);
  },
  async 'a tap on the model shows its handles; a named skeleton turns'() {
    await tap(await middleOf(0, 0.75));
    assert.equal(await page.locator('#ar-pose').getAttribute('aria-pressed'), 'true');
    const { rigger, own_rig: own } = await sessionState(page);
    assert.equal(await page.locator('#ar .choice [data-value=turn]').getAttribute('aria-pressed'), String(own || rigger === 'template'));
    assert.deepEqual(await overlayBarriers(), []);
    await shot('posing');
  },
  async 'a handle that is touched is shown before it moves'() {
    await pose('move');
    const name = await jointOf('left hand'), at = await jointSpot(name), before = await jointPosition(page, name);
    await touch('touchStart', [{ x: at.x + 4, y: at.y }]);
    await page.waitForFunction((joint) => globalThis.limberStudio.state().joints[globalThis.limberStudio.selected()]?.name === joint, name);
    await touch('touchMove', [{ x: at.x + 7, y: at.y + 3 }]);
    assert.ok(apart(before, await jointPosition(page, name)) < 1e-6);
    await touch('touchEnd', []);
    await settled(page);
    assert.ok(apart(before, await jointPosition(page, name)) < 1e-6, 'a tap moves nothing');
  },
  async 'the model stays where it is while it is posed'() {
    const before = await memberBase(0), at = await jointSpot(await jointOf('left hand'));
    await drag({ x: at.x, y: at.y - 60 }, { x: at.x, y: at.y - 140 });
    assert.ok(apart(before, await memberBase(0)) < 1e-6);
  },
  async 'a handle stays under the finger while the phone moves and turns'() {
    const name = await jointOf('left hand'), at = await jointSpot(name), offset = { x: 5, y: -4 };
    await touch('touchStart', [{ x: at.x + offset.x, y: at.y + offset.y }]);
    await touch('touchMove', [{ x: at.x + offset.x - 30, y: at.y + offset.y - 5 }]);
    // What is drawn, in each frame of a hand that is not steady; within the arm's reach.
    const errors = await page.evaluate(([joint, wanted]) => new Promise((done) => {
      const found = [];
      const look = () => {
        const { x, y } = globalThis.limberStudio.place(joint), i = found.length;
        found.push(Math.hypot(x - wanted.x, y - wanted.y));
        if (i === 40) return done(found);
        phone.stand({ x: -0.003 * i, y: 1.5 + 0.02 * Math.sin(i / 3), z: -0.002 * i }, -0.04 * i + 0.5 * Math.sin(i), -20 + 0.02 * i);
        phone.session.requestAnimationFrame(look);
      };
      phone.session.requestAnimationFrame(look);
    }), [name, { x: at.x - 30, y: at.y - 5 }]);
    const most = Math.max(...errors.slice(1));
    console.log(`   finger to handle, at most ${most.toFixed(2)} px`);
    assert.ok(most < 2, `${most} px`);
    await settled(page);
    const still = await jointSpot(name); // as the engine has it
    assert.ok(Math.hypot(still.x - at.x + 30, still.y - at.y + 5) < 2);
    await touch('touchEnd', []);
    await settled(page);
    await stand(first);
  },
  async 'walking with a handle pulls it along'() {
    const name = await jointOf('left hand'), at = await jointSpot(name), before = await ar('joint', name), far = await distanceTo(name);
    await touch('touchStart', [at]);
    await stand({ ...first, z: 0.12 });
    await settled(page);
    const after = await ar('joint', name);
    assert.ok(after[2] - before[2] > 0.1, `${before} to ${after}`);
    assert.ok(Math.abs(await distanceTo(name) - far) < 0.01, 'as far from the phone as before');
    await touch('touchEnd', []);
    await settled(page);
    await stand(first);
    assert.ok(apart(await ar('joint', name), after) < 1e-5);
    await shot('walked');
  },
  async 'turning swings a handle about its parent'() {
    await pose('turn');
    const name = await jointOf('right hand'), { joints } = await sessionState(page), parent = joints[joints.find((joint) => joint.name === name).parent].name;
    const at = await jointSpot(name), reach = apart(await ar('joint', name), await ar('joint', parent)), before = await ar('joint', name);
    await drag(at, { x: at.x + 10, y: at.y - 40 });
    assert.ok(apart(before, await ar('joint', name)) > 0.05);
    assert.ok(Math.abs(apart(await ar('joint', name), await ar('joint', parent)) - reach) < 1e-4);
    await shot('turned');
  },
  async 'the number of handles is chosen'() {
    const { length } = (await sessionState(page)).joints;
    await page.locator('#ar #fewer-handles').tap();
    if (await page.locator('#ask').isVisible()) await page.locator('#ask-yes').tap();
    await page.waitForFunction((before) => globalThis.limberStudio.state().joints.length !== before, length);
    await settled(page);
    await page.locator('#ar-undo').tap();
    await settled(page);
    assert.equal((await sessionState(page)).joints.length, length);
  },
  async 'a clip goes on playing, in the frames of the session'() {
    await leave();
    await motionPlayed(page, () => chooseMotion(page, 'walk'));
    await enter();
    await place();
    const name = await jointOf('left foot'), before = await ar('joint', name);
    await page.waitForFunction(([joint, from]) => globalThis.limberStudio.ar.joint(joint).some((value, i) => Math.abs(value - from[i]) > 0.02), [name, before]);
    await page.locator('#ar-play').tap();
    await settled(page);
  },
  async 'a second model finds its own place, and one button undoes for both'() {
    const { length } = (await sessionState(page)).members, before = await memberBase(0);
    await page.locator('#ar #open-add').tap();
    await shot('adding');
    await page.locator('#ar #add-member [data-sample=stool]').tap();
    await page.waitForFunction((count) => globalThis.limberStudio.state().members.length > count, length);
    await settled(page);
    await stand(first, 16, -32);
    await says('Tap to place');
    await place();
    const base = await memberBase(1);
    assert.ok(apart(before, await memberBase(0)) < 0.2 && apart(base, before) > 0.5, `${base} beside ${before}`);
    assert.ok(Math.abs(base[1]) < 1e-3);
    await shot('two');
    assert.equal(await page.locator('#ar-members').isVisible(), true);
    assert.deepEqual(await overlayBarriers(), []);
    await pose('move');
    const leg = (await sessionState(page)).joints.at(-1).name, at = await jointSpot(leg), stood = await ar('joint', leg);
    await drag(at, { x: at.x + 30, y: at.y });
    assert.ok(apart(stood, await ar('joint', leg)) > 0.02);
    await page.locator('#ar-members').selectOption('0');
    await settled(page);
    await page.locator('#ar-undo').tap();
    await settled(page);
    assert.equal((await sessionState(page)).member, 1, 'whose step it was is chosen');
    assert.ok(apart(stood, await ar('joint', leg)) < 1e-5);
    await page.locator('#ar-redo').tap();
    await settled(page);
  },
  async 'a picture, on a background where the browser keeps the camera to itself'() {
    await page.locator('#ar-picture').tap();
    await page.locator('#ar-backdrop').waitFor();
    assert.deepEqual(await overlayBarriers(), []);
    const png = await download(page, () => page.locator('#ar-take').tap());
    writeFileSync(join(output, 'ar_picture.png'), png);
    const [width, height] = [png.readUInt32BE(16), png.readUInt32BE(20)];
    assert.ok(width >= 390 && height >= 844, `${width} x ${height}`);
  },
  async 'the device finds its place anew, and the models stay on their surface'() {
    const before = await memberBase(0);
    await page.evaluate(() => { phone.drift = [0.1, 0, -0.05]; });
    await frames(4);
    assert.ok(apart(await memberBase(0), [before[0] + 0.1, before[1], before[2] - 0.05]) < 1e-3);
    await page.evaluate(() => { phone.drift = [0, 0, 0]; });
    await frames(4);
  },
  async 'the end puts the desk back, with the scene as posed'() {
    const { members, joints } = await sessionState(page), stood = [];
    for (const { name } of joints) stood.push(await jointPosition(page, name));
    await leave();
    assert.equal(await page.locator('#ar').count(), 0);
    assert.deepEqual((await sessionState(page)).members, members);
    for (const [i, { name }] of joints.entries()) assert.ok(apart(await jointPosition(page, name), stood[i]) < 1e-6, name);
    assert.deepEqual(await barriers(page), []);
    await shot('desk');
  },
  async 'the native program makes the same of the recorded commands'() {
    const glb = await download(page, () => page.locator('#save-glb').tap());
    writeFileSync(join(output, 'ar.limber'), await download(page, () => page.locator('#export-as').selectOption('limber')));
    execFileSync(program, ['session', 'replay', join(output, 'ar.limber'), '-o', join(output, 'ar_native.glb'), '--quiet']);
    const here = nodesOf(glb), there = nodesOf(readFileSync(join(output, 'ar_native.glb')));
    assert.deepEqual([...here.keys()], [...there.keys()]);
    for (const [name, values] of here) assert.ok(apart(values, there.get(name)) < 1e-5, `${name} stands elsewhere`);
  },
  async 'a reload brings the scene back, with its places'() {
    const { members } = await sessionState(page);
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await page.goto(server.address);
    await page.waitForFunction(() => globalThis.limberStudio?.idle() && globalThis.limberStudio.state());
    await settled(page);
    assert.deepEqual((await sessionState(page)).members.map(({ name, placement: at }) => [name, at]), members.map(({ name, placement: at }) => [name, at]));
    await enter();
    await place();
    const apartHere = apart(await memberBase(0), await memberBase(1));
    assert.ok(apartHere > 0.5 && apartHere < 10);
    await leave();
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
  async 'no surface: help after some seconds, and a place all the same'() {
    await onPhone('?sample=stool', {}, async () => {
      await page.evaluate(() => { phone.room.floor = false; });
      await enter();
      assert.match(await line(), /Point the device/);
      await says('No surface found yet');
      await shot('no_surface');
      await page.locator('#ar-place').tap();
      await page.locator('#ar-pose').waitFor();
      assert.ok(Math.abs((await memberBase(0))[2] + 1.2) < 0.01);
    });
  },
  async 'lost places, hidden pages and a session that ends in the middle of a drag lose nothing'() {
    await onPhone('?sample=biped', {}, async () => {
      await enter();
      await place();
      await pose('move');
      const name = await jointOf('left hand');
      for (const [what, interrupt, resume] of [
        ['The place is lost', () => { phone.poseLost = true; }, () => { phone.poseLost = false; }],
        ['Waiting', () => phone.device.updateVisibilityState('hidden'), () => phone.device.updateVisibilityState('visible')],
        ['Waiting', () => {
          Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
          document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
        }, () => {
          delete document.visibilityState;
          document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
        }],
      ]) {
        const at = await jointSpot(name);
        await touch('touchStart', [at]);
        await touch('touchMove', [{ x: at.x - 15, y: at.y - 20 }]);
        await page.evaluate(interrupt);
        await says(what);
        await settled(page);
        if (what !== 'Waiting') await shot('lost');
        const { dragged, undo } = await sessionState(page), stood = await jointPosition(page, name);
        assert.equal(dragged, null);
        assert.equal(undo, 'end_drag');
        await page.evaluate(resume);
        await says('Drag a handle');
        await touch('touchMove', [{ x: at.x - 40, y: at.y - 40 }]);
        await touch('touchEnd', []);
        await settled(page);
        assert.ok(apart(stood, await jointPosition(page, name)) < 1e-6);
      }
      const at = await jointSpot(name);
      await touch('touchStart', [at]);
      await touch('touchMove', [{ x: at.x + 15, y: at.y + 20 }]);
      await page.evaluate(() => phone.session.end());
      await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
      await settled(page);
      assert.match(await page.locator('#notice').textContent(), /The device has ended augmented reality/);
      assert.equal((await sessionState(page)).dragged, null);
      await touch('touchEnd', []);
      await shot('ended');
      // Once more works.
      await page.locator('#close-notice').tap();
      await enter();
      await place();
    });
  },
  async 'a browser that refuses says so, and the desk stays'() {
    await onPhone('?sample=stool', {}, async () => {
      await page.evaluate(() => { phone.refuse = 'NotSupportedError'; });
      await page.locator('#view-in-ar').tap();
      await page.locator('#notice').waitFor();
      assert.match(await page.locator('#notice').textContent(), /does not begin augmented reality/);
      assert.equal(await page.locator('#ar').count(), 0);
      assert.equal(await page.locator('#app').isVisible(), true);
      await page.evaluate(() => { phone.refuse = null; });
      await enter();
    });
  },
  async 'without an overlay, anchors, light and hit tests it is still placed and posed'() {
    await onPhone('?sample=stool', { without: ['dom-overlay', 'anchors', 'light-estimation', 'hit-test'] }, async () => {
      await enter();
      const screen = async (phase, spot) => {
        await page.evaluate(([name, at]) => phone.touchScreen(name, at), [phase, spot]);
        await frames(4);
      };
      await page.locator('#ar-place').tap();
      await page.locator('#ar-pose').waitFor();
      await pose('move');
      const name = (await sessionState(page)).joints.at(-1).name, at = await jointSpot(name), before = await jointPosition(page, name);
      await screen('down', at);
      await screen('move', { x: at.x + 20, y: at.y - 20 });
      const held = await jointSpot(name);
      assert.ok(Math.hypot(held.x - at.x - 20, held.y - at.y + 20) < 2, JSON.stringify([at, held]));
      await screen('up', at);
      await settled(page);
      assert.ok(apart(before, await jointPosition(page, name)) > 0.01);
    });
  },
  async 'the real light, where the device estimates it'() {
    await onPhone('?sample=stool', {}, async () => {
      await enter();
      await place();
      const brightness = async () => {
        const { x, y } = await middleOf(0, 0.9), png = await page.screenshot({ clip: { x: x - 3, y: y - 3, width: 6, height: 6 } });
        return page.evaluate(async (bytes) => {
          const bitmap = await createImageBitmap(new Blob([new Uint8Array(bytes)])), canvas = document.createElement('canvas');
          canvas.getContext('2d').drawImage(bitmap, 0, 0);
          const { data } = canvas.getContext('2d').getImageData(2, 2, 1, 1);
          return data[0] + data[1] + data[2];
        }, [...png]);
      };
      const soft = await brightness();
      await page.evaluate(() => {
        phone.room.light = { sphericalHarmonicsCoefficients: new Float32Array(27).fill(0.02), primaryLightIntensity: { x: 0.05, y: 0.05, z: 0.05 }, primaryLightDirection: { x: 0, y: 1, z: 0 } };
      });
      await frames(6);
      const dark = await brightness();
      assert.ok(dark < 0.6 * soft, `${dark} against ${soft}`);
      await shot('dark_room');
    });
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
