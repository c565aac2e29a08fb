// Models in formats that the engine does not read in a browser, brought into GLB. Loaded when the first one is opened.
import {
  BufferAttribute, BufferGeometry, LoadingManager, Mesh, MeshStandardMaterial, Object3D, Scene, type TypedArray,
} from 'three';
import { GLTFExporter } from 'three/examples/jsm/exporters/GLTFExporter.js';
import { MTLLoader } from 'three/examples/jsm/loaders/MTLLoader.js';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';
import { EngineError, refusal, unreadable } from '../engine/client';
import { say } from '../words/say';

function meshOf(geometry: BufferGeometry): Object3D {
  return new Mesh(geometry, new MeshStandardMaterial({ vertexColors: geometry.hasAttribute('color') }));
}

/** Readers that take what a model refers to from the files beside it. */
class Beside {
  readonly manager = new LoadingManager();
  private addresses: string[] = [];
  private pictures: Promise<void> | null = null;

  constructor(private files: Map<string, File>) {
    this.manager.setURLModifier((url) => {
      const file = files.get(url.split(/[\\/]/).pop() ?? url);
      if (!file) return url;
      const address = URL.createObjectURL(file);
      this.addresses.push(address);
      return address;
    });
    this.manager.onStart = () => {
      this.pictures ??= new Promise((resolve) => { this.manager.onLoad = resolve; });
    };
  }

  text(name: string): Promise<string> | null { return this.files.get(name)?.text() ?? null; }

  /** Once all pictures are there. */
  async loaded() {
    await this.pictures;
    this.addresses.forEach((address) => URL.revokeObjectURL(address));
  }
}

async function parseObj(text: string, beside: Beside): Promise<Object3D> {
  const reader = new OBJLoader(beside.manager);
  const library = /^mtllib\s+(.+?)\s*$/m.exec(text)?.[1]?.split(/[\\/]/).pop();
  const materials = library === undefined ? null : await beside.text(library);
  if (materials !== null) reader.setMaterials(new MTLLoader(beside.manager).parse(materials, ''));
  const model = reader.parse(text);
  // The reader makes normals up, one for each triangle, which would tear the surface at every edge.
  if (!/^vn\s/m.test(text)) model.traverse((part) => { if (part instanceof Mesh) part.geometry.deleteAttribute('normal'); });
  return model;
}

/** For each vertex which of the different ones it is, and the first of each. */
function different(attributes: BufferAttribute[], count: number): { index: Uint32Array; firsts: number[] } {
  const index = new Uint32Array(count), firsts: number[] = [], value = new Float32Array(1), bits = new Uint32Array(value.buffer);
  const slots = new Int32Array(2 ** Math.ceil(Math.log2(2 * count + 1))).fill(-1), last = slots.length - 1;
  const hash = (vertex: number) => {
    let mixed = 0;
    for (const { array, itemSize } of attributes) {
      for (let i = vertex * itemSize; i < (vertex + 1) * itemSize; ++i) {
        value[0] = array[i]! + 0; // -0 is 0
        mixed = Math.imul(mixed ^ bits[0]!, 0x9e3779b1);
        mixed ^= mixed >>> 15;
      }
    }
    return mixed & last;
  };
  const same = (a: number, b: number) => attributes.every(({ array, itemSize }) => {
    for (let i = 0; i < itemSize; ++i) if (!Object.is(array[a * itemSize + i]! + 0, array[b * itemSize + i]! + 0)) return false;
    return true;
  });
  for (let vertex = 0; vertex < count; ++vertex) {
    let slot = hash(vertex);
    while (slots[slot]! >= 0 && !same(firsts[slots[slot]!]!, vertex)) slot = (slot + 1) & last;
    if (slots[slot]! < 0) slots[slot] = firsts.push(vertex) - 1;
    index[vertex] = slots[slot]!;
  }
  return { index, firsts };
}

/** Readers that know no shared vertices give three for each triangle: those that are equal in all become one. */
function weld(geometry: BufferGeometry): BufferGeometry {
  const attributes = Object.entries(geometry.attributes) as [string, BufferAttribute][];
  if (geometry.index || Object.keys(geometry.morphAttributes).length > 0) return geometry;
  if (attributes.some(([, attribute]) => !(attribute instanceof BufferAttribute))) return geometry;
  const { index, firsts } = different(attributes.map(([, attribute]) => attribute), attributes[0]?.[1].count ?? 0);
  const welded = new BufferGeometry();
  for (const [name, { array, itemSize, normalized }] of attributes) {
    const Type = array.constructor as new (length: number) => TypedArray;
    const values = new Type(firsts.length * itemSize);
    firsts.forEach((vertex, place) => values.set(array.subarray(vertex * itemSize, (vertex + 1) * itemSize), place * itemSize));
    welded.setAttribute(name, new BufferAttribute(values, itemSize, normalized));
  }
  welded.setIndex(new BufferAttribute(index, 1));
  for (const { start, count: some, materialIndex } of geometry.groups) welded.addGroup(start, some, materialIndex);
  return welded;
}

async function parse(bytes: Uint8Array, name: string, beside: Beside): Promise<Object3D> {
  const buffer = bytes.slice().buffer;
  switch (name.split('.').pop()?.toLowerCase()) {
    case 'obj': return parseObj(new TextDecoder().decode(bytes), beside);
    case 'stl': {
      const geometry = new STLLoader().parse(buffer);
      geometry.deleteAttribute('normal'); // of each triangle: what it is shaded by without any
      return meshOf(geometry);
    }
    case 'ply': return meshOf(new PLYLoader().parse(buffer));
    case 'usd': case 'usda': case 'usdc': case 'usdz':
      throw refusal(say('the studio writes USD, and does not read it'), name, say('open the model that it was made of: GLB, FBX or another'));
    default: throw refusal(say('a file of this kind cannot be opened'), name, say('open GLB, glTF, VRM, OBJ, FBX, STL, PLY or BVH'));
  }
}

/** `beside`: files that it may refer to, by name. */
export async function toGlb(bytes: Uint8Array, name: string, beside = new Map<string, File>()): Promise<Uint8Array> {
  let model: Object3D;
  try {
    const readers = new Beside(beside);
    model = await parse(bytes, name, readers);
    await readers.loaded();
  } catch (error) {
    if (error instanceof EngineError) throw error;
    throw unreadable(name, error);
  }
  let meshes = 0;
  model.traverse((part) => {
    if (!(part instanceof Mesh)) return;
    ++meshes;
    part.geometry = weld(part.geometry as BufferGeometry);
  });
  if (meshes === 0) throw refusal(say('there is no surface in the file'), name, say('is it the right file?'));
  const scene = new Scene();
  scene.add(model);
  const glb = await new GLTFExporter().parseAsync(scene, { binary: true });
  return new Uint8Array(glb as ArrayBuffer);
}
