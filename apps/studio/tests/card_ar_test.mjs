// Augmented reality by the card, in a browser whose camera is fed films that are drawn here: the card on a table, so that
// the true place of the camera is known in each picture.
//
//   node apps/studio/tests/card_ar_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { Matrix4, PerspectiveCamera, Quaternion, Vector3 } from 'three';
import { height, width } from './card_film.mjs';
import { degreesHigh, logTracker, rate, resting, strip, walk, writeRest, writeWalk } from './card_videos.mjs';
import { pictureOfScreen, turnScreen } from './ar_phone.mjs';
import { barriers, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });

const aruco = createRequire(import.meta.url);
const { AR } = aruco('js-aruco2/src/aruco.js');
aruco('js-aruco2/src/dictionaries/aruco_mip_16h3.js');
const code = AR.DICTIONARIES.ARUCO_MIP_16h3.codeList[11];

const film = join(output, 'card_film.y4m');
writeWalk(film, code);

const server = await serve(dist);
const browser = await launch({ options: ['--use-fake-device-for-media-stream', `--use-file-for-fake-video-capture=${film}`] });
// Frames are drawn in software: on a small screen there are more of them.
const { page, context, errors } = await openStudio(browser, server.address, {
  width: 240, height: 320, deviceScaleFactor: 1, touch: true, search: '?sample=stool', permissions: ['camera'], prepare: (made) => made.addInitScript(logTracker, strip),
});
const finger = await context.newCDPSession(page);

async function enter() {
  await page.locator('#view-in-ar').tap();
  const card = page.locator('#ways [data-way="card"]');
  await card.or(page.locator('#ar-place')).first().waitFor();
  if (await card.isVisible()) await card.tap();
  await page.locator('#ar-place').waitFor();
}
async function leave() {
  await page.locator('#ar-close').tap();
  await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
  assert.ok(await page.evaluate(() => globalThis.cardTracks.length > 0 && globalThis.cardTracks.every(({ readyState }) => readyState === 'ended')), 'the camera is free');
}
async function touch(type, points) {
  await finger.send('Input.dispatchTouchEvent', { type, touchPoints: points.map((point, id) => ({ ...point, id })) });
  await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
}
const says = (words) => page.waitForFunction((wanted) => document.querySelector('#ar-line').textContent.includes(wanted), words);
const shot = (name) => page.screenshot({ path: join(output, `card_${name}.png`) });
/** What the tracker was given and said, `count` times from now on. */
async function seen(count) {
  const from = await page.evaluate(() => globalThis.cardLog.length);
  await page.waitForFunction((until) => globalThis.cardLog.length >= until, from + count);
  return page.evaluate((at) => globalThis.cardLog.slice(at), from);
}

/** Where the camera of a film is, in the room of the card. */
function cameraOf({ turn: r, move }) {
  const card = new Matrix4().set(r[0], r[1], r[2], move[0], r[3], r[4], r[5], move[1], r[6], r[7], r[8], move[2], 0, 0, 0, 1);
  return card.premultiply(new Matrix4().makeScale(1, -1, -1)).invert();
}
const placeOf = (matrix) => new Vector3().setFromMatrixPosition(matrix);
const degreesApart = (a, b) => (new Quaternion().setFromRotationMatrix(a).angleTo(new Quaternion().setFromRotationMatrix(b)) * 180) / Math.PI;
const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];
/** Metres about the mean of each time that the camera rests: root of the mean square. From the first picture of a rest, which
 *  is a new view, the focal length is still learnt: it does not count. */
function jitterAtRest(found) {
  const all = [];
  let rested = false;
  for (const { number, camera } of found) {
    const rests = number > 0 && number < walk.resting;
    if (rests && !rested) all.push([]);
    if (rests) all.at(-1).push(placeOf(new Matrix4().fromArray(camera)));
    rested = rests;
  }
  const rests = all.map((places) => places.slice(1)).filter((places) => places.length > 1);
  assert.ok(rests.length > 0, 'no rest was seen');
  let sum = 0, free = 0;
  for (const places of rests) {
    const middle = places.reduce((all, at) => all.add(at), new Vector3()).divideScalar(places.length);
    for (const at of places) sum += at.distanceToSquared(middle);
    free += places.length - 1;
  }
  return Math.sqrt(sum / free);
}
/** Where a point is in the picture, in pixels. */
function spotOf(point, matrix, fieldOfView) {
  const eye = new PerspectiveCamera(fieldOfView, width / height);
  matrix.decompose(eye.position, eye.quaternion, eye.scale);
  eye.updateMatrixWorld();
  const { x, y } = point.clone().project(eye);
  return [((x + 1) / 2) * width, ((1 - y) / 2) * height];
}

