// Does three.js show a model that limber wrote as FBX where it shows the GLB that it was made of?
//
//   node tests/three_fbx.mjs LIMBER OUTPUT_FOLDER FILE.glb...
//
// Converts each model to an .fbx with all of its clips, loads both with three.js' own loaders, plays the clips, and
// compares the world positions of the corners of all triangles at their keys, in metres. A model without meshes is
// compared by its bones. With LIMBER_SIZES says how far they are apart, and how large the file is beside the GLB; with
// LIMBER_CORNERS writes the corners at a few moments beside the .fbx, for tests/blender_fbx.py. Ends with "N passed, N
// failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { BoxGeometry, Group, Mesh } from 'three';
import { FBXLoader } from 'three/examples/jsm/loaders/FBXLoader.js';
import { loadGlb } from './three_glb.mjs';
import { corners, largestDistances, meshesOf, show } from './three_show.mjs';

const kTolerance = 1e-5; // of the model's size

// What the loader wants of a page to load pictures with; none are shown.
globalThis.window = { innerWidth: 1, innerHeight: 1 };
globalThis.document = { createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, style: {} }) };

function loadFbx(path) {
  const bytes = readFileSync(path);
  const warn = console.warn;
  console.warn = () => {}; // of more than four weights a vertex
  const root = new FBXLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  console.warn = warn;
  const inMetres = new Group().add(root); // for the root may be one of the model's own nodes
  inMetres.scale.setScalar(root.userData.unitScaleFactor / 100);
  return { root: inMetres, clips: root.animations };
}

// A box on each bone, so that a skeleton alone has corners.
function standIn(model) {
  let meshes = 0;
  const bones = [];
  model.root.traverse((object) => {
    meshes += object.isMesh ? 1 : 0;
    if (object.isBone) bones.push(object);
  });
  if (meshes > 0) return;
  for (const [i, bone] of bones.entries()) {
    const box = new Mesh(new BoxGeometry(1e-9, 1e-9, 1e-9)); // its place alone, whatever the unit
    box.ID = bone.ID ?? i;
    bone.add(box);
  }
}

// Where all tracks have a key: between keys Blender turns otherwise.
function commonKeys(clip) {
  const tracks = (clip?.tracks ?? []).filter(({ times }) => times.length > 1).map(({ times }) => new Set(times));
  const keys = tracks.length > 0 ? [...tracks[0]].filter((time) => tracks.every((track) => track.has(time))) : [0];
  if (keys.length === 0) throw new Error(`no key of '${clip.name}' is one of all tracks`);
  return keys;
}

// X.corners.json: { meshes: [{ name, corners }], clips: [{ name, seconds: [] }] }; X.corners.bin: float32 of each clip,
// moment, mesh, corner.
function writeCorners(fbx, path) {
  const kMoments = 3, places = [], clips = [];
  const names = fbx.clips.length > 0 ? fbx.clips.map(({ name }) => name) : [undefined];
  for (const [i, name] of names.entries()) {
    const keys = commonKeys(fbx.clips[i]);
    const seconds = [...new Set(Array.from({ length: kMoments }, (_, k) => keys[Math.floor((k * (keys.length - 1)) / (kMoments - 1))]))];
    clips.push({ name: name ?? '', seconds });
    for (const moment of seconds) {
      show(fbx, name, moment);
      for (const place of corners(fbx.root)) places.push(place.x, place.y, place.z);
    }
  }
  const meshes = meshesOf(fbx.root).map((mesh) => ({ name: mesh.userData.originalName, corners: mesh.geometry.attributes.position.count }));
  writeFileSync(`${path}.corners.json`, JSON.stringify({ meshes, clips }));
  writeFileSync(`${path}.corners.bin`, new Uint8Array(Float32Array.from(places).buffer));
}

const [limber, folder, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node tests/three_fbx.mjs LIMBER OUTPUT_FOLDER FILE.glb...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });

let passed = 0, failed = 0;
for (const file of files) {
  try {
    const written = join(folder, basename(file).replace(/\.\w+$/, '.fbx'));
    execFileSync(limber, ['convert', file, written, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
    const glb = await loadGlb(file), fbx = loadFbx(written);
    standIn(glb);
    standIn(fbx);
    const names = fbx.clips.map(({ name }) => name);
    for (const [i, clip] of (glb.clips.length > 0 ? glb.clips : [undefined]).entries()) {
      const distance = largestDistances(glb, [fbx], clip, names[i])[0];
      distance < kTolerance ? ++passed : ++failed;
      if (!(distance < kTolerance)) console.log(`${file}: '${clip?.name ?? ''}': the surface is ${distance} of its size away`);
      if (process.env.LIMBER_SIZES) console.log(`${file}: '${clip?.name ?? ''}': ${distance.toExponential(1)}`);
    }
    if (process.env.LIMBER_CORNERS) writeCorners(fbx, written.replace(/\.fbx$/, ''));
    const ratio = readFileSync(written).length / readFileSync(file).length;
    if (process.env.LIMBER_SIZES) console.log(`${file}: ${ratio.toFixed(2)} times the GLB`);
  } catch (error) {
    ++failed;
    console.log(`${file}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
