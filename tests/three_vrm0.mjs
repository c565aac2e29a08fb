// Does three-vrm see the same in a file of VRM 0.x as in the VRM 1.0 that limber makes of it?
//
//   node tests/three_vrm0.mjs LIMBER OUTPUT_FOLDER FILE.glb...
//
// Makes a VRM 0.x of each rigged person by the letter of the specification (bones, meta, an expression, gaze, a braid that
// swings), lets limber convert it, and loads both: bones, all vertices at rest and as a motion for VRMs and the expression
// move them, springs with their colliders, gaze and permissions. Ends with "N passed, N failed".
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { VRMLoaderPlugin } from '@pixiv/three-vrm';
import { createVRMAnimationClip, VRMAnimationLoaderPlugin } from '@pixiv/three-vrm-animation';
import { AnimationMixer, Quaternion, Vector3 } from 'three';
import { loadInThree } from './three_glb.mjs';

const kTolerance = 1e-5; // of the model's size
globalThis.self = globalThis; // three-vrm looks for it
const halfRound = new Quaternion(0, 1, 0, 0);

function glbParts(bytes) {
  const length = bytes.readUInt32LE(12);
  return { document: JSON.parse(bytes.subarray(20, 20 + length)), rest: bytes.subarray(20 + length) };
}

function glbOf(document, rest) {
  let text = Buffer.from(JSON.stringify(document));
  text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const head = Buffer.alloc(20);
  head.write('glTF', 0, 'latin1');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(20 + text.length + rest.length, 8);
  head.writeUInt32LE(text.length, 12);
  head.write('JSON', 16, 'latin1');
  return Buffer.concat([head, text, rest]);
}

const oldThumbs = { ThumbMetacarpal: 'ThumbProximal', ThumbProximal: 'ThumbIntermediate' };
const oldName = (bone) => bone.replace(/Thumb(Metacarpal|Proximal)$/, (thumb) => oldThumbs[thumb]);
const vector = (x, y, z) => ({ x, y, z });

// A VRM 1.0 of limber's as VRM 0.x: all that is shown turned to face -Z.
function asVrm0(path) {
  const { document, rest } = glbParts(readFileSync(path));
  const { humanBones } = document.extensions.VRMC_vrm.humanoid, head = humanBones.head.node;
  const add = (node) => document.nodes.push(node) - 1;
  const strand = add({ name: 'strand', translation: [0.1, 0, 0.02] }), end = add({ name: 'braid_2', translation: [0, -0.1, 0] });
  const braid = add({ name: 'braid', translation: [0, 0, -0.1], children: [end, strand] });
  document.nodes[head].children = [...(document.nodes[head].children ?? []), braid];
  const scene = document.scenes[document.scene ?? 0];
  const isSkinned = (node) => document.nodes[node].skin !== undefined && !document.nodes[node].children; // placed by its joints
  const children = scene.nodes.filter((node) => !isSkinned(node)), turned = add({ name: 'turned', rotation: [0, 1, 0, 0], children });
  scene.nodes = [turned, ...scene.nodes.filter(isSkinned)];
  for (const primitive of document.meshes[0].primitives) primitive.targets = [{ POSITION: primitive.attributes.POSITION }];
  delete document.meshes[0].weights;
  delete document.animations;
  document.extensionsUsed = ['VRM'];
  document.extensions = {
    VRM: {
      specVersion: '0.0',
      meta: { title: 'Old', author: 'Somebody', allowedUserName: 'Everyone', violentUssageName: 'Disallow', sexualUssageName: 'Disallow',
        commercialUssageName: 'Allow', licenseName: 'CC_BY_NC', texture: -1 },
      humanoid: { humanBones: Object.entries(humanBones).map(([bone, { node }]) => ({ bone: oldName(bone), node })) },
      firstPerson: { firstPersonBone: head, firstPersonBoneOffset: vector(0.01, 0.07, 0.05), meshAnnotations: [], lookAtTypeName: 'Bone',
        ...Object.fromEntries(['HorizontalInner', 'HorizontalOuter', 'VerticalDown', 'VerticalUp'].map((each, i) =>
          [`lookAt${each}`, { curve: [0, 0, 0, 1, 1, 1, 1, 0], xRange: 60 + i, yRange: 6 + i }])) },
      blendShapeMaster: { blendShapeGroups: [{ name: 'Joy', presetName: 'joy', binds: [{ mesh: 0, index: 0, weight: 40 }], materialValues: [] }] },
      secondaryAnimation: {
        boneGroups: [{ comment: 'hair', stiffiness: 0.6, gravityPower: 0.3, gravityDir: vector(0, -1, 0), dragForce: 0.35, center: -1,
          hitRadius: 0.02, bones: [braid], colliderGroups: [0] }],
        colliderGroups: [{ node: head, colliders: [{ offset: vector(0.02, 0.03, 0.04), radius: 0.1 }] }],
      },
      materialProperties: [],
    },
  };
  return glbOf(document, rest);
}

