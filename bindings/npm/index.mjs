// limber in Node and in pages: the engine, and where its code is.
import { engineCode, shapesReader } from './engine_code.mjs';
import { loadLimber } from './limber.mjs';

export async function load({ wasmBinary, ...settings } = {}) {
  return loadLimber(wasmBinary ?? await engineCode(), { shapeWeights: await shapesReader(), ...settings });
}
