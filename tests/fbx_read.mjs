// Does limber read an FBX file as three.js' own reader does?
//
//   node tests/fbx_read.mjs LIMBER OUTPUT_FOLDER FILE.fbx...
//
// Converts each model to GLB, loads that and the FBX file in three.js, plays the clips of one name, and compares the surfaces at both
// ends of the clip: each corner of either with the nearest one of the other, since polygons may be cut up in several ways.
// With LIMBER_SIZES says how far they are apart. Ends with "N passed, N failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { Box3, Vector3 } from 'three';
import { FBXLoader } from 'three/examples/jsm/loaders/FBXLoader.js';
import { loadGlb } from './three_glb.mjs';
import { corners, show } from './three_show.mjs';

const kTolerance = 1e-5; // of the model's size
const kReach = 64; // cells along the model's size, in the grid of which a point is looked for

// What its reader asks a browser for: the size of the window, and pictures, which never come.
globalThis.window = { innerWidth: 1, innerHeight: 1 };
globalThis.document = { createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, style: {} }) };
console.warn = () => {};

// In metres, with no more than the clips' own names.
function loadFbx(path) {
  const bytes = readFileSync(path);
  const root = new FBXLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  root.scale.multiplyScalar((root.userData.unitScaleFactor ?? 1) / 100);
  return { root, clips: root.animations };
}

// How far the points of one list are from the nearest of another, at most.
function farthest(points, from, size) {
  const cells = new Map(), step = size / kReach, cellOf = (x) => Math.floor(x / step);
  const key = (x, y, z) => `${x},${y},${z}`;
  for (const point of from) {
    const cell = key(cellOf(point.x), cellOf(point.y), cellOf(point.z));
    if (!cells.has(cell)) cells.set(cell, []);
    cells.get(cell).push(point);
  }
  let largest = 0;
  for (const point of points) {
    let nearest = step * step; // farther ones need not be told apart
    for (let dx = -1; dx <= 1; ++dx) for (let dy = -1; dy <= 1; ++dy) for (let dz = -1; dz <= 1; ++dz) {
      const cell = cells.get(key(cellOf(point.x) + dx, cellOf(point.y) + dy, cellOf(point.z) + dz)) ?? [];
      for (const other of cell) nearest = Math.min(nearest, point.distanceToSquared(other));
    }
    largest = Math.max(largest, nearest);
  }
  return Math.sqrt(largest);
}

// Each place once: corners share them.
function different(points) {
  const seen = new Map();
  for (const point of points) seen.set(`${point.x},${point.y},${point.z}`, point);
  return [...seen.values()];
}

// The first and the last key of a clip, which all curves have: in between its reader lets an angle that has no key of its own at a
// moment stay where it was, where the curve goes on.
function ends(clip) {
  const times = clip?.tracks.flatMap((track) => [track.times[0], track.times.at(-1)]) ?? [0];
  return [Math.min(...times), Math.max(...times)];
}

// limber's clips begin at 0, those of three.js with the file's clock: both end with the same key.
function largestDistance(fbx, glb, theirs, ours) {
  const later = theirs ? theirs.tracks.reduce((last, { times }) => Math.max(last, times.at(-1)), 0) -
    ours.tracks.reduce((last, { times }) => Math.max(last, times.at(-1)), 0) : 0;
  let largest = 0, size = 0;
  for (const seconds of ends(ours)) {
    show(fbx, theirs?.name, seconds + later);
    show(glb, ours?.name, seconds);
    const expected = different(corners(fbx.root)), shown = different(corners(glb.root));
    if (expected.length === 0 || shown.length === 0) throw new Error(`has ${shown.length} places for ${expected.length}`);
    size = Math.max(size, new Box3().setFromPoints(expected).getSize(new Vector3()).length());
    largest = Math.max(largest, farthest(expected, shown, size), farthest(shown, expected, size));
  }
  return largest / size;
}

const [limber, folder, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node tests/fbx_read.mjs LIMBER OUTPUT_FOLDER FILE.fbx...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });

let passed = 0, failed = 0;
for (const file of files) {
  try {
    const converted = join(folder, basename(file).replace(/\.fbx$/i, '.glb'));
    execFileSync(limber, ['convert', file, converted, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
    const fbx = loadFbx(file), glb = await loadGlb(converted);
    if (corners(glb.root).length === 0) continue; // motion alone
    for (const [i, ours] of (glb.clips.length > 0 ? glb.clips : [undefined]).entries()) {
      const theirs = ours && fbx.clips.find(({ name }) => name === glb.names[i]);
      if (ours && !theirs) throw new Error(`has a clip '${glb.names[i]}' that three.js does not see`);
      const distance = largestDistance(fbx, glb, theirs, ours);
      distance < kTolerance ? ++passed : ++failed;
      if (!(distance < kTolerance)) console.log(`${file}: '${ours?.name ?? ''}': the surface is ${distance} of its size away`);
      if (process.env.LIMBER_SIZES) console.log(`${file}: '${ours?.name ?? ''}': ${distance.toExponential(1)}`);
    }
  } catch (error) {
    ++failed;
    console.log(`${file}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
