// limber in Node and in pages: the engine, and where its code is.
import { loadLimber } from './limber.mjs';

const engine = new URL('./limber_engine.wasm', import.meta.url);

async function engineBytes() {
  if (engine.protocol === 'file:') return (await import('node:fs/promises')).readFile(engine); // Node's fetch reads no files
  const answer = await fetch(engine);
  if (!answer.ok) throw new Error(`limber: ${engine} cannot be fetched (${answer.status}); hand its bytes over: load({ wasmBinary })`);
  return new Uint8Array(await answer.arrayBuffer());
}

export async function load({ wasmBinary } = {}) {
  return loadLimber(wasmBinary ?? await engineBytes());
}
