// Does three.js show each body of a crowd as its build, retargeted by itself, at its own offset and place?
//
//   node tests/crowd_test.mjs LIMBER OUTPUT_FOLDER
//
// Makes a crowd of the project's own person, and compares vertices of each body at several moments with those of the build's
// own file. Then retargets a list of characters with faulty ones in it. Ends with "N passed, N failed".
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { AnimationMixer, Vector3 } from 'three';
import { loadInThree } from './three_glb.mjs';

const kTolerance = 1e-3; // metres
const kRate = 30; // frames a second
const kStride = 97; // of the vertices that are compared

const [limber, folder] = process.argv.slice(2);
if (!folder) {
  console.error('usage: node tests/crowd_test.mjs LIMBER OUTPUT_FOLDER');
  process.exit(2);
}
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const inFolder = (name) => join(folder, name);
const run = (...words) => execFileSync(limber, [...words, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });

let passed = 0, failed = 0;
const check = (isRight, what) => {
  isRight ? ++passed : ++failed;
  if (!isRight) console.log(`FAILED: ${what}`);
};

async function player(path) {
  const { scene, animations, parser } = await loadInThree(path);
  const mixer = new AnimationMixer(scene);
  const action = mixer.clipAction(animations.at(-1));
  action.setLoop(2200).clampWhenFinished = true; // LoopOnce
  action.play();
  const meshes = [];
  scene.traverse((object) => { if (object.isSkinnedMesh) meshes.push(object); });
  return {
    scene, parser, meshes, duration: animations.at(-1).duration,
    show(seconds) { mixer.setTime(seconds); scene.updateMatrixWorld(true); },
  };
}

function vertices(meshes) {
  const places = [];
  for (const mesh of meshes) {
    for (let v = 0; v < mesh.geometry.attributes.position.count; v += kStride) {
      places.push(mesh.localToWorld(mesh.getVertexPosition(v, new Vector3())));
    }
  }
  return places;
}

// The node that a skin's joints hang on below the scene.
function bodyOf(mesh) {
  let node = mesh.skeleton.bones[0];
  while (!node.userData.limber_crowd) node = node.parent;
  return node;
}

run('sample', 'biped', '-o', inFolder('biped.glb'));
for (const motion of ['walk', 'wave']) run('sample', motion, '-o', inFolder(`${motion}.bvh`));
run('rig', inFolder('biped.glb'), '--rigger', 'template', '-o', inFolder('person.glb'));
const crowd = ['crowd', inFolder('person.glb'), '--motions', inFolder('walk.bvh'), inFolder('wave.bvh'), '--count', '12', '--builds', '3',
  '--turn', '90'];
run(...crowd, '--save-builds', inFolder('builds'), '-o', inFolder('crowd.glb'));
run(...crowd, '--threads', '1', '-o', inFolder('again.glb'));
check(readFileSync(inFolder('crowd.glb')).equals(readFileSync(inFolder('again.glb'))), 'the same bytes on one thread');

const shown = await player(inFolder('crowd.glb'));
const bodies = new Map();
for (const mesh of shown.meshes) {
  const body = bodyOf(mesh);
  bodies.set(body, [...(bodies.get(body) ?? []), mesh]);
}
check(bodies.size === 12, `12 bodies, not ${bodies.size}`);
const singles = new Map();
async function singleOf(build, clip) {
  const name = inFolder(`single_${build}_${clip}.glb`);
  if (!singles.has(name)) {
    run('retarget', inFolder(`builds/build_${build}.glb`), inFolder(`${clip}.bvh`), '--fps', String(kRate), '-o', name);
    singles.set(name, await player(name));
  }
  return singles.get(name);
}
for (const [body, meshes] of bodies) {
  const { build, clip, offset } = body.userData.limber_crowd;
  const single = await singleOf(build, clip);
  let largest = 0, compared = 0;
  for (const moment of [0, 0.11, 0.9, 1.7, 2.6]) {
    const own = (moment + offset) % single.duration;
    if (own > single.duration - 1 / kRate || moment > shown.duration) continue; // there it goes over to its first frame
    shown.show(moment);
    single.show(own);
    const wanted = vertices(single.meshes);
    vertices(meshes).forEach((place, i) => { largest = Math.max(largest, place.distanceTo(body.localToWorld(wanted[i]))); });
    compared += wanted.length;
  }
  check(compared > 100 && largest < kTolerance, `${body.name} (build ${build}, ${clip} from ${offset} s) is ${largest} m off, ${compared} compared`);
}

// A list with faulty ones.
writeFileSync(inFolder('broken.glb'), readFileSync(inFolder('person.glb')).subarray(0, 500));
writeFileSync(inFolder('list.txt'), 'builds/build_1.glb\nbroken.glb\n# none\nbuilds/build_2.glb\nbiped.glb\nmissing.glb\n');
const list = spawnSync(limber, ['retarget', '--characters', inFolder('list.txt'), inFolder('walk.bvh'), inFolder('wave.bvh'), '--fps',
  String(kRate), '-o', inFolder('out')], { encoding: 'utf8' });
check(list.status === 1, `faulty characters end with 1, not ${list.status}: ${list.stderr}`);
check((list.stdout.match(/failed:/g) ?? []).length === 3, `three kinds of failures in: ${list.stdout}`);
for (const build of [1, 2]) {
  run('retarget', inFolder(`builds/build_${build}.glb`), inFolder('walk.bvh'), inFolder('wave.bvh'), '--fps', String(kRate), '-o', inFolder('alone.glb'));
  check(readFileSync(inFolder('alone.glb')).equals(readFileSync(inFolder(`out/build_${build}.glb`))), `build ${build} as by itself`);
}
check(!existsSync(inFolder('out/broken.glb')) && !existsSync(inFolder('out/biped.glb')), 'nothing for faulty ones');
rmSync(inFolder('broken.glb')); // what is left is valid

console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
