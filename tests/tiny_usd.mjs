// tinyusdz, a strict reader of USD, in Node.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

// Its loader looks for a browser's window or worker, and its package for a page to fetch the engine from.
async function loadEngine() {
  const { window, process: { type } } = globalThis;
  Object.assign(globalThis, { window: globalThis });
  process.type = 'renderer';
  try {
    const { default: init } = await import('tinyusdz/tinyusdz.js');
    const bytes = readFileSync(fileURLToPath(import.meta.resolve('tinyusdz/tinyusdz.wasm')));
    return await init({
      instantiateWasm(imports, done) {
        WebAssembly.instantiate(bytes, imports).then(({ instance }) => done(instance));
        return {};
      },
    });
  } finally {
    globalThis.window = window;
    process.type = type;
  }
}

let engine;

/** What tinyusdz makes of a file: its meshes and materials, as it would draw them. Throws where it refuses the file. */
export async function readStrictly(path) {
  engine ??= await loadEngine();
  const loader = new engine.TinyUSDZLoaderNative();
  try {
    if (!loader.loadFromBinary(readFileSync(path), path)) throw new Error(`tinyusdz: ${loader.error()}`);
    const meshes = Array.from({ length: loader.numMeshes() }, (_, i) => {
      const { primName, points, faceVertexIndices, materialId } = loader.getMesh(i);
      return { name: primName, points: Float32Array.from(points), corners: Uint32Array.from(faceVertexIndices), materialId };
    });
    const count = Math.max(-1, ...meshes.map(({ materialId }) => materialId)) + 1;
    return { meshes, materials: Array.from({ length: count }, (_, i) => loader.getMaterial(i)) };
  } finally {
    loader.delete();
  }
}
