// The engine's code, from beside this file.
const engine = new URL('./limber_engine.wasm', import.meta.url);

export async function engineCode() {
  if (engine.protocol === 'file:') return (await import('node:fs/promises')).readFile(engine); // Node's fetch reads no files
  const answer = await fetch(engine);
  if (!answer.ok) throw new Error(`limber: ${engine} cannot be fetched (${answer.status}); hand its bytes over: wasmBinary`);
  return new Uint8Array(await answer.arrayBuffer());
}
