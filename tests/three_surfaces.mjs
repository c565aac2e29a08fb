// Does three.js show a model that limber wrote as USD where it shows the GLB that it was made of?
//
//   node tests/three_surfaces.mjs LIMBER OUTPUT_FOLDER FILE.glb...
//
// Converts each model, once for each of its clips, to a .usda, loads both with three.js' own loaders, plays them, and
// compares the world positions of the corners of all triangles at keys of the clip. With LIMBER_SIZES says how far they are
// apart, and how large the text is beside the GLB. Ends with "N passed, N failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { AnimationMixer, Box3, Vector3 } from 'three';
import { USDLoader } from 'three/examples/jsm/loaders/USDLoader.js';
import { loadInThree } from './three_glb.mjs';

const kTolerance = 1e-5; // of the model's size
const kMostMoments = 24;

async function loadGlb(path) {
  const { scene, animations, parser } = await loadInThree(path);
  return { root: scene, clips: animations, names: (parser.json.animations ?? []).map(({ name }) => name) };
}

// Without what makes three.js look for pictures.
function loadUsd(path) {
  const text = readFileSync(path, 'utf8').replace(/asset inputs:file = .*/g, '');
  const root = new USDLoader().parse(text);
  return { root, clips: root.animations ?? [] };
}

function show({ root, clips }, name, seconds) {
  const clip = clips.find((one) => one.name === name) ?? clips[0];
  if (clip) {
    const mixer = new AnimationMixer(root);
    const action = mixer.clipAction(clip);
    action.setLoop(2200).clampWhenFinished = true; // LoopOnce
    action.play();
    mixer.setTime(seconds);
  }
  root.updateMatrixWorld(true);
}

// The corners of all triangles in the world, mesh after mesh.
function corners(root) {
  const found = [];
  root.traverse((object) => {
    if (!object.isMesh) return;
    if (object.isSkinnedMesh) object.skeleton.update();
    const { index } = object.geometry, count = (index ?? object.geometry.attributes.position).count;
    for (let i = 0; i < count; ++i) {
      found.push(object.getVertexPosition(index ? index.getX(i) : i, new Vector3()).applyMatrix4(object.matrixWorld));
    }
  });
  return found;
}

function momentsOf(clip) {
  if (!clip) return [0];
  const keys = [...new Set(clip.tracks.flatMap((track) => [...track.times]))].sort((a, b) => a - b);
  const step = Math.max(1, Math.ceil(keys.length / kMostMoments));
  return keys.filter((_, i) => i % step === 0);
}

function largestDistance(glb, usd, clip) {
  let largest = 0, size = 0;
  for (const seconds of momentsOf(clip)) {
    show(glb, clip?.name, seconds);
    show(usd, undefined, seconds);
    const expected = corners(glb.root), shown = corners(usd.root);
    if (expected.length !== shown.length) throw new Error(`has ${shown.length / 3} triangles for ${expected.length / 3}`);
    size = Math.max(size, new Box3().setFromPoints(expected).getSize(new Vector3()).length());
    expected.forEach((place, i) => { largest = Math.max(largest, place.distanceTo(shown[i])); });
  }
  return largest / size;
}

const [limber, folder, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node tests/three_surfaces.mjs LIMBER OUTPUT_FOLDER FILE.glb...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });

let passed = 0, failed = 0;
for (const file of files) {
  try {
    const glb = await loadGlb(file);
    for (const [i, clip] of (glb.clips.length > 0 ? glb.clips : [undefined]).entries()) {
      const usda = join(folder, basename(file).replace(/\.glb$/, '.usda'));
      const options = glb.names[i] ? ['--clip', glb.names[i]] : []; // three.js names those that have no name
      execFileSync(limber, ['convert', file, usda, ...options, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
      const distance = largestDistance(glb, loadUsd(usda), clip);
      distance < kTolerance ? ++passed : ++failed;
      const ratio = readFileSync(usda).length / readFileSync(file).length;
      if (!(distance < kTolerance)) console.log(`${file}: '${clip?.name ?? ''}': the surface is ${distance} of its size away`);
      if (process.env.LIMBER_SIZES) console.log(`${file}: '${clip?.name ?? ''}': ${distance.toExponential(1)}, text ${ratio.toFixed(2)} times the GLB`);
    }
  } catch (error) {
    ++failed;
    console.log(`${file}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
