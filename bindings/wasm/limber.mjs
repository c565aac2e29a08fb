// The engine as WebAssembly, for a page, a worker or Node.
//
//   const limber = await loadLimber(wasmBytes);
//   const result = limber.rig(glbBytes, 'dragon.glb', { handles: 20 });
//   if (result.ok) save(result.glb, result.report); else tell(result.error.message);
import createEngine from './limber_engine.mjs';

/**
 * @typedef {{ handles?: number, maxInfluences?: number, rigger?: string, skinning?: string,
 *             existingRig?: 'refuse' | 'replace' | 'keep-skeleton' }} RigOptions
 * @typedef {{ code: string, message: string, where: string, remedy: string }} LimberError
 * The report is the one of docs/report.md, from "methods" on.
 * @typedef {{ ok: true, glb: Uint8Array, report: object } | { ok: false, error: LimberError }} RigResult
 */

/**
 * @param {BufferSource} wasmBinary the content of limber_engine.wasm
 * @returns {Promise<{ rig(file: Uint8Array, name: string, options?: RigOptions): RigResult }>}
 */
export async function loadLimber(wasmBinary) {
  const engine = await createEngine({ wasmBinary });
  return { rig: (file, name, options = {}) => rig(engine, file, name, options) };
}

// Copies into the engine's memory. The views on it are taken anew each time: memory that grows replaces them.
function put(engine, bytes) {
  const at = engine._malloc(Math.max(bytes.length, 1));
  if (at === 0) throw new RangeError('the engine is out of memory');
  engine.HEAPU8.set(bytes, at);
  return at;
}

const copyOut = (engine, at, size) => engine.HEAPU8.slice(at, at + size);

function rig(engine, file, name, options) {
  const text = new TextEncoder();
  const inputs = [file, text.encode(name), text.encode(JSON.stringify(options))];
  const places = inputs.map((bytes) => put(engine, bytes));
  const call = engine._limber_rig(...inputs.flatMap((bytes, i) => [places[i], bytes.length]));
  places.forEach((at) => engine._free(at));
  if (call === 0) {
    return { ok: false, error: { code: 'limit', message: 'not enough memory', where: name, remedy: 'try a smaller model' } };
  }
  const account = JSON.parse(new TextDecoder().decode(
    copyOut(engine, engine._limber_account(call), engine._limber_account_size(call))));
  const result = engine._limber_ok(call)
    ? { ok: true, glb: copyOut(engine, engine._limber_glb(call), engine._limber_glb_size(call)), report: account }
    : { ok: false, error: account };
  engine._limber_free_result(call);
  return result;
}
