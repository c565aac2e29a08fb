// Decoders of compressed glTF for the engine; each is fetched when the first file that needs it is opened.
import type { Codecs, DracoMesh } from '@engine/limber.mjs';
import dracoUrl from 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm?url';

const dracoTypes = { 5120: 'DT_INT8', 5121: 'DT_UINT8', 5122: 'DT_INT16', 5123: 'DT_UINT16', 5125: 'DT_UINT32', 5126: 'DT_FLOAT32' } as const;
const bytesOf: Record<number, number> = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };

/** What is used of Draco's module, as its own bindings name it. */
interface DracoAttribute { ptr: number; num_components(): number }
interface DracoModule extends Record<typeof dracoTypes[keyof typeof dracoTypes], number> {
  HEAPU8: Uint8Array;
  Decoder: new () => {
    DecodeArrayToMesh(data: Int8Array, size: number, mesh: object): { ok(): boolean };
    GetAttributeByUniqueId(mesh: object, id: number): DracoAttribute;
    GetTrianglesUInt32Array(mesh: object, size: number, at: number): boolean;
    GetAttributeDataArrayForAllPoints(mesh: object, attribute: DracoAttribute, type: number, size: number, at: number): boolean;
  };
  Mesh: new () => { ptr: number; num_faces(): number; num_points(): number };
  destroy(object: object): void;
  _malloc(size: number): number;
  _free(at: number): void;
}

async function fetched(address: string): Promise<ArrayBuffer> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`the decoder of this compression cannot be fetched (answer ${response.status})`);
  return response.arrayBuffer();
}

async function loadDraco(): Promise<NonNullable<Codecs['draco']>> {
  const [{ default: createModule }, wasmBinary] = await Promise.all([
    import('three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js'), fetched(dracoUrl),
  ]);
  const module = await new Promise<{ draco: DracoModule }>((resolve, reject) => {
    // The module is like a promise: wrapped, so that nothing waits for it again.
    createModule({ wasmBinary, onModuleLoaded: (draco: DracoModule) => resolve({ draco }), onAbort: reject });
  });
  return (data) => decodeDraco(module.draco, data);
}

function decodeDraco(draco: DracoModule, data: Uint8Array): DracoMesh | null {
  const decoder = new draco.Decoder(), mesh = new draco.Mesh();
  const free = () => [mesh, decoder].forEach((object) => draco.destroy(object));
  const copy = (size: number, fill: (at: number) => boolean) => {
    const at = draco._malloc(size);
    const filled = fill(at) ? draco.HEAPU8.slice(at, at + size) : null;
    draco._free(at);
    return filled;
  };
  try {
    const whole = decoder.DecodeArrayToMesh(new Int8Array(data.buffer, data.byteOffset, data.byteLength), data.byteLength, mesh).ok();
    if (whole && mesh.ptr !== 0) {
      const faces = mesh.num_faces(), points = mesh.num_points();
      const attribute = (id: number) => decoder.GetAttributeByUniqueId(mesh, id);
      return {
        faces, points, free,
        indices: () => new Uint32Array(copy(12 * faces, (at) => decoder.GetTrianglesUInt32Array(mesh, 12 * faces, at))!.buffer),
        components: (id) => (attribute(id).ptr === 0 ? 0 : attribute(id).num_components()),
        values: (id, type) => {
          const size = points * attribute(id).num_components() * (bytesOf[type] ?? 0), dracoType = draco[dracoTypes[type as keyof typeof dracoTypes]];
          return copy(size, (at) => decoder.GetAttributeDataArrayForAllPoints(mesh, attribute(id), dracoType, size, at));
        },
      };
    }
  } catch {
    // the decoder stops where data ask for more memory than it has
  }
  free();
  return null;
}

async function loadMeshopt(): Promise<NonNullable<Codecs['meshopt']>> {
  const { MeshoptDecoder } = await import('three/examples/jsm/libs/meshopt_decoder.module.js');
  await MeshoptDecoder.ready;
  return (data, count, stride, mode, filter) => {
    const decoded = new Uint8Array(count * stride);
    try {
      MeshoptDecoder.decodeGltfBuffer(decoded, count, stride, data, mode, filter);
      return decoded;
    } catch {
      return null;
    }
  };
}

/** Whether the text stands in the file: a glTF names what it needs. */
function names(file: Uint8Array, text: string): boolean {
  const wanted = new TextEncoder().encode(text), last = file.length - wanted.length;
  for (let at = file.indexOf(wanted[0]!); at >= 0 && at <= last; at = file.indexOf(wanted[0]!, at + 1)) {
    if (wanted.every((byte, i) => file[at + i] === byte)) return true;
  }
  return false;
}

/** Puts in what the file's JSON asks for. */
export async function bringCodecs(codecs: Codecs, file: Uint8Array) {
  if (!codecs.draco && names(file, 'KHR_draco_mesh_compression')) codecs.draco = await loadDraco();
  if (!codecs.meshopt && names(file, '_meshopt_compression')) codecs.meshopt = await loadMeshopt();
}
