// The engine as WebAssembly against the native program, one thread each: rigging a model of about ten thousand
// vertices, and one step of a drag.
//
//   node tools/bench_web.mjs WASM_FOLDER NATIVE_PROGRAM WORK_FOLDER
//
// The least of several runs counts: what else the machine does only adds.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [wasm, program, work] = process.argv.slice(2).map((path) => resolve(path));
const runs = 5, steps = 500, handles = 20, sample = 'winged';
mkdirSync(work, { recursive: true });
const file = join(work, `${sample}.glb`), report = join(work, 'report.json');
execFileSync(program, ['sample', sample, '-o', file, '--quiet']);

const { loadLimber } = await import(pathToFileURL(join(wasm, 'limber.mjs')).href);
const limber = await loadLimber(readFileSync(join(wasm, 'limber_engine.wasm')));
const model = new Uint8Array(readFileSync(file));

const least = (values) => Math.min(...values);
const stagesOf = ({ stages }) => new Map(Object.entries(stages).map(([key, value]) => [value.name ?? key, value.seconds ?? value]));
function fastest(run) {
  const all = Array.from({ length: runs }, () => stagesOf(run()));
  return new Map([...all[0].keys()].map((name) => [name, 1000 * least(all.map((stages) => stages.get(name) ?? Infinity))]));
}

const native = fastest(() => {
  execFileSync(program, ['rig', file, '--handles', String(handles), '--threads', '1', '-o', join(work, 'out.glb'), '--json', report, '--quiet']);
  return JSON.parse(readFileSync(report));
});
let vertices = 0;
const web = fastest(() => {
  const result = limber.rig(model, `${sample}.glb`, { handles });
  if (!result.ok) throw new Error(result.error.message);
  vertices = result.report.input?.vertices ?? vertices;
  return result.report;
});

const session = limber.createSession();
session.run({ do: 'open_sample', name: sample });
const { state } = session.run({ do: 'set_handles', count: handles });
const joint = state.joints.at(-1);
const [x, y, z] = joint.rest, view = [0, 0, -1];
const ray = (by) => ({ origin: [x, y, z + 5], direction: [by, by / 2, -5] });
function dragStep(ik) {
  session.run({ do: 'set_ik', on: ik });
  session.run({ do: 'begin_drag', joint: joint.name, mode: 'move', ray: ray(0), view });
  const times = Array.from({ length: steps }, (_, i) => {
    const from = performance.now();
    session.run({ do: 'update_drag', ray: ray(0.0004 * i), view });
    session.handles();
    return performance.now() - from;
  }).sort((a, b) => a - b);
  session.run({ do: 'cancel_drag' });
  return `${times[steps / 2].toFixed(3)} ms (worst of twenty: ${times[Math.floor(0.95 * steps)].toFixed(3)})`;
}

console.log(`${state.vertices} vertices, ${state.joints.length} handles; milliseconds, the least of ${runs}`);
console.log('stage             native      WebAssembly  times');
let sums = [0, 0];
for (const [name, here] of native) {
  const there = web.get(name);
  if (there === undefined) continue;
  sums = [sums[0] + here, sums[1] + there];
  console.log(`${name.padEnd(16)}${here.toFixed(1).padStart(8)}${there.toFixed(1).padStart(17)}${(there / here).toFixed(2).padStart(7)}`);
}
console.log(`${'together'.padEnd(16)}${sums[0].toFixed(1).padStart(8)}${sums[1].toFixed(1).padStart(17)}${(sums[1] / sums[0]).toFixed(2).padStart(7)}`);
console.log(`a drag's step, WebAssembly: ${dragStep(false)}; with inverse kinematics ${dragStep(true)}`);
