// The WebAssembly engine in Node against the native program: the same model and options must give the same bytes.
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
const limber = await loadLimber(readFileSync(join(wasmFolder, 'limber_engine.wasm')));
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
  };
}
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

let passed = 0, failed = 0;
for (const [name, run] of Object.entries(cases)) {
  try {
    run();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error.message}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