const cases = {
  async 'the camera is where it is, in every picture of a film'() {
    await enter();
    await seen(15); // the focal length, which nobody told the page, is found meanwhile
    const log = await seen(60), read = log.filter(({ number }) => number >= 0), found = read.filter(({ camera }) => camera);
    await shot('walk');
    assert.ok(read.length > 0.9 * log.length, `${read.length} of ${log.length} pictures have a number that can be read`);
    assert.ok(found.length >= 0.95 * read.length, `found in ${found.length} of ${read.length}`);
    // What is seen through a lens taken for longer than it is counts as farther off: distances are compared by focal lengths.
    const turned = [], distances = [], pixels = [], longer = [], top = new Vector3(0, 0.1, 0);
    for (const { number, camera, fieldOfView } of found) {
      const truth = cameraOf(walk.path(number / rate)), is = new Matrix4().fromArray(camera);
      longer.push(Math.tan((degreesHigh * Math.PI) / 360) / Math.tan((fieldOfView * Math.PI) / 360));
      turned.push(degreesApart(truth, is));
      distances.push(Math.abs(placeOf(is).length() / longer.at(-1) / placeOf(truth).length() - 1));
      const a = spotOf(top, truth, degreesHigh), b = spotOf(top, is, fieldOfView);
      pixels.push(Math.hypot(a[0] - b[0], a[1] - b[1]));
    }
    const jitter = jitterAtRest(found);
    console.log(`   found in ${found.length} of ${read.length}: ${median(turned).toFixed(3)} degrees, ${(100 * median(distances)).toFixed(3)} % of the distance, ${median(pixels).toFixed(2)} (at most ${Math.max(...pixels).toFixed(2)}) pixels off; ` +
      `jitter at rest ${(1000 * jitter).toFixed(3)} mm; focal length ${median(longer).toFixed(3)} of the true one; answered after ${median(log.map(({ took }) => took)).toFixed(1)} ms`);
    assert.ok(median(turned) < 0.2 && median(distances) < 0.002, 'median');
    assert.ok(Math.max(...pixels) < 4 && jitter < 0.0002);
    assert.ok(Math.abs(Math.log(median(longer))) < 0.05, 'the focal length is found to a step of the search');
    await leave();
  },
  async 'a handle is dragged; the card is covered, the page hidden, the camera refused: nothing is lost'() {
    const ar = (what, ...asked) => page.evaluate(([name, all]) => globalThis.limberStudio.ar[name](...all), [what, asked]);
    const { cover } = writeRest(film, code); // the camera is opened anew
    await page.setViewportSize({ width: 390, height: 844 });
    await enter();
    await says('Tap to place');
    await touch('touchStart', [{ x: 195, y: 420 }]);
    await touch('touchEnd', []);
    await page.locator('#ar-pose').waitFor();
    // A stool is larger than what the camera sees of the table.
    await says('larger than the view');
    await shot('large');
    await page.locator('#ar-fit').tap();
    await says('Not its real size');
    const fitted = (await sessionState(page)).members[0].placement.scale, ends = await page.evaluate(() => [0, 1].map((up) => globalThis.limberStudio.memberPlace(0, up)));
    assert.ok(fitted < 0.5 && ends.every(({ x, y }) => x > 0 && x < 390 && y > 0 && y < 844), JSON.stringify([fitted, ends]));
    await shot('fitted');
    await page.locator('#ar-undo').tap();
    await settled(page);
    assert.equal((await sessionState(page)).members[0].placement.scale, 1);
    await touch('touchStart', [{ x: 60, y: 420 }, { x: 330, y: 420 }]);
    for (const way of [0.4, 0.8, 1]) await touch('touchMove', [{ x: 60 + 120 * way, y: 420 }, { x: 330 - 105 * way, y: 420 }]);
    await touch('touchEnd', []);
    await settled(page);
    const { scale } = (await sessionState(page)).members[0].placement;
    await shot('placed');
    assert.ok(scale < 0.4, `scale ${scale}`);
    await page.locator('#ar-pose').tap();
    await page.locator('#ar .choice [data-value=move]').tap();
    assert.deepEqual(await barriers(page), []);
    // Small as it is, its handles leave it to be seen.
    const discs = await page.evaluate(() => globalThis.limberStudio.state().joints.map(({ name: joint }) => ({
      radius: globalThis.limberStudio.radius(joint), ...globalThis.limberStudio.place(joint),
    })));
    const span = (values) => [Math.min(...values), Math.max(...values)], radii = discs.map(({ radius }) => radius);
    const [wide, high] = [span(discs.map(({ x }) => x)), span(discs.map(({ y }) => y))].map(([least, most]) => most - least);
    const covered = radii.reduce((sum, radius) => sum + Math.PI * radius * radius, 0) / (wide * high);
    console.log(`   ${discs.length} handles of ${span(radii).map((pixels) => pixels.toFixed(1)).join(' to ')} pixels cover ${(100 * covered).toFixed(0)} % of the model`);
    assert.ok(covered < 0.5, `handles cover ${covered} of the model`);

    // The lowest on the screen: no other lies before it.
    const name = await page.evaluate((joints) => {
      const low = (joint) => globalThis.limberStudio.place(joint).y;
      return joints.reduce((lowest, joint) => (low(joint) > low(lowest) ? joint : lowest));
    }, (await sessionState(page)).joints.map((joint) => joint.name));
    const spot = () => page.evaluate((joint) => globalThis.limberStudio.place(joint), name);
    const stood = await jointPosition(page, name), at = await spot(), [last] = (await seen(1));
    await touch('touchStart', [at]);
    for (const way of [0.5, 1]) await touch('touchMove', [{ x: at.x - 40 * way, y: at.y - 30 * way }]);
    await shot('posing');
    cover(true);
    await says('The card is not seen');
    await shot('lost');
    await settled(page);
    const { dragged, undo } = await sessionState(page), left = await jointPosition(page, name);
    assert.equal(dragged, null);
    assert.equal(undo, 'end_drag');
    assert.ok(left.some((value, i) => Math.abs(value - stood[i]) > 0.005), `it went along from ${stood} to ${left}`);
    await touch('touchEnd', []);
    const base = await ar('base', 0), from = await spot();
    cover(false);
    await says('Drag a handle');
    const [found] = (await seen(2)).filter(({ camera }) => camera), [was, is] = [last, found].map(({ camera }) => new Matrix4().fromArray(camera));
    assert.ok(placeOf(was).distanceTo(placeOf(is)) < 0.001 && degreesApart(was, is) < 0.2, 'found again without a jump');
    assert.ok(placeOf(new Matrix4().setPosition(...base)).distanceTo(new Vector3(...await ar('base', 0))) < 1e-6);
    const to = await spot();
    assert.ok(Math.hypot(to.x - from.x, to.y - from.y) < 2, 'on the screen as well');

    // The screen turned in the middle of a drag, which ends as far as it went; what stands on the card stands on it in the picture.
    const begun = await spot();
    await touch('touchStart', [begun]);
    await touch('touchMove', [{ x: begun.x + 20, y: begun.y }]);
    await turnScreen(finger, true);
    await page.waitForFunction(() => innerWidth === 844 && screen.orientation.angle === 90 && document.querySelector('#ar canvas').width === 844);
    await settled(page);
    assert.equal((await sessionState(page)).dragged, null);
    await touch('touchEnd', []);
    assert.ok(await page.evaluate(() => {
      const { x, y, width, height } = document.querySelector('#ar-undo').getBoundingClientRect();
      return document.elementFromPoint(x + width / 2, y + height / 2)?.closest('#ar-undo');
    }), 'something lies over the arrow that undoes');
    const corner = new Vector3(0.04, 0, 0.04), [across, down] = spotOf(corner, cameraOf(resting), degreesHigh);
    const shown = await ar('spot', corner.toArray()), times = 844 / width; // the picture fills the screen
    assert.ok(Math.hypot(shown.x - 422 - times * (across - width / 2), shown.y - 195 - times * (down - height / 2)) < 2, JSON.stringify([shown, across, down]));
    const taken = await spot();
    await touch('touchStart', [taken]);
    await touch('touchMove', [{ x: taken.x + 9, y: taken.y - 6 }]);
    await pictureOfScreen(finger, join(output, 'card_landscape.png'));
    await touch('touchEnd', []);
    await settled(page);
    const put = await spot();
    assert.ok(Math.hypot(put.x - taken.x - 9, put.y - taken.y + 6) < 2, 'under the finger');
    const kept = await jointPosition(page, name);
    await turnScreen(finger, false);
    await page.waitForFunction(() => innerWidth === 390);

    await page.evaluate(() => {
      Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
      document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
    });
    await says('Waiting');
    await page.evaluate(() => {
      delete document.visibilityState;
      document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
    });
    await says('Drag a handle');

    await leave();

    await context.clearPermissions();
    await page.locator('#view-in-ar').tap();
    const card = page.locator('#ways [data-way="card"]'), told = page.locator('#ways [role=alert], #notice:not([hidden])');
    await card.or(told).first().waitFor();
    if (await card.isVisible() && !await told.isVisible()) await card.tap();
    await told.waitFor();
    assert.match(await page.locator('#ways, #notice:not([hidden])').first().textContent(), /camera/);
    await shot('refused');
    assert.ok(await page.locator('#app').isVisible());
    assert.ok(await jointPosition(page, name).then((now) => now.every((value, i) => Math.abs(value - kept[i]) < 1e-6)), 'the pose is kept');
    assert.deepEqual(errors, []);
  },
};
const failed = await runCases(cases, page, output);
await browser.close();
server.close();
rmSync(film);
process.exit(failed ? 1 : 0);
