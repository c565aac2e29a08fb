// GLBs in three.js, in Node.
import { readFileSync } from 'node:fs';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

// A GLB without its materials, whose pictures only a browser can read.
function withoutMaterials(bytes) {
  const length = bytes.readUInt32LE(12);
  const document = JSON.parse(bytes.subarray(20, 20 + length));
  for (const part of ['images', 'textures', 'materials']) delete document[part];
  for (const mesh of document.meshes ?? []) mesh.primitives.forEach((primitive) => delete primitive.material);
  const text = Buffer.from(JSON.stringify(document).padEnd(length)); // no longer than it was
  return Buffer.concat([bytes.subarray(0, 20), text, bytes.subarray(20 + length)]);
}

/** What GLTFLoader makes of a file: { scene, animations, parser, ... }; `plugins` are those of its extensions. */
export async function loadInThree(path, plugins = []) {
  const bytes = withoutMaterials(readFileSync(path));
  const loader = new GLTFLoader();
  for (const plugin of plugins) loader.register(plugin);
  return loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
}

/** { root, clips, names }: a model with the clips' names as the file has them, for three.js names those that have none. */
export async function loadGlb(path) {
  const { scene, animations, parser } = await loadInThree(path);
  return { root: scene, clips: animations, names: (parser.json.animations ?? []).map(({ name }) => name) };
}
