// Does three.js show a motion that limber wrote as glTF where it shows the BVH that it was read from?
//
//   node tests/three_positions.mjs LIMBER OUTPUT_FOLDER FILE...
//
// Converts each BVH to GLB, loads the BVH with three.js' own BVHLoader and the GLB with its GLTFLoader, plays both, and
// compares the world positions of all joints at several moments. Then the GLB is converted to BVH, and that is compared
// with the GLB. Of characters (.glb) the last clip is converted to BVH and compared. Ends with "N passed, N failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { AnimationMixer, Group, Vector3 } from 'three';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';
import { loadInThree } from './three_glb.mjs';

const kTolerance = 1e-4; // of the skeleton's size, or metres where it is smaller than one
const kMoments = 7;
const kRounded = 5e-5;  // of a duration

// What a loader gave: the object that plays, and a clip.
const player = (root, clip) => {
  const mixer = new AnimationMixer(root);
  const action = mixer.clipAction(clip);
  action.setLoop(2200).clampWhenFinished = true; // LoopOnce
  action.play();
  return { root, clip: clip.name, duration: clip.duration, show: (seconds) => { mixer.setTime(seconds); root.updateMatrixWorld(true); } };
};

// Without the offsets of joints with positions: three.js adds the two, where other programs replace the one by the other.
function loadBvh(path) {
  const text = readFileSync(path, 'latin1').replace(/OFFSET[^\n]*(\s*CHANNELS 6)/g, 'OFFSET 0 0 0$1');
  const { skeleton, clip } = new BVHLoader().parse(text);
  const root = new Group();
  for (const bone of skeleton.bones) {
    bone.name = plain(bone.name);
    if (!bone.parent) root.add(bone);
  }
  for (const track of clip.tracks) track.name = track.name.replace(/^(.*)(\.\w+)$/, (_, joint, what) => plain(joint) + what);
  return player(root, clip);
}

async function loadGlb(path) {
  const gltf = await loadInThree(path);
  return player(gltf.scene, gltf.animations.at(-1));
}

// three.js takes characters with a meaning in its property paths out of the names of glTF nodes.
const plain = (name) => name.replace(/\s/g, '_').replace(/[[\].:/]/g, '');

function positions(root) {
  const found = new Map();
  root.traverse((object) => {
    // End sites have no names that both loaders agree on.
    if (object.isBone && !object.name.startsWith('ENDSITE') && !object.name.endsWith('_end')) {
      found.set(plain(object.name), object.getWorldPosition(new Vector3()));
    }
  });
  return found;
}

function largestDistance(a, b) {
  // A BVH writes its frame's time with six digits, which limber takes for what they mean (0.033333 s is 30 a second): the
  // same frames are at the same parts of the clips.
  const shortest = Math.min(a.duration, b.duration), isRounded = Math.abs(a.duration - b.duration) < kRounded * shortest;
  let largest = 0, compared = 0, size = 1;
  for (let i = 0; i < kMoments; ++i) {
    const part = i / (kMoments - 1) * 0.999;
    a.show(part * (isRounded ? a.duration : shortest));
    b.show(part * (isRounded ? b.duration : shortest));
    const others = positions(b.root);
    for (const [name, place] of positions(a.root)) {
      if (!others.has(name)) throw new Error(`no joint '${name}' in the converted file`);
      largest = Math.max(largest, place.distanceTo(others.get(name)));
      size = Math.max(size, place.length());
      ++compared;
    }
  }
  if (compared < 2 * kMoments) throw new Error('hardly any joint to compare');
  return largest / size;
}

const [limber, folder, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node tests/three_positions.mjs LIMBER OUTPUT_FOLDER FILE...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });

function convert(from, to, ...options) {
  execFileSync(limber, ['convert', from, to, ...options, '--up', 'y', '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
  return to;
}

// What is to be the same: name, reference, other.
async function pairsOf(file) {
  const inFolder = (ending) => join(folder, basename(file).replace(/\.(bvh|glb)$/, ending));
  if (file.endsWith('.glb')) {
    const character = await loadGlb(file);
    const motion = convert(file, inFolder('.bvh'), '--clip', character.clip);
    return [['character against BVH', loadBvh(motion), character]];
  }
  const glb = convert(file, inFolder('.glb')), back = convert(glb, inFolder('.bvh'));
  return [['BVH against glTF', loadBvh(file), await loadGlb(glb)], ['glTF against BVH', loadBvh(back), await loadGlb(glb)]];
}

let passed = 0, failed = 0;
for (const file of files) {
  try {
    for (const [what, reference, other] of await pairsOf(file)) {
      const distance = largestDistance(reference, other);
      distance < kTolerance ? ++passed : ++failed;
      if (!(distance < kTolerance)) console.log(`${file}: ${what}: joints are ${distance} apart`);
    }
  } catch (error) {
    ++failed;
    console.log(`${file}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
