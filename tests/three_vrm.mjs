// Does three-vrm find in a VRM that limber wrote what the model had, and does a VRMA move it as the model's own clip does?
//
//   node tests/three_vrm.mjs LIMBER OUTPUT_FOLDER FILE.glb...
//
// Of each model: a VRM stands in T-pose, facing +Z; each of its clips shows all vertices where the model's shows them; and
// the clip as a VRMA turns the VRM's bones as the clip does, the hips where the clip has them, and every vertex where it
// has them if nothing but turning bones moves there. With LIMBER_SIZES says how far they are apart. Ends with
// "N passed, N failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { VRMLoaderPlugin } from '@pixiv/three-vrm';
import { createVRMAnimationClip, VRMAnimationLoaderPlugin } from '@pixiv/three-vrm-animation';
import { AnimationMixer, Box3, Quaternion, Vector3 } from 'three';
import { loadInThree } from './three_glb.mjs';

const kTolerance = 1e-5; // of the model's size
const kSameTurn = 1e-4; // radians: quaternions out of matrices of single precision
const kStraight = 0.02; // radians: limbs of the T-pose
const kMostMoments = 12;
globalThis.self = globalThis; // three-vrm looks for it

async function loadVrm(path) {
  const { scene, animations, userData } = await loadInThree(path, [(parser) => new VRMLoaderPlugin(parser)]);
  return { root: scene, clips: animations, vrm: userData.vrm };
}

const playing = new Map(); // by root
function show(root, clip, seconds) {
  playing.get(root)?.stopAllAction(); // as it stood before
  const mixer = new AnimationMixer(root);
  playing.set(root, mixer);
  const action = mixer.clipAction(clip);
  action.setLoop(2200).clampWhenFinished = true; // LoopOnce
  action.play();
  mixer.setTime(seconds);
  root.updateMatrixWorld(true);
}

// Every vertex in the world, mesh after mesh by their names.
function vertices(root) {
  const meshes = [], found = [];
  root.updateMatrixWorld(true);
  root.traverse((object) => { if (object.isMesh) meshes.push(object); });
  meshes.sort((a, b) => (a.name < b.name ? -1 : 1));
  for (const mesh of meshes) {
    if (mesh.isSkinnedMesh) mesh.skeleton.update();
    const { count } = mesh.geometry.attributes.position;
    for (let i = 0; i < count; ++i) found.push(mesh.getVertexPosition(i, new Vector3()).applyMatrix4(mesh.matrixWorld));
  }
  return found;
}

const farthest = (a, b) => {
  if (a.length !== b.length) throw new Error(`has ${b.length} vertices for ${a.length}`);
  return a.reduce((most, place, i) => Math.max(most, place.distanceTo(b[i])), 0);
};

function momentsOf(clip) {
  const keys = [...new Set(clip.tracks.flatMap((track) => [...track.times]))].sort((a, b) => a - b);
  return keys.filter((_, i) => i % Math.max(1, Math.ceil(keys.length / kMostMoments)) === 0);
}

// Those that a motion for VRMs turns: eyes go by its gaze.
const bonesOf = (vrm) => Object.entries(vrm.humanoid.humanBones).map(([name, { node }]) => ({ name, node })).filter(({ name }) => !name.endsWith('Eye'));

// What is wrong with how it stands.
function faultsOfRest({ root, vrm }) {
  root.updateMatrixWorld(true);
  const at = (bone) => vrm.humanoid.getRawBoneNode(bone).getWorldPosition(new Vector3());
  const faults = [];
  const along = (from, to, direction) => {
    const angle = at(to).sub(at(from)).angleTo(direction);
    if (angle > kStraight) faults.push(`${from} is ${angle.toFixed(3)} off its direction`);
  };
  for (const [side, sign] of [['left', 1], ['right', -1]]) {
    along(`${side}UpperArm`, `${side}LowerArm`, new Vector3(sign, 0, 0));
    along(`${side}LowerArm`, `${side}Hand`, new Vector3(sign, 0, 0));
    along(`${side}UpperLeg`, `${side}LowerLeg`, new Vector3(0, -1, 0));
    along(`${side}LowerLeg`, `${side}Foot`, new Vector3(0, -1, 0));
  }
  if (!(at('hips').y > 0 && at('head').y > at('hips').y)) faults.push('does not stand above the ground');
  return faults;
}

const localsOf = (root) => {
  const locals = new Map();
  root.traverse(({ uuid, position, quaternion, scale }) => locals.set(uuid, [position.clone(), quaternion.clone(), scale.clone()]));
  return locals;
};