async function loadVrm(path) {
  const { userData } = await loadInThree(path, [(parser) => new VRMLoaderPlugin(parser)]);
  return userData.vrm;
}

function vertices(vrm) {
  const found = [];
  vrm.scene.updateMatrixWorld(true);
  vrm.scene.traverse((object) => {
    if (!object.isMesh) return;
    if (object.isSkinnedMesh) object.skeleton.update();
    const { count } = object.geometry.attributes.position;
    for (let i = 0; i < count; ++i) found.push(object.getVertexPosition(i, new Vector3()).applyMatrix4(object.matrixWorld));
  });
  return found;
}

const place = (object) => object.getWorldPosition(new Vector3());
const springsOf = ({ springBoneManager }) => [...springBoneManager.joints].map(({ bone, settings, colliderGroups }) =>
  ({ bone: bone.name, ...settings, gravityDir: settings.gravityDir.toArray(), colliders: colliderGroups.flatMap((group) => group.colliders).length }))
  .sort((a, b) => (a.bone < b.bone ? -1 : 1));

const [limber, folder, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node tests/three_vrm0.mjs LIMBER OUTPUT_FOLDER FILE.glb...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const convert = (...words) => execFileSync(limber, ['convert', ...words, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
let passed = 0, failed = 0;

for (const file of files) {
  const stem = basename(file).replace(/\.\w+$/, ''), at = (ending) => join(folder, stem + ending);
  const check = (what, good) => {
    good ? ++passed : ++failed;
    if (!good) console.log(`${stem}: ${what}`);
  };
  const equal = (what, a, b) => check(`${what}: ${JSON.stringify(a)} is ${JSON.stringify(b)}`, JSON.stringify(a) === JSON.stringify(b));
  try {
    convert(file, at('_first.vrm'));
    for (const ending of ['_first.vrm', '_new.vrm']) writeFileSync(`${at(ending)}.source`, resolve(file)); // for tools/validate.mjs
    writeFileSync(at('_old.vrm0'), asVrm0(at('_first.vrm')));
    convert(at('_old.vrm0'), at('_new.vrm'));
    const before = await loadVrm(at('_old.vrm0')), after = await loadVrm(at('_new.vrm'));
    equal('version', [before.meta.metaVersion, after.meta.metaVersion], ['0', '1']);
    equal('bones', Object.keys(before.humanoid.humanBones).sort(), Object.keys(after.humanoid.humanBones).sort());
    const apart = () => {
      const a = vertices(before), b = vertices(after);
      const size = Math.max(...a.map((each) => each.length()));
      return a.length !== b.length ? Infinity : a.reduce((most, each, i) => Math.max(most, each.clone().applyQuaternion(halfRound).distanceTo(b[i])), 0) / size;
    };
    check('vertices at rest', apart() < kTolerance);

    for (const vrm of [before, after]) {
      vrm.expressionManager.setValue('happy', 0.5);
      vrm.expressionManager.update();
    }
    equal('weight of the shape', after.expressionManager.getExpression('happy').binds.length, before.expressionManager.getExpression('happy').binds.length);
    check('vertices with an expression', apart() < kTolerance);

    const model = await loadInThree(file);
    if (model.animations.length > 0) {
      convert(file, at('.vrma'), ...(model.parser.json.animations[0].name ? ['--clip', model.parser.json.animations[0].name] : []));
      const motion = (await loadInThree(at('.vrma'), [(parser) => new VRMAnimationLoaderPlugin(parser)])).userData.vrmAnimations[0];
      for (const vrm of [before, after]) {
        const mixer = new AnimationMixer(vrm.scene);
        mixer.clipAction(createVRMAnimationClip(motion, vrm)).play();
        mixer.setTime(motion.duration / 3);
        vrm.humanoid.update();
      }
      check('vertices in motion', apart() < kTolerance);
    }

    equal('springs', springsOf(after), springsOf(before));
    const [old, now] = [before, after].map((vrm) => place([...vrm.springBoneManager.colliders][0]));
    check('collider', old.applyQuaternion(halfRound).distanceTo(now) < kTolerance);
    const rounded = (v) => v.toArray().map((each) => Math.round(1e5 * each) / 1e5 + 0);
    equal('origin of gaze', rounded(after.lookAt.offsetFromHeadBone), rounded(before.lookAt.offsetFromHeadBone));
    for (const map of ['rangeMapHorizontalInner', 'rangeMapHorizontalOuter', 'rangeMapVerticalDown', 'rangeMapVerticalUp']) {
      equal(map, { ...after.lookAt.applier[map] }, { ...before.lookAt.applier[map] });
    }
    const { meta } = after;
    equal('meta', [meta.name, meta.authors, meta.avatarPermission, meta.allowExcessivelyViolentUsage, meta.commercialUsage, meta.allowRedistribution],
      ['Old', ['Somebody'], 'everyone', false, 'personalNonProfit', false]);
  } catch (error) {
    ++failed;
    console.log(`${stem}: ${(error.stderr ?? error.stack).toString().trim()}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
