// The engine's code and the networks that read shapes, from beside this file.
const engine = new URL('./limber_engine.wasm', import.meta.url), shapes = new URL('./shapes.lrd', import.meta.url);
const isFile = ({ protocol }) => protocol === 'file:'; // Node's fetch reads no files

const unfetched = (url, status, remedy) => new Error(`limber: ${url} cannot be fetched (${status}); hand its bytes over: ${remedy}`);

export async function engineCode() {
  if (isFile(engine)) return (await import('node:fs/promises')).readFile(engine);
  const answer = await fetch(engine);
  if (!answer.ok) throw unfetched(engine, answer.status, 'wasmBinary');
  return new Uint8Array(await answer.arrayBuffer());
}

/** Gives a function that reads them at once: the engine cannot wait in the middle of a call. */
export async function shapesReader() {
  if (!isFile(shapes)) return fetchShapes;
  const { readFileSync } = await import('node:fs');
  return () => readFileSync(shapes);
}

function fetchShapes() {
  const request = new XMLHttpRequest();
  request.open('GET', shapes, false);
  request.overrideMimeType('text/plain; charset=x-user-defined'); // its bytes as characters: a page may ask for no others at once
  try {
    request.send();
  } catch {
    throw unfetched(shapes, 'no answer', 'setShapeWeights');
  }
  if (request.status !== 200) throw unfetched(shapes, request.status, 'setShapeWeights');
  return Uint8Array.from(request.responseText, (character) => character.charCodeAt(0) & 0xff);
}
