// What a USDZ holds, as three.js reads it.
import { USDLoader } from 'three/examples/jsm/loaders/USDLoader.js';

// What three.js makes of pictures, which only a browser reads: elements that never load.
globalThis.document ??= { createElementNS: () => ({ addEventListener() {}, removeEventListener() {} }) };

/** The points of all meshes in the world, [x, y, z] each; how many meshes have bones, and how many clips there are. */
export function readUsd(bytes) {
  const root = new USDLoader().parse(Uint8Array.from(bytes).buffer), points = [];
  let skinned = 0;
  root.updateMatrixWorld(true);
  root.traverse((part) => {
    if (!part.isMesh) return;
    skinned += part.isSkinnedMesh ? 1 : 0;
    const { position } = part.geometry.attributes;
    for (let v = 0; v < position.count; ++v) points.push(part.position.clone().fromBufferAttribute(position, v).applyMatrix4(part.matrixWorld).toArray());
  });
  return { points, skinned, clips: (root.animations ?? []).length };
}
