// Models in formats that the engine does not read in a browser, brought into GLB. Loaded when the first one is opened.
import { DirectionalLight, Mesh, MeshStandardMaterial, Object3D, Scene, type BufferGeometry } from 'three';
import { GLTFExporter } from 'three/examples/jsm/exporters/GLTFExporter.js';
import { FBXLoader } from 'three/examples/jsm/loaders/FBXLoader.js';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';
import { EngineError } from '../engine/client';

const fail = (name: string, message: string, remedy: string) =>
  new EngineError({ code: 'bad-data', message, where: name, remedy });

function meshOf(geometry: BufferGeometry): Object3D {
  if (!geometry.hasAttribute('normal')) geometry.computeVertexNormals();
  return new Mesh(geometry, new MeshStandardMaterial({ vertexColors: geometry.hasAttribute('color') }));
}

function parse(bytes: Uint8Array, name: string): Object3D {
  const buffer = bytes.slice().buffer;
  switch (name.split('.').pop()?.toLowerCase()) {
    case 'obj': return new OBJLoader().parse(new TextDecoder().decode(bytes));
    case 'fbx': return new FBXLoader().parse(buffer, '');
    case 'stl': return meshOf(new STLLoader().parse(buffer));
    case 'ply': return meshOf(new PLYLoader().parse(buffer));
    default: throw fail(name, 'a file of this kind cannot be opened', 'open GLB, glTF, VRM, OBJ, FBX, STL, PLY or BVH');
  }
}

export async function toGlb(bytes: Uint8Array, name: string): Promise<Uint8Array> {
  if (/\.vrm$/i.test(name)) return bytes; // a GLB with extensions
  let model: Object3D;
  try {
    model = parse(bytes, name);
  } catch (error) {
    if (error instanceof EngineError) throw error;
    throw fail(name, 'the file cannot be read', String(error instanceof Error ? error.message : error));
  }
  const others: Object3D[] = [];
  let meshes = 0;
  model.traverse((part) => {
    if (part instanceof Mesh) ++meshes;
    else if (part instanceof DirectionalLight || 'isLight' in part || 'isCamera' in part) others.push(part);
  });
  others.forEach((part) => part.removeFromParent());
  if (meshes === 0) throw fail(name, 'there is no surface in the file', 'is it the right file?');
  const scene = new Scene();
  scene.add(model);
  const glb = await new GLTFExporter().parseAsync(scene, { binary: true, animations: model.animations });
  return new Uint8Array(glb as ArrayBuffer);
}
