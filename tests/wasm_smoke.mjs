// The WebAssembly engine in Node against the native program: the same model and options must give the same bytes, and
// the same commands on a session the same pose.
//
//   node tests/wasm_smoke.mjs WASM_BUILD_FOLDER NATIVE_PROGRAM MODEL.glb OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [wasmFolder, program, model, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const { loadLimber } = await import(pathToFileURL(join(wasmFolder, 'limber.mjs')));
const part = (name) => readFileSync(join(wasmFolder, `limber_engine${name}.wasm`));
const shapes = readFileSync(new URL('../limber/reading/data/shapes.lrd', import.meta.url));
let restAsked = 0, shapesAsked = 0;
// In two parts, as the page has it.
const limber = await loadLimber(part('_first'), {
  rest: () => { ++restAsked; return part('_rest'); }, shapeWeights: () => { ++shapesAsked; return shapes; },
});
const bytes = new Uint8Array(readFileSync(model));

function nativeRig(handles) {
  const path = join(output, `native_${handles}.glb`);
  execFileSync(program, ['rig', model, '--handles', String(handles), '-o', path, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  return new Uint8Array(readFileSync(path));
}

const cases = {};
for (const handles of [6, 20, 50]) {
  cases[`${handles} handles: the native program's bytes`] = () => {
    const result = limber.rig(bytes, 'model.glb', { handles });
    assert.ok(result.ok, result.error?.message);
    const path = join(output, `wasm_${handles}.glb`);
    writeFileSync(path, result.glb);
    writeFileSync(`${path}.source`, model);
    const { joints } = result.report.counts;
    assert.ok([handles, handles + 1].includes(joints), `${joints} joints`);
    assert.equal(result.report.methods.rigger, 'sphere-mesh');
    assert.deepEqual(Buffer.compare(result.glb, nativeRig(handles)), 0, 'the bytes differ');
    assert.equal(shapesAsked, 0);
  };
}
cases['a person in mid-stride: the native program\'s bytes'] = () => {
  const at = (name) => join(output, name);
  const native = (...args) => execFileSync(program, [...args, '--quiet'], { stdio: ['ignore', 'ignore', 'ignore'] });
  native('sample', 'biped', '-o', at('person.glb'));
  native('sample', 'walk', '-o', at('walk.bvh'));
  native('animate', at('person.glb'), at('walk.bvh'), '-o', at('walking.glb'));
  native('pose', at('walking.glb'), '--time', '0.8', '--bake', '-o', at('stride.glb'));
  native('rig', at('stride.glb'), '--rigger', 'template', '-o', at('stride_native.glb'));
  const result = limber.rig(new Uint8Array(readFileSync(at('stride.glb'))), 'stride.glb', { rigger: 'template' });
  assert.ok(result.ok, result.error?.message);
  assert.equal(Buffer.compare(result.glb, readFileSync(at('stride_native.glb'))), 0, 'the bytes differ');
  assert.ok(limber.rig(bytes, 'model.glb', { template: 'auto' }).ok);
  assert.equal(shapesAsked, 1);
};
cases['a template without the networks that read shapes is an error value, until they are given'] = async () => {
  const bare = await loadLimber(part('')), options = { template: 'humanoid' };
  const { ok, error } = bare.rig(bytes, 'model.glb', options);
  assert.deepEqual([ok, error.code], [false, 'unsupported']);
  assert.match(error.remedy, /setShapeWeights/);
  const session = bare.createSession();
  assert.ok(session.run({ do: 'open_sample', name: 'biped' }).ok);
  assert.match(session.rigCheck().error.remedy, /setShapeWeights/);
  const cut = bare.setShapeWeights(shapes.subarray(0, 1000), 'cut.lrd');
  assert.deepEqual([cut.ok, cut.error.code], [false, 'bad-data']);
  assert.match(cut.error.where, /^cut\.lrd/);
  assert.ok(bare.setShapeWeights(shapes).ok && bare.rig(bytes, 'model.glb', options).ok && session.rigCheck().ok);
  const offline = new Error('offline'), cutOff = await loadLimber(part(''), { shapeWeights: () => { throw offline; } });
  assert.throws(() => cutOff.rig(bytes, 'model.glb', options), (thrown) => thrown === offline);
  assert.ok(cutOff.rig(bytes, 'model.glb', { handles: 6 }).ok);
};
cases['the whole engine: the bytes of the one in two parts, whose rest was asked for once'] = async () => {
  const whole = await loadLimber(part('')), options = { handles: 12 };
  assert.equal(Buffer.compare(whole.rig(bytes, 'model.glb', options).glb, limber.rig(bytes, 'model.glb', options).glb), 0, 'the bytes differ');
  assert.equal(restAsked, 1);
};
cases['a damaged file is an error value'] = () => {
  const { ok, error } = limber.rig(bytes.slice(0, bytes.length / 2), 'half.glb');
  assert.equal(ok, false);
  assert.match(error.where, /half\.glb/);
  assert.notEqual(error.message, '');
};
cases['an unknown option is an error value'] = () => {
  const { ok, error } = limber.rig(bytes, 'model.glb', { handle: 20 });
  assert.equal(ok, false);
  assert.equal(error.where, 'handle');
};
cases['a count too large for the engine is an error value'] = () => {
  for (const option of ['handles', 'maxInfluences']) {
    const { ok, error } = limber.rig(bytes, 'model.glb', { [option]: 2 ** 32 + 4 });  // 4, if it wrapped round
    assert.equal(ok, false);
    assert.equal(error.where, option);
  }
};
cases['the engine goes on after errors'] = () => {
  assert.ok(limber.rig(bytes, 'model.glb', { handles: 6 }).ok);
};

// The nodes of a GLB, each as one list of numbers.
function nodesOf(glb) {
  const buffer = Buffer.from(glb);
  const { nodes } = JSON.parse(buffer.subarray(20, 20 + buffer.readUInt32LE(12)).toString());
  return nodes.map((node) => ({
    name: node.name, numbers: [...(node.translation ?? [0, 0, 0]), ...(node.rotation ?? [0, 0, 0, 1]), ...(node.scale ?? [1, 1, 1])],
  }));
}

const session = limber.createSession();
const run = (command) => {
  const result = session.run(command);
  assert.ok(result.ok, `${command.do}: ${result.error?.message}`);
  return result;
};

cases['a session: the pose that the native program makes of its record'] = () => {
  assert.ok(session.open(bytes, 'model.glb').ok);
  const { joints } = run({ do: 'set_handles', count: 20 }).state;
  const tip = joints.findLast((joint) => joint.parent > 0);
  run({ do: 'set_ik', on: true });
  const [x, y] = tip.rest, view = [0, 0, -1];
  run({ do: 'begin_drag', joint: tip.name, ray: { origin: [x, y, 9], direction: view }, view });
  const started = performance.now(), updates = 200;
  for (let i = 1; i <= updates; ++i) {
    const { skin } = run({ do: 'update_drag', ray: { origin: [x + 0.001 * i, y + 0.0005 * i, 9], direction: view }, view });
    assert.equal(skin.length, 16 * joints.length);
  }
  console.log(`a drag's update: ${((performance.now() - started) / updates).toFixed(3)} ms at ${joints.length} joints`);
  run({ do: 'end_drag' });
  run({ do: 'set_turn', joint: joints[1].name, turn: [0, 22.3607, 11.1803], relative: true });
  run({ do: 'set_turn', joint: joints[1].name, turn: [10, -20, 30], with: [joints[2].name] });
  session.turns().turns.slice(7, 10).forEach((value, i) => assert.ok(Math.abs(value - [10, -20, 30][i]) < 1e-4));
  run({ do: 'set_scale', joint: joints[2].name, scale: 1.25 });
  assert.deepEqual([...session.scales().scales], joints.map((_, joint) => (joint === 2 ? 1.25 : 1)));
  run({ do: 'place_joint', joint: tip.name, position: [x + 0.1, y + 0.1, 0] });
  run({ do: 'set_handles', count: 30 });
  run({ do: 'mirror_pose', from: 'left' });
  const glb = session.export('glb').bytes;
  writeFileSync(join(output, 'session.glb'), glb);
  writeFileSync(join(output, 'model.glb'), bytes);
  writeFileSync(join(output, 'commands.json'), JSON.stringify(session.record()));
  const path = join(output, 'session_native.glb');
  execFileSync(program, ['session', 'replay', join(output, 'commands.json'), '-o', path, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  const here = nodesOf(glb), there = nodesOf(readFileSync(path));
  assert.equal(here.length, there.length);
  here.forEach(({ name, numbers }, n) => {
    assert.equal(name, there[n].name);
    numbers.forEach((value, i) => assert.ok(Math.abs(value - there[n].numbers[i]) < 1e-5, `${name}: ${value}, ${there[n].numbers[i]}`));
  });
};
const verticesOf = (obj) => [...Buffer.from(obj).toString().matchAll(/^v (\S+) (\S+) (\S+)$/gm)].flatMap(([, ...xyz]) => xyz.map(Number));
const farthest = (a, b) => a.reduce((most, value, i) => Math.max(most, Math.abs(value - b[i])), 0);

/** A rotation's quaternion, of the matrix of 16 numbers there: by its largest component. */
function quaternionAt(skin, joint) {
  const m = (row, column) => skin[16 * joint + 4 * column + row];
  const squares = [[1, -1, -1], [-1, 1, -1], [-1, -1, 1], [1, 1, 1]].map((s) => 1 + s[0] * m(0, 0) + s[1] * m(1, 1) + s[2] * m(2, 2));
  const r = Math.sqrt(Math.max(...squares));
  const [xy, xz, yz, xw, yw, zw] = [
    m(0, 1) + m(1, 0), m(0, 2) + m(2, 0), m(1, 2) + m(2, 1), m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1),
  ].map((value) => value / r / 2);
  return [[r / 2, xy, xz, xw], [xy, r / 2, yz, yw], [xz, yz, r / 2, zw], [xw, yw, zw, r / 2]][squares.indexOf(Math.max(...squares))];
}

/** What the rows make of rigid joints: v' = p + sum of (M - I) m + R (v - p). */
function byRows({ positions, deformation: { places, ranges, entries } }, skin) {
  return Array.from({ length: positions.length / 3 }, (_, v) => {
    const place = [...places.slice(3 * v, 3 * v + 3)], arm = place.map((p, i) => positions[3 * v + i] - p), turn = [0, 0, 0, 0];
    let pivot = null;
    for (let entry = ranges[2 * v]; entry < ranges[2 * v] + ranges[2 * v + 1]; ++entry) {
      for (let i = 0; i < 4; ++i) {
        const [joint, ...moment] = [0, 1, 2, 3, 4].map((k) => entries[20 * entry + 4 * k + i]), quaternion = quaternionAt(skin, joint);
        pivot ??= quaternion;
        const sign = quaternion.reduce((sum, value, k) => sum + value * pivot[k], 0) < 0 ? -1 : 1;
        for (let k = 0; k < 4; ++k) turn[k] += sign * moment[3] * quaternion[k];
        for (let row = 0; row < 3; ++row) {
          for (let column = 0; column < 4; ++column) place[row] += (skin[16 * joint + 4 * column + row] - (row === column)) * moment[column];
        }
      }
    }
    const [x, y, z, w] = turn, scale = pivot ? 2 / (x * x + y * y + z * z + w * w) : 0;
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const inner = cross([x, y, z], arm).map((value, i) => value + w * arm[i]), outer = cross([x, y, z], inner);
    return place.map((p, i) => p + arm[i] + scale * outer[i]);
  }).flat();
}

cases['a session: every deformer bends what is drawn and exported as the native program does'] = () => {
  const { joints } = session.run({ do: 'reset_pose' }).state;
  run({ do: 'set_ik', on: false });
  for (const j of [3, 8, 14, 20]) run({ do: 'set_turn', joint: joints[j].name, turn: [41.5029, 12.4509, 41.5029], relative: true });
  const linear = verticesOf(session.export('obj').bytes), { positions } = session.model().model;
  assert.equal(linear.length, positions.length);
  const forms = {};
  for (const { name } of limber.methods().deformer) {
    const started = performance.now();
    assert.equal(run({ do: 'set_deformer', deformer: name }).state.deformer, name);
    const { model } = session.model(), { skin } = session.skin(), took = performance.now() - started;
    const bent = verticesOf(session.export('obj').bytes), { posed } = session.posed();
    forms[name] = model.deformation.form;
    if (name !== 'linear-blend') assert.ok(farthest(bent, linear) > 1e-3, `${name} bends as linear blend does`);
    assert.equal(posed.length, forms[name] === 'engine' ? 2 * positions.length : 0, name);
    if (forms[name] === 'engine') {
      assert.ok(farthest([...posed.subarray(0, positions.length)], bent) < 1e-5, name);
      for (let v = positions.length; v < posed.length; v += 3) assert.ok(Math.abs(Math.hypot(posed[v], posed[v + 1], posed[v + 2]) - 1) < 1e-3, name);
    }
    if (forms[name] === 'rows') assert.ok(farthest(byRows(model, skin), bent) < 1e-5, `${name}: ${farthest(byRows(model, skin), bent)}`);
    writeFileSync(join(output, 'bent.json'), JSON.stringify(session.record()));
    const path = join(output, 'bent.obj');
    execFileSync(program, ['session', 'replay', join(output, 'bent.json'), '-o', path, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
    const there = verticesOf(readFileSync(path));
    assert.equal(there.length, bent.length);
    assert.ok(farthest(bent, there) < 1e-5, `${name}: ${farthest(bent, there)}`);
    console.log(`${name}: drawn by ${forms[name]}, ready after ${took.toFixed(0)} ms`);
  }
  assert.deepEqual(forms, {
    'linear-blend': 'weights', 'dual-quaternion': 'engine', 'centers-of-rotation': 'rows', 'delta-mush': 'engine', 'direct-delta-mush': 'rows',
  });
  run({ do: 'set_deformer' });
};
cases['a session: an error is a value and changes nothing'] = () => {
  const before = session.export('session').bytes;
  for (const command of [{ do: 'fly' }, { do: 'reset_joint', joint: 'none' }, { do: 'set_handles', count: 0 }, { do: 'end_drag' }]) {
    const { ok, error } = session.run(command);
    assert.equal(ok, false);
    assert.notEqual(error.message, '');
  }
  assert.equal(session.open(bytes.slice(0, 100), 'cut.glb').ok, false);
  assert.equal(Buffer.compare(session.export('session').bytes, before), 0);
};
cases['a session: surface, picking and a saved session'] = () => {
  const { model } = session.model(), { handles } = session.handles();
  assert.equal(model.weights.length / 4, model.positions.length / 3);
  assert.ok(model.triangles.every((v) => v < model.positions.length / 3));
  assert.ok(model.joints.every((joint) => joint < handles.length / 4));
  const [x, y] = handles;
  assert.equal(session.pick({ origin: [x, y, 9], direction: [0, 0, -1] }, 0).hit.on_handle, true);
  assert.equal(session.pick({ origin: [99, 99, 9], direction: [0, 0, -1] }, 0).hit, null);
  const again = limber.createSession();
  assert.ok(again.open(session.export('session').bytes, 'model.glb').ok);
  assert.equal(Buffer.compare(again.export('glb').bytes, session.export('glb').bytes), 0);
  again.free();
};
cases['a session: whether the model can be rigged, before any work'] = () => {
  const asked = limber.createSession();
  assert.equal(asked.rigCheck().ok, false); // nothing is open
  const checked = (name) => {
    assert.ok(asked.run({ do: 'open_sample', name }).ok);
    const record = asked.record(), { ok, check, error } = asked.rigCheck();
    assert.ok(ok, error?.message);
    assert.deepEqual(asked.record(), record);
    return check;
  };
  const kinds = ({ advice }) => advice.map(({ kind }) => kind);
  const person = checked('biped');
  assert.match(person.kinds[0].name, /^humanoid/);
  assert.ok(person.kinds[0].confidence > 0.9 && person.sure && person.upright && !person.has_rig);
  assert.deepEqual([person.pose, person.missing, person.grown_together], ['A', [], []]);
  assert.ok(kinds(person).every((kind) => kind === 'doubtful-joints'), kinds(person).join());
  const stool = checked('stool');
  assert.deepEqual([stool.pose, kinds(stool)], [null, ['no-template']]);
  assert.match(stool.advice[0].message, /template: '[\w-]+'/); // as its own calls name options
  const flying = checked('flying');
  assert.deepEqual([flying.has_rig, kinds(flying)[0]], [true, 'has-rig']);
  asked.free();
};
cases['a scene: several models in one file, as the native program writes it'] = () => {
  const scene = limber.createSession();
  const act = (command) => {
    const result = scene.run(command);
    assert.ok(result.ok, `${command.do}: ${result.error?.message}`);
    return result.state;
  };
  act({ do: 'open_sample', name: 'robot' });
  assert.ok(scene.add(bytes, 'model.glb').ok);
  const { members } = act({ do: 'add_sample', name: 'stool', as_prop: true });
  assert.deepEqual(members.map(({ name }) => name), ['robot', 'model', 'stool']);
  assert.equal(members[2].joints.length, 1);
  const hand = members[0].joints.find(({ part }) => part === 'left hand') ?? members[0].joints.at(-1);
  act({ do: 'attach_member', member: 'stool', to: 'robot', joint: hand.name, snap: true });
  act({ do: 'choose_member', member: 'robot' });
  act({ do: 'set_turn', joint: hand.name, turn: [0, 0, 40], relative: true });
  act({ do: 'place_member', member: 'model', position: [-2, 0, 1], turn: [0, 45, 0], scale: 0.5 });
  assert.equal(scene.places().places.length, 48);
  assert.equal(scene.memberSkin(2).skin.length, 16);
  assert.equal(scene.pickMember({ origin: [99, 99, 9], direction: [0, 0, -1] }).hit, null);
  const glb = scene.export('glb').bytes;
  writeFileSync(join(output, 'scene.glb'), glb);
  writeFileSync(join(output, 'scene.json'), JSON.stringify(scene.record()));
  const path = join(output, 'scene_native.glb');
  execFileSync(program, ['session', 'replay', join(output, 'scene.json'), '-o', path, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  const here = nodesOf(glb), there = nodesOf(readFileSync(path));
  assert.deepEqual(here.map(({ name }) => name), there.map(({ name }) => name));
  here.forEach(({ name, numbers }, n) =>
    numbers.forEach((value, i) => assert.ok(Math.abs(value - there[n].numbers[i]) < 1e-5, `${name}: ${value}, ${there[n].numbers[i]}`)));
  scene.free();
};

/** What the native program makes of a session's record, whose files are in the output folder. */
function replayed(own, name) {
  const record = join(output, `${name}.json`), path = join(output, `${name}_native.glb`);
  writeFileSync(record, JSON.stringify(own.record()));
  execFileSync(program, ['session', 'replay', record, '-o', path, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  return readFileSync(path);
}
cases['the rig of another model: the native program\'s bytes'] = () => {
  const at = (name) => join(output, name);
  execFileSync(program, ['sample', 'biped', '-o', at('bare.glb'), '--quiet']);
  execFileSync(program, ['rig', at('bare.glb'), '--rigger', 'template', '-o', at('hero.glb'), '--quiet'], { stdio: 'ignore' });
  const own = limber.createSession(), hero = new Uint8Array(readFileSync(at('hero.glb')));
  assert.ok(own.open(new Uint8Array(readFileSync(at('bare.glb'))), 'bare.glb').ok);
  const plain = own.transferRig(bytes, 'model.glb');
  assert.equal(plain.error?.kind, 'no-rig');
  const taken = own.transferRig(hero, 'hero.glb');
  assert.ok(taken.ok, taken.error?.message);
  assert.ok(taken.state.joints.some(({ name }) => name === 'leftHand') && taken.state.own_rig);
  assert.ok(taken.state.gaps.rms < 0.5);
  assert.equal(Buffer.compare(own.export('glb').bytes, replayed(own, 'taken')), 0, 'the bytes differ');
  own.free();
};
cases['bones of an animation: the native program\'s bytes'] = () => {
  const path = join(output, 'flying.glb'), own = limber.createSession();
  execFileSync(program, ['sample', 'flying', '-o', path, '--quiet']);
  assert.ok(own.open(new Uint8Array(readFileSync(path)), 'flying.glb').ok);
  const found = own.run({ do: 'rig_from_animation', bones: 6 });
  assert.ok(found.ok, found.error?.message);
  assert.equal(found.state.joints.length, 6);
  assert.equal(Buffer.compare(own.export('glb').bytes, replayed(own, 'flapping')), 0, 'the bytes differ');
  own.free();
};

let passed = 0, failed = 0;
for (const [name, run] of Object.entries(cases)) {
  try {
    await run();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
