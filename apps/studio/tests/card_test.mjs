// Follows the card through pictures that are drawn here, so that its true place is known.
//   node apps/studio/tests/card_test.mjs
import assert from 'node:assert/strict';
import { fileURLToPath } from 'node:url';
import { Matrix4, Quaternion, Vector3 } from 'three';
import { createServer } from 'vite';
import { drawn, height, opened, poseFrom, side, width } from './card_film.mjs';
import { runCases } from './page.mjs';

const server = await createServer({ root: fileURLToPath(new URL('..', import.meta.url)), server: { middlewareMode: true, hmr: false, watch: null }, appType: 'custom', logLevel: 'error' });
const load = (name) => server.ssrLoadModule(`/src/ar/card/${name}.ts`);
const { Tracker } = await load('tracker'), { FocalSearch } = await load('focal_search'), { lensOf, seenAt } = await load('pose'), { cardId, dictionary } = await load('card');
const { AR } = await server.ssrLoadModule('js-aruco2/src/aruco.js');

const lens = lensOf(width, height, 50), code = AR.DICTIONARIES[dictionary].codeList[cardId];
const picture = (poses, more) => drawn([poses].flat(), lens.focal, code, more);
const known = ({ turn: r, move }) => ({
  rotation: new Quaternion().setFromRotationMatrix(new Matrix4().set(r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0, 0, 0, 0, 1)),
  position: new Vector3(...move),
});
const degreesOff = (a, b) => (a.rotation.angleTo(b.rotation) * 180) / Math.PI;
const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

const failed = await runCases({
  'within 0.2 degrees and 0.2 % of the distance at 0.4 m'() {
    const turns = [], distances = [];
    for (let i = 0; i < 12; ++i) {
      const pose = poseFrom(0.4, 30 + 5 * (i % 6), 31 * i, 7 * (i % 5) - 14, [0.12 * Math.sin(i), 0.09 * Math.cos(i)]), truth = known(pose);
      const found = new Tracker(side).follow(picture(pose, { seed: i + 1 }), lens);
      assert.ok(found, `not found in picture ${i}`);
      turns.push(degreesOff(found, truth));
      distances.push(Math.abs(found.position.length() / truth.position.length() - 1));
    }
    console.log(`   turned ${median(turns).toFixed(3)} (at most ${Math.max(...turns).toFixed(3)}) degrees off, distance ${(100 * median(distances)).toFixed(3)} (${(100 * Math.max(...distances)).toFixed(3)}) %`);
    assert.ok(Math.max(...turns) < 0.2 && Math.max(...distances) < 0.002);
  },
  'jitter below 0.2 mm at rest'() {
    const tracker = new Tracker(side), places = [];
    for (let i = 0; i < 15; ++i) {
      const found = tracker.follow(picture(poseFrom(0.4, 40, 20), { seed: 100 + i }), lens);
      assert.ok(found);
      places.push(found.position);
    }
    const middle = places.reduce((sum, place) => sum.add(place), new Vector3()).divideScalar(places.length);
    const jitter = Math.sqrt(places.reduce((sum, place) => sum + place.distanceToSquared(middle), 0) / places.length);
    console.log(`   jitter ${(1000 * jitter).toFixed(3)} mm`);
    assert.ok(jitter < 0.0002);
  },
  'found in 95 % of the pictures of a shaking hand, and of a dark room'() {
    // Degrees of tremor: to 5 pixels while the shutter is open.
    const tremor = (seconds, hertz) => (Math.PI / 180) * (Math.sin(2 * Math.PI * hertz * seconds) + 0.15 * Math.sin(2 * Math.PI * 8.3 * seconds));
    const shaking = (seconds) => poseFrom(0.4, 45 + 10 * Math.sin(seconds), 40 * seconds, 3 * Math.sin(7 * seconds), [tremor(seconds, 2.7), tremor(seconds, 3.3)]);
    const slow = (seconds) => poseFrom(0.4 + 0.05 * Math.sin(seconds), 45, 20 * seconds);
    for (const [name, path, more] of [['shaking hand', shaking, {}], ['dark room', slow, { light: 0.08, noise: 1.5 }]]) {
      const tracker = new Tracker(side), count = 40, turns = [], distances = [];
      for (let i = 0; i < count; ++i) {
        const truth = known(path(i / 30)), found = tracker.follow(picture(opened(path, i / 30), { seed: 200 + i, perSide: 2, ...more }), lens);
        if (!found) continue;
        turns.push(degreesOff(found, truth));
        distances.push(Math.abs(found.position.length() / truth.position.length() - 1));
      }
      console.log(`   ${name}: found in ${turns.length} of ${count}, ${median(turns).toFixed(2)} degrees and ${(100 * median(distances)).toFixed(2)} % off`);
      assert.ok(turns.length >= 0.95 * count, `${name}: found in ${turns.length} of ${count}`);
      assert.ok(median(turns) < 0.5 && median(distances) < 0.01, name); // it does not lag behind
    }
  },
  'lost and found again without a jump'() {
    const tracker = new Tracker(side), pose = poseFrom(0.4, 40, 20), before = tracker.follow(picture(pose), lens);
    assert.equal(tracker.follow(picture(poseFrom(0.4, 40, 20, 0, [0.9, 0])), lens), null);
    const after = tracker.follow(picture(pose, { seed: 5 }), lens);
    assert.ok(before && after && before.position.distanceTo(after.position) < 0.0005 && degreesOff(before, after) < 0.2);
  },
  'found where it jumps to, as well as where it was'() {
    for (const [from, to] of [[[-0.35, 0.2], [0.35, -0.2]], [[0, 0], [0.4, 0]]]) {
      const tracker = new Tracker(side), poses = [from, to].map((aside) => poseFrom(0.4, 50, 10, 0, aside));
      for (const [i, pose] of [poses[0], poses[0], poses[1], poses[1], poses[0]].entries()) {
        const found = tracker.follow(picture(pose, { seed: 400 + i }), lens), truth = known(pose);
        assert.ok(found && degreesOff(found, truth) < 0.2 && Math.abs(found.position.length() / truth.position.length() - 1) < 0.002, `picture ${i}`);
      }
    }
  },
  'a focal length 15 % wrong moves a point 100 mm above the card by at most 4 pixels'() {
    const pose = poseFrom(0.4, 40, 20), truth = known(pose), top = new Vector3(0, 0.1, 0), seen = picture(pose);
    for (const wrong of [0.85, 1.15]) {
      const tracker = new Tracker(side), search = new FocalSearch(side, { ...lens, focal: lens.focal * wrong });
      for (let i = 0; i < 5; ++i) { // a hand on its way there
        assert.ok(tracker.follow(picture(poseFrom(0.4, 60 - 5 * i, 5 * i, 2 * i), { seed: 300 + i }), search.lens));
        search.learn(tracker.corners);
      }
      const found = tracker.follow(seen, search.lens);
      assert.ok(found);
      const a = seenAt(top, truth, lens), b = seenAt(top, found, search.lens), off = Math.hypot(a.x - b.x, a.y - b.y);
      console.log(`   ${wrong}: ${off.toFixed(2)} pixels, focal length found ${(search.lens.focal / lens.focal).toFixed(3)} of the true one`);
      assert.ok(off <= 4, `${off.toFixed(2)} pixels`);
    }
  },
}, { screenshot: async () => {} }, '.');
await server.close();
process.exit(failed ? 1 : 0);