// Has anything changed that a motion for VRMs cannot say: other nodes, or lengths and scales of bones?
function movesOtherwise({ root, vrm }, rest) {
  const bones = new Map(bonesOf(vrm).map(({ name, node }) => [node.uuid, name]));
  let other = false;
  root.traverse(({ uuid, position, quaternion, scale }) => {
    const [p, q, s] = rest.get(uuid), bone = bones.get(uuid), near = 1e-6 * (1 + p.length());
    const isPlaced = bone === 'hips' || position.distanceTo(p) < near;
    other ||= !isPlaced || scale.distanceTo(s) > 1e-6 || (!bone && 1 - Math.abs(quaternion.dot(q)) > 1e-9);
  });
  return other;
}

// The turn that limber put above a model that faced elsewhere.
function turnOf(root) {
  let turn = new Quaternion();
  root.traverse((object) => { if (object.name.startsWith('facing_front')) turn = object.quaternion.clone(); });
  return turn;
}

const [limber, folder, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node tests/three_vrm.mjs LIMBER OUTPUT_FOLDER FILE.glb...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const convert = (...words) => execFileSync(limber, ['convert', ...words, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
let passed = 0, failed = 0;
const check = (file, what, value, limit) => {
  const good = value < limit;
  good ? ++passed : ++failed;
  if (!good || process.env.LIMBER_SIZES) console.log(`${file}: ${what}: ${value.toExponential(1)}${good ? '' : ' is too far'}`);
};

for (const file of files) {
  const stem = basename(file).replace(/\.\w+$/, ''), name = stem;
  try {
    const path = join(folder, `${stem}.vrm`);
    convert(file, path, '--vrm-author', 'Somebody');
    writeFileSync(`${path}.source`, resolve(file)); // for tools/validate.mjs
    const model = await loadInThree(file), avatar = await loadVrm(path);
    const faults = faultsOfRest(avatar);
    faults.length === 0 ? ++passed : ++failed;
    if (faults.length > 0) console.log(`${name}: ${faults.join('; ')}`);
    const turn = turnOf(avatar.root), names = (model.parser.json.animations ?? []).map((each) => each.name);
    for (const [i, clip] of model.animations.entries()) {
      const ownClip = avatar.clips.find((each) => each.name === (names[i] ? clip.name : 'clip')), motion = join(folder, `${stem}_${i}.vrma`);
      convert(file, motion, ...(names[i] ? ['--clip', names[i]] : []));
      const { userData } = await loadInThree(motion, [(parser) => new VRMAnimationLoaderPlugin(parser)]);
      const player = await loadVrm(path), played = createVRMAnimationClip(userData.vrmAnimations[0], player.vrm);
      playing.get(avatar.root)?.stopAllAction();
      const rest = localsOf(avatar.root);
      let isBonesAlone = true, byClip = 0, byMotion = 0, turned = 0, hips = 0, size = 0;
      for (const seconds of momentsOf(clip)) {
        show(model.scene, clip, seconds);
        show(avatar.root, ownClip, seconds);
        show(player.root, played, seconds);
        player.vrm.humanoid.update();
        const expected = vertices(model.scene).map((place) => place.applyQuaternion(turn)), shown = vertices(avatar.root);
        isBonesAlone &&= !movesOtherwise(avatar, rest);
        size = Math.max(size, new Box3().setFromPoints(expected).getSize(new Vector3()).length());
        byClip = Math.max(byClip, farthest(expected, shown));
        byMotion = Math.max(byMotion, farthest(shown, vertices(player.root)));
        for (const { name: bone, node } of bonesOf(avatar.vrm)) {
          const other = player.vrm.humanoid.getRawBoneNode(bone);
          const [own, others] = [node, other].map((each) => each.getWorldQuaternion(new Quaternion()));
          for (const axis of [new Vector3(1, 0, 0), new Vector3(0, 1, 0)]) {
            turned = Math.max(turned, axis.clone().applyQuaternion(own).distanceTo(axis.clone().applyQuaternion(others)));
          }
          if (bone === 'hips') hips = Math.max(hips, node.getWorldPosition(new Vector3()).distanceTo(other.getWorldPosition(new Vector3())));
        }
      }
      check(name, `'${clip.name}' in the VRM`, byClip / size, kTolerance);
      check(name, `'${clip.name}' as VRMA, turns`, turned, kSameTurn);
      check(name, `'${clip.name}' as VRMA, hips`, hips / size, kTolerance);
      if (isBonesAlone) check(name, `'${clip.name}' as VRMA, vertices`, byMotion / size, kTolerance);
    }
  } catch (error) {
    ++failed;
    console.log(`${name}: ${(error.stderr ?? error.message).toString().trim()}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
