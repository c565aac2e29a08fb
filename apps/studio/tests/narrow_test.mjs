// A day's work on a narrow screen, by touch alone: posed, set in motion, corrected, looked at, saved, left and come back to.
//
//   node apps/studio/tests/narrow_test.mjs DIST OUTPUT_FOLDER
//
// Pictures of what it sees go into the folder. Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import {
  answer, barriers, download, jointPlace, jointPosition, lastJointOf, launch, openStudio, runCases, serve, sessionState, settled,
} from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const width = 390, height = 844;
const { page, context, errors } = await openStudio(browser, server.address, { width, height, touch: true, isMobile: true, deviceScaleFactor: 1, search: '?sample=biped' });
const wire = await context.newCDPSession(page);
const touch = (type, ...points) => wire.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });

const state = () => sessionState(page);
const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const positions = (names) => Promise.all(names.map((name) => jointPosition(page, name)));
const allPositions = async () => positions((await state()).joints.map(({ name }) => name));
const expectStill = (now, before, within, what = '') =>
  now.forEach((place, i) => assert.ok(distance(place, before[i]) < within, `${what} ${i}: ${before[i]} to ${place}`));
const expectNoBarriers = async (where) => assert.deepEqual(await barriers(page), [], where);
const shot = (name) => page.screenshot({ path: join(output, `narrow_${name}.png`) });
const told = (selector) => page.locator(selector).textContent();
const pressed = async (selector) => (await page.locator(selector).getAttribute('aria-pressed')) === 'true';

async function tap(selector) {
  await page.locator(selector).scrollIntoViewIfNeeded();
  // The row stands where it was scrolled.
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  await page.locator(selector).tap();
  await settled(page);
}
async function drag(name, [x, y]) {
  const from = await jointPlace(page, name);
  await touch('touchStart', from);
  for (let i = 1; i <= 5; ++i) await touch('touchMove', { x: from.x + (x * i) / 5, y: from.y + (y * i) / 5 });
  await page.waitForTimeout(100); // a flick would swallow the next tap
  await touch('touchEnd');
  await settled(page);
}
async function scrub(seconds) {
  await page.locator('#scrub').fill(String(seconds));
  await settled(page);
}
const pickMore = (value) => page.locator('#export-as').selectOption(value);
const clip = async () => {
  const { clips, clip: chosen } = await state();
  return clips[chosen];
};
const opened = async (name) => {
  await page.waitForFunction((wanted) => globalThis.limberStudio.state()?.name === wanted, name);
  await settled(page);
};
async function reload() {
  await page.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.kept());
  await page.reload();
  await settled(page);
}
const boxOf = (selector) => page.locator(selector).boundingBox();
const apart = (a, b) => a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
const expectOnScreen = (box, what) =>
  assert.ok(box.x >= 0 && box.y >= 0 && box.x + box.width <= width && box.y + box.height <= height, `${what}: ${JSON.stringify(box)}`);

async function expectInView() {
  const { x, y, width: across, height: down } = await boxOf('main canvas');
  for (const { name } of (await state()).joints) {
    const at = await jointPlace(page, name);
    assert.ok(at.x > x && at.x < x + across && at.y > y && at.y < y + down, `${name} is out of sight: ${JSON.stringify(at)}`);
  }
}

/** Degrees by which a knee is bent. */
async function bend(hip, knee, foot) {
  const [a, b, c] = await positions([hip, knee, foot]), thigh = b.map((value, i) => value - a[i]), shin = c.map((value, i) => value - b[i]);
  const dot = thigh.reduce((sum, value, i) => sum + value * shin[i], 0);
  return (Math.acos(Math.min(1, dot / Math.hypot(...thigh) / Math.hypot(...shin))) * 180) / Math.PI;
}

