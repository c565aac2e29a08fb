// Splits the built engine in two: what a page needs until its first pose, and the rest. Which functions those are is seen,
// not listed: an instrumented engine is taken through a page's first minute, and notes what it calls.
//
//   node bindings/wasm/split_engine.mjs BUILD_FOLDER
//
// Writes limber_engine_first.wasm and limber_engine_rest.wasm beside limber_engine.wasm. The whole engine is made the same
// again by loadLimber(first, { rest }).
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const folder = resolve(process.argv[2]), at = (name) => join(folder, name);
const whole = at('limber_engine.wasm'), instrumented = at('limber_engine_instrumented.wasm'), profile = at('limber_engine.profile');
const features = ['exception-handling', 'bulk-memory', 'sign-ext', 'mutable-globals', 'nontrapping-float-to-int']
  .map((name) => `--enable-${name}`);
const wasmSplit = (...args) => execFileSync('wasm-split', [...features, ...args], { stdio: ['ignore', 'inherit', 'inherit'] });

/** What a page asks for until something has been posed, kept and taken back. */
function firstMinute(limber) {
  const session = limber.createSession();
  const shown = () => {
    for (const what of ['model', 'skin', 'handles', 'turns', 'scales', 'places', 'sourceJoints', 'weights', 'posed']) assert.ok(session[what]().ok, what);
  };
  const run = (command) => {
    const step = session.run(command);
    assert.ok(step.ok, `${command.do}: ${step.error?.message}`);
    return step.state;
  };
  const drag = ({ joints, box }, on) => {
    run({ do: 'set_ik', on });
    const [x, y] = joints.at(-1).rest, view = [0, 0, -1];
    const ray = (i) => ({ origin: [x + 0.01 * i, y + 0.005 * i, box.max[2] + 5], direction: view });
    run({ do: 'begin_drag', joint: joints.at(-1).name, ray: ray(0), view });
    for (const i of [1, 2]) session.run({ do: 'update_drag', ray: ray(i), view });
    run({ do: 'end_drag' });
    shown();
    run({ do: 'undo' });
    run({ do: 'redo' });
  };
  limber.methods();
  limber.sampleMotions();
  limber.samplePoses();
  let state = run({ do: 'open_sample', name: 'biped', limbs_follow: true });
  shown();
  const ray = { origin: [0, state.box.max[1] / 2, 10], direction: [0, 0, -1] };
  assert.ok(session.pick(ray, 0.01).ok && session.pickMember(ray).ok && session.surface(ray).ok);
  drag(state, true);
  drag(state, false);
  state = run({ do: 'set_handles', count: 20 });
  shown();
  session.record();
  assert.ok(session.export('glb').ok);
}

async function writeProfile() {
  const { loadLimber } = await import(pathToFileURL(at('limber.mjs')));
  let exports = null;
  firstMinute(await loadLimber(new WebAssembly.Module(readFileSync(instrumented)), { onInstance: (made) => { exports = made.exports; } }));
  const memory = Object.values(exports).find((one) => one instanceof WebAssembly.Memory);
  const room = 1 << 20; // bytes; a profile has four for each function, and a few
  const start = memory.grow(room / 65536) * 65536;
  const size = exports.__write_profile(start, room);
  assert.ok(size <= room, `the profile takes ${size} bytes`);
  writeFileSync(profile, new Uint8Array(memory.buffer, start, size));
}

wasmSplit('--instrument', whole, '-o', instrumented);
await writeProfile();
wasmSplit('--split', `--profile=${profile}`, whole, '-o1', at('limber_engine_first.wasm'), '-o2', at('limber_engine_rest.wasm'));
for (const file of [instrumented, profile]) rmSync(file);
