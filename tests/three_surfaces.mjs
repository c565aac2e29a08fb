// Do other programs show a model that limber wrote as USD where they show the GLB that it was made of?
//
//   node tests/three_surfaces.mjs LIMBER OUTPUT_FOLDER FILE.glb...
//
// Converts each model, once for each of its clips, to a .usda, a .usdc and a .usdz. three.js loads these and the GLB with its
// own loaders and plays them: the world positions of the corners of all triangles at keys of the clip have to be the same.
// tinyusdz, which refuses what three.js passes over, has to read them, and to find the same triangles and materials in text
// and crate. With LIMBER_SIZES says how far they are apart, and how large they are beside the GLB. Ends with
// "N passed, N failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { USDLoader } from 'three/examples/jsm/loaders/USDLoader.js';
import { loadGlb } from './three_glb.mjs';
import { corners, largestDistances } from './three_show.mjs';
import { readStrictly } from './tiny_usd.mjs';

const kTolerance = 1e-5; // of the model's size
const kForms = ['usda', 'usdc', 'usdz'];

// What three.js makes of pictures, which only a browser reads: elements that never load.
globalThis.document ??= { createElementNS: () => ({ addEventListener() {}, removeEventListener() {} }) };

function loadUsd(path) {
  const bytes = readFileSync(path);
  const root = new USDLoader().parse(path.endsWith('.usda') ? bytes.toString() : Uint8Array.from(bytes).buffer);
  return { root, clips: root.animations ?? [] };
}

// Throws unless text and crate are the same to tinyusdz, but for the rounding of text.
async function compareStrictly(paths, corners) {
  const [text, ...crates] = await Promise.all(paths.map(readStrictly));
  const found = text.meshes.reduce((sum, mesh) => sum + mesh.corners.length, 0);
  if (found !== corners) throw new Error(`tinyusdz finds ${found / 3} triangles for ${corners / 3}`);
  const largest = text.meshes.reduce((most, { points }) => points.reduce((so, value) => Math.max(so, Math.abs(value)), most), 0);
  const rounded = (_, value) => (typeof value === 'number' ? Number(value.toPrecision(5)) : value);
  for (const crate of crates) {
    const same = text.meshes.length === crate.meshes.length && text.meshes.every((mesh, m) => {
      const other = crate.meshes[m];
      // Corner by corner: vertices that are the same once rounded are one to tinyusdz.
      return mesh.name === other.name && mesh.corners.length === other.corners.length && mesh.corners.every((corner, i) =>
        [0, 1, 2].every((axis) => Math.abs(mesh.points[3 * corner + axis] - other.points[3 * other.corners[i] + axis]) <= kTolerance * largest));
    });
    if (!same) throw new Error('tinyusdz reads other triangles from the crate than from the text');
    if (JSON.stringify(text.materials, rounded) !== JSON.stringify(crate.materials, rounded)) {
      throw new Error('tinyusdz reads other materials from the crate than from the text');
    }
  }
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
      const paths = kForms.map((form) => join(folder, basename(file).replace(/\.glb$/, `.${form}`)));
      const options = glb.names[i] ? ['--clip', glb.names[i]] : []; // three.js names those that have no name
      for (const path of paths) {
        execFileSync(limber, ['convert', file, path, ...options, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
      }
      const distances = largestDistances(glb, paths.map(loadUsd), clip);
      await compareStrictly(paths, corners(glb.root).length);
      const isSame = distances.every((distance) => distance < kTolerance);
      isSame ? ++passed : ++failed;
      const told = `${file}: '${clip?.name ?? ''}': ${distances.map((distance) => distance.toExponential(1)).join(', ')}`;
      if (!isSame) console.log(`${told} of its size away, as ${kForms.join(', ')}`);
      if (process.env.LIMBER_SIZES) {
        const ratios = paths.map((path) => (readFileSync(path).length / readFileSync(file).length).toFixed(2));
        console.log(`${told}; ${ratios.join(', ')} times the GLB`);
      }
    }
  } catch (error) {
    ++failed;
    console.log(`${file}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