/** How many pixels of a picture fit, each given with the one of another picture in its place; from a part of them. */
const countPixels = (pictures, fits, around = null) => page.evaluate(async ([sources, test, box]) => {
  const pixels = await Promise.all(sources.map(async (base64) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
    const drawing = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    drawing.drawImage(bitmap, 0, 0);
    const { x, y, width: across, height: down } = box ?? { x: 0, y: 0, width: bitmap.width, height: bitmap.height };
    return drawing.getImageData(x, y, across, down).data;
  }));
  const counts = Object.fromEntries(Object.keys(test).map((name) => [name, 0])), all = pixels[0].length / 4;
  const tests = Object.entries(test).map(([name, text]) => [name, new Function('a', 'b', `return ${text};`)]);
  for (let i = 0; i < 4 * all; i += 4) {
    const [a, b] = pixels.map((data) => data.subarray(i, i + 4));
    for (const [name, holds] of tests) counts[name] += holds(a, b ?? a) ? 1 : 0;
  }
  return { ...counts, all };
}, [pictures, fits, around]);
const canvasPicture = async () => (await page.locator('main canvas').screenshot()).toString('base64');

let glb = null;

const cases = {
  async 'what is needed is in sight, and nothing lies on a ball'() {
    const bar = ['#open', '#samples', '#open-add', '#open-recent', '#undo', '#redo', '#save-glb', '#export-as'];
    for (const button of [...bar, '#whole-model', '#view-flat', '#magnet']) {
      expectOnScreen(await boxOf(button), button);
    }
    await shot('start');
    const covers = await Promise.all(['#hint', '.views', '.pose-tools'].map(async (selector) => [selector, await boxOf(selector)]));
    for (const { name } of (await state()).joints) {
      const { x, y } = await jointPlace(page, name);
      for (const [selector, box] of covers) assert.ok(apart(box, { x: x - 5, y: y - 5, width: 10, height: 10 }), `${selector} lies on ${name}`);
    }
    await pickMore('help');
    await page.locator('#help').waitFor();
    assert.match(await told('#help'), /What fingers do/);
    await tap('#help button');
    await expectNoBarriers('a model');
  },
  async 'four drags: both hands up, one knee bent, the feet on the floor; the panel stays where it was'() {
    const of = (part) => lastJointOf(page, part), head = await of('head');
    const leg = (side) => Promise.all(['upper leg', 'lower leg', 'foot', 'toes'].map((part) => of(`${side} ${part}`)));
    const legs = [await leg('left'), await leg('right')];
    const [[, knee], [, , rightFoot]] = legs, toes = legs.map(([, , , one]) => one), hands = [await of('left hand'), await of('right hand')];
    const scroll = () => page.locator('.side').evaluate((side) => side.scrollTop);
    await page.locator('.side').evaluate((side) => { side.scrollTop = 120; });
    const stood = await positions([...toes, rightFoot]);
    await drag(hands[0], [-10, -110]);
    await drag(hands[1], [10, -110]);
    await drag(knee, [-16, -10]);
    await drag(head, [6, 4]);
    await shot('four_drags');
    const [{ 1: top }, ...raised] = await positions([head, ...hands]);
    for (const [, y] of raised) assert.ok(y > top - 0.15, `a hand at ${y}, the head at ${top}`);
    const bent = [await bend(...legs[0]), await bend(...legs[1])];
    assert.ok(bent[0] > 20 && bent[1] < 10, `knees bent by ${bent}`);
    expectStill(await positions([...toes, rightFoot]), stood, 0.004, 'toes and foot');
    assert.equal(await scroll(), 120);
    // Sideways the foot rolls over its toes as well.
    const before = await allPositions();
    await drag(knee, [30, 0]);
    await shot('knee_sideways');
    expectStill(await positions([...toes, rightFoot]), stood, 0.004, 'toes and foot');
    await tap('#undo');
    expectStill(await allPositions(), before, 1e-5);
  },
  async 'a pose is there after a reload, with what undo takes back, whatever the address begins with'() {
    const before = await allPositions();
    await reload();
    assert.equal((await state()).undo, 'end_drag');
    expectStill(await allPositions(), before, 1e-5);
    for (let drags = 0; drags < 4; ++drags) await tap('#undo');
    assert.equal((await state()).posed, false);
  },
  async 'a motion is put on by taps, and one for other bodies is not'() {
    await tap('#open-shelf');
    const card = (name) => page.locator(`#shelf [data-motion=${name}]:not([aria-busy])`);
    await card('gallop').tap({ force: true });
    assert.equal(await card('gallop').getAttribute('aria-disabled'), 'true');
    await card('walk').tap();
    await page.locator('#shelf [data-motion=walk].playing').waitFor();
    assert.equal((await state()).clips.length, 0);
    await card('walk').tap();
    await page.waitForFunction(() => globalThis.limberStudio.state().clips.length === 1);
    assert.ok(await pressed('#play'));
    assert.ok(await pressed('[data-value=surface]'));
    await tap('#play');
    assert.ok(await page.locator('#retarget').isVisible());
    await shot('motion');
  },
  async 'speed, and once or again and again'() {
    const { duration } = await clip(), play = () => page.locator('#play').tap();
    /** Seconds of the clip for one of the clock, over some frames: a frame that took longer than a quarter of a second counts as one. */
    const pace = async (speed) => {
      await page.locator('#speed').selectOption(String(speed));
      await scrub(0);
      await play();
      const ratio = await page.evaluate(async (length) => {
        const at = () => document.querySelector('#scrub').valueAsNumber, frame = () => new Promise(requestAnimationFrame);
        const begun = at();
        while (at() === begun) await frame();
        let before = await frame(), shown = at(), moved = 0, passed = 0;
        for (let frames = 0; frames < 8 || passed < 0.4; ++frames) {
          const now = await frame();
          moved += (at() - shown + length) % length;
          passed += Math.min(0.25, (now - before) / 1000);
          shown = at();
          before = now;
        }
        return moved / passed;
      }, duration);
      await tap('#play');
      return ratio;
    };
    const slow = await pace(0.25), fast = await pace(2);
    assert.ok(slow > 0.1 && slow < 0.4 && fast > 4 * slow && fast < 3, `${slow} and ${fast} seconds a second`);
    await tap('#loop');
    await scrub(duration - 0.3);
    await play();
    await page.waitForFunction(() => document.querySelector('#play').getAttribute('aria-pressed') === 'false');
    await settled(page);
    assert.equal(Number(await page.locator('#scrub').inputValue()).toFixed(2), duration.toFixed(2));
    await tap('#loop');
    await scrub(duration - 0.3);
    await play();
    await page.waitForFunction((end) => document.querySelector('#scrub').valueAsNumber < end / 2, duration);
    assert.ok(await pressed('#play'));
    await tap('#play');
  },
  async 'what is posed becomes a key at once, or where Key is tapped'() {
    await tap('[data-value=handles]');
    const hand = await lastJointOf(page, 'left hand');
    await scrub(0.4);
    await drag(hand, [18, -40]);
    assert.deepEqual((await clip()).keys, [0.4]);
    await tap('#auto-key');
    assert.equal(await pressed('#auto-key'), false);
    await scrub(1.2);
    await drag(hand, [10, -30]);
    assert.equal((await clip()).keys.length, 1);
    const posed = await jointPosition(page, hand);
    await tap('#add-key');
    assert.equal((await clip()).keys.length, 2);
    await scrub(0);
    await scrub(1.2);
    expectStill([await jointPosition(page, hand)], [posed], 1e-3);
    await tap('#auto-key');
    await expectNoBarriers('a clip with keys');
  },
  async 'ghosts before and after, and the path of the hand, are drawn'() {
    await tap('[data-value=surface]');
    await scrub(0.8);
    const without = await canvasPicture();
    await page.locator('#ghosts').tap();
    await page.waitForTimeout(200);
    await settled(page);
    await shot('ghosts');
    const shown = await canvasPicture(), canvas = await boxOf('main canvas'), hand = await jointPlace(page, await lastJointOf(page, 'left hand'));
    const differs = 'Math.abs(a[0] - b[0]) + Math.abs(a[1] - b[1]) + Math.abs(a[2] - b[2]) > 25', path = 'a[2] > 200 && a[0] < 90 && a[1] < 150';
    const { before, after, trail } = await countPixels([shown, without], {
      before: `${differs} && a[2] - b[2] > a[0] - b[0] + 10`, after: `${differs} && a[0] - b[0] > a[2] - b[2] + 10`, trail: path,
    });
    for (const [name, count] of Object.entries({ before, after, trail })) assert.ok(count > 150, `${name}: ${count} pixels`);
    const round = { x: Math.round(hand.x - canvas.x) - 4, y: Math.round(hand.y - canvas.y) - 4, width: 9, height: 9 };
    assert.ok((await countPixels([shown], { trail: path }, round)).trail > 0, 'the path does not go through the hand');
    await page.locator('#ghosts').tap();
    await page.waitForTimeout(100);
    await settled(page);
    const { left } = await countPixels([await canvasPicture(), without], { left: differs });
    assert.ok(left < 100, `${left} pixels of them stay`);
  },
  async 'a picture has the model alone, and a sheet the clip'() {
    await tap('[data-value=handles]');
    await pickMore('pictures');
    expectOnScreen(await boxOf('#pictures'), 'the dialog');
    const png = await download(page, () => page.locator('#picture').tap());
    writeFileSync(join(output, 'narrow_picture.png'), png);
    const { opaque, clear, red, all } = await countPixels([png.toString('base64')], {
      opaque: 'a[3] > 250', clear: 'a[3] === 0', red: 'a[3] > 250 && a[0] > 180 && a[1] < 80 && a[2] < 90',
    });
    assert.ok(opaque > all / 50 && clear > all / 3, `${opaque} opaque and ${clear} clear pixels of ${all}`);
    assert.equal(red, 0, 'handles are in it');
    await tap('#open-sheet');
    await page.locator('#contact-sheet').waitFor();
    expectOnScreen(await boxOf('#contact-sheet'), 'the sheet');
    const greens = await page.locator('#sheet').evaluate((sheet) => Array.from({ length: 12 }, (_, cell) => {
      const { data } = sheet.getContext('2d').getImageData(8 + 328 * (cell % 4), 8 + 248 * Math.floor(cell / 4), 320, 240);
      let green = 0;
      for (let i = 0; i < data.length; i += 4) green += data[i + 1] > data[i] + 25 && data[i + 2] > data[i] + 25;
      return green;
    }));
    assert.ok(Math.min(...greens) > 0.5 * Math.max(...greens), `the clothes in its pictures: ${greens}`);
    await expectNoBarriers('the sheet');
    await shot('sheet');
    await page.locator('#contact-sheet button').last().tap();
  },
  async 'a USDZ is not much larger than the GLB'() {
    glb = await download(page, () => page.locator('#save-glb').tap());
    const usdz = await download(page, () => pickMore('usdz'));
    assert.ok(usdz.length < 2.5 * glb.length, `${usdz.length} bytes, the GLB has ${glb.length}`);
  },
  async 'a motion with its matches, keys and moment is there after a reload, and from a file'() {
    const parts = ['name', 'clips', 'motions', 'match', 'clip', 'undo'], wanted = async () => {
      const all = await state();
      return [Object.fromEntries(parts.map((part) => [part, all[part]])), await told('#time')];
    };
    await scrub(2.7);
    const before = await wanted(), stood = await allPositions();
    const expectSame = async () => {
      assert.deepEqual(await wanted(), before);
      expectStill(await allPositions(), stood, 1e-5);
      assert.ok(await page.locator('#retarget').isVisible());
    };
    await tap('#whole-model');
    await expectInView();
    await reload();
    await expectSame();
    await expectInView();
    const limber = await download(page, () => pickMore('limber'));
    await page.locator('#samples').selectOption('stool');
    await opened('stool');
    await page.locator('#file').setInputFiles({ name: 'day.limber', mimeType: 'application/zip', buffer: limber });
    await opened('biped');
    await expectSame();
  },
  async 'what went wrong is told beside the timeline, in the dark as well'() {
    await page.emulateMedia({ colorScheme: 'dark' });
    await page.locator('#file').setInputFiles({ name: 'none.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('glTF nothing') });
    await page.locator('#notice').waitFor();
    const notice = await boxOf('#notice');
    expectOnScreen(notice, 'the notice');
    for (const panel of ['.timeline', '.side', '.bar']) assert.ok(apart(notice, await boxOf(panel)), `it lies on ${panel}`);
    await expectNoBarriers('an error in the dark');
    await shot('error_dark');
    await tap('#close-notice');
    await page.emulateMedia({ colorScheme: 'light' });
  },
  async 'what was worked on before comes back from the list'() {
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await tap('#open-recent');
    const kept = page.locator('#recent li:has(img)', { hasText: 'biped' }).first();
    await kept.waitFor();
    await expectNoBarriers('what was worked on before');
    await kept.locator('.pick').tap();
    await opened('biped');
    assert.equal((await clip()).keys.length, 2);
  },
  async 'of forty quick choices the last one counts, with a clip playing; its balls are there to drag'() {
    await tap('[data-value=surface]');
    await page.locator('#play').tap();
    const names = ['quadruped', 'stool', 'robot', 'winged'];
    for (let i = 0; i < 40; ++i) await page.locator('#samples').selectOption(i === 39 ? 'stool' : names[i % names.length]);
    await opened('stool');
    assert.ok(await page.locator('#notice').isHidden());
    assert.ok(await pressed('[data-value=handles]'));
    const { joints } = await state(), dragged = joints.at(-1).name;
    const [from] = await positions([dragged]), seen = await jointPlace(page, joints[0].name);
    await drag(dragged, [12, -12]);
    assert.equal((await state()).undo, 'end_drag');
    assert.ok(distance(await jointPosition(page, dragged), from) > 0.01);
    const { x, y } = await jointPlace(page, joints[0].name);
    assert.ok(Math.hypot(x - seen.x, y - seen.y) < 0.5, 'the view turned');
  },
  async 'looking at many samples forgets nothing that was worked on'() {
    for (let i = 0; i < 13; ++i) {
      const name = ['robot', 'stool'][i % 2];
      await page.locator('#samples').selectOption(name);
      await opened(name);
    }
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await tap('#open-recent');
    await page.locator('#recent li', { hasText: 'biped' }).first().waitFor();
    await tap('#close-recent');
  },
  async 'handles take the place of named joints only where the user agrees'() {
    await page.locator('#file').setInputFiles({ name: 'person.glb', mimeType: 'model/gltf-binary', buffer: glb });
    await opened('person.glb');
    const before = (await state()).joints;
    await page.locator('#fewer-handles').tap();
    await page.locator('#ask').waitFor();
    expectOnScreen(await boxOf('#ask'), 'the question');
    await expectNoBarriers('a question');
    await answer(page, false);
    assert.deepEqual((await state()).joints, before);
    await page.locator('#fewer-handles').tap();
    await answer(page, true);
    assert.equal((await state()).own_rig, false);
    await tap('#undo');
    assert.deepEqual((await state()).joints, before);
  },
  async 'a joint is added where the model is tapped'() {
    await page.locator('#samples').selectOption('stool');
    await opened('stool');
    const { joints } = await state();
    await page.locator('#joints li').first().tap();
    await page.locator('#add-joint').tap();
    const { x, y } = await jointPlace(page, joints.at(-1).name);
    await page.touchscreen.tap(x, y);
    await page.waitForFunction((count) => globalThis.limberStudio.state().joints.length === count, joints.length + 1);
    await settled(page);
    await expectNoBarriers('a new joint');
  },
  'nothing was thrown'() { assert.deepEqual(errors, []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
