// A file whose rig another model is to get, as the engine reads it. Loaded when the first one is chosen.
import { zipSync } from 'three/examples/jsm/libs/fflate.module.js';
import { unpack } from './files';

/** Arrays in an archive, compressed or not, as they are: the engine does not unpack them. */
const stored = (archive: Uint8Array, name: string) => zipSync(Object.fromEntries(unpack(archive, name)), { level: 0 });

export async function rigFile(file: File): Promise<{ bytes: Uint8Array; name: string }> {
  const { name } = file, bytes = new Uint8Array(await file.arrayBuffer());
  if (/\.npz$/i.test(name)) return { bytes: stored(bytes, name), name };
  if (/\.(glb|gltf)$/i.test(name)) return { bytes, name };
  const { toGlb } = await import('./import_model');
  return { bytes: await toGlb(bytes, name, new Map()), name };
}
