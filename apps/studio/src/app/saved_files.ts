// How files that leave the page are called, and of what kind they are.
import type { PageState } from './state';

export const mediaTypes = {
  glb: 'model/gltf-binary', gltf: 'model/gltf+json', fbx: 'application/octet-stream', vrm: 'model/gltf-binary',
  usdz: 'model/vnd.usdz+zip', usda: 'model/vnd.usda', usdc: 'application/octet-stream', zip: 'application/zip',
  obj: 'model/obj', stl: 'model/stl', bvh: 'text/plain', session: 'model/gltf-binary',
};

/** Without an ending. */
export const stemOf = ({ session }: PageState) => ((session?.members.length ?? 0) > 1 ? 'scene' : (session?.name ?? 'model').replace(/\.[^.]*$/, ''));
