// Files as a user brings them: one, several that belong together, a folder, a ZIP archive.
import { unzipSync, zipSync } from 'three/examples/jsm/libs/fflate.module.js';
import { EngineError, refusal, unreadable } from '../engine/client';
import { say } from '../words/say';

const mostUnpacked = 500e6, mostFiles = 1000; // bytes and files that an archive holds
export const motionFiles = '.bvh,.npz,.vrma,.fbx,.glb,.gltf';
export const isMotionFile = ({ name }: File) => motionFiles.split(',').some((ending) => name.toLowerCase().endsWith(ending));
const model = /\.(glb|gltf|vrm|obj|fbx|stl|ply|limber)$/i;

/** All that was dropped, whole folders too; each file's path stands in webkitRelativePath or its name. */
export async function droppedFiles(transfer: DataTransfer): Promise<File[]> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.some((entry) => entry.isDirectory)) return [...transfer.files];
  const files: File[] = [];
  const read = async (entry: FileSystemEntry): Promise<void> => {
    if (entry.isFile) {
      files.push(await new Promise<File>((resolve, reject) => { (entry as FileSystemFileEntry).file(resolve, reject); }));
      return;
    }
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    for (;;) {
      const some = await new Promise<FileSystemEntry[]>((resolve, reject) => { reader.readEntries(resolve, reject); });
      if (some.length === 0) return;
      for (const one of some) await read(one);
    }
  };
  for (const entry of entries) await read(entry);
  return files;
}

/** The files of a ZIP archive by their paths in it, which are names and nothing is written to. */
export function unpack(archive: Uint8Array, name: string): Map<string, Uint8Array> {
  let size = 0, count = 0;
  try {
    const entries = unzipSync(archive, {
      filter: ({ name: path, originalSize }) => {
        if (path.endsWith('/')) return false;
        size += originalSize;
        if (size > mostUnpacked || ++count > mostFiles) throw refusal(say('the archive holds too much'), name, say('unpack it, and drop what you need'));
        return true;
      },
    });
    return new Map(Object.entries(entries));
  } catch (error) {
    if (error instanceof EngineError) throw error;
    throw unreadable(name, error);
  }
}

const fileName = (path: string) => path.split(/[\\/]/).pop() ?? path;

export interface Brought {
  /** What is opened: the first that the page reads. */
  model: File | null;
  motions: File[];
  poses: File[];
  limits: File | null;
  /** The cells.json of a study. */
  report: File | null;
  /** By name: what the model may refer to. */
  beside: Map<string, File>;
}

/** Of several glTF models those that move: they are motions for the model, not models to open. */
async function movingModels(files: File[]): Promise<Set<File>> {
  const models = files.filter(({ name }) => /\.(glb|gltf)$/i.test(name));
  if (models.length < 2) return new Set();
  const moves = await Promise.all(models.map(hasAnimation));
  return new Set(models.filter((_, i) => moves[i]));
}

const fbxShape = /(?:\0\x01|")Geometry(?:::|\S)/; // how an object of that class is named, in a binary file and in text

/** FBX files without a surface, which can only be motions. */
async function fbxMotions(files: File[]): Promise<Set<File>> {
  const fbx = files.filter(({ name }) => /\.fbx$/i.test(name));
  const texts = await Promise.all(fbx.map(async (file) => new TextDecoder('latin1').decode(await file.arrayBuffer())));
  return new Set(fbx.filter((_, i) => !fbxShape.test(texts[i]!)));
}

const poseStart = 200; // bytes of a file in which a pose says that it is one

/** Poses, whatever they are called; and what is called so, whatever it holds. */
async function posesAmong(files: File[]): Promise<File[]> {
  const isPose = async (file: File) => /\.pose\.json$/i.test(file.name)
    || (/\.json$/i.test(file.name) && /^\s*\{\s*"limber_pose"/.test(await file.slice(0, poseStart).text()));
  const are = await Promise.all(files.map(isPose));
  return files.filter((_, i) => are[i]);
}

const reportStart = 4096; // bytes in which a study's cells.json says that it is one, behind its title

async function reportAmong(files: File[]): Promise<File | null> {
  for (const file of files.filter(({ name }) => /\.json$/i.test(name))) {
    if (file.name === 'cells.json' || /^\s*\{\s*"title"\s*:[^]*"cells"\s*:\s*\[/.test(await file.slice(0, reportStart).text())) return file;
  }
  return null;
}

const glbJson = 20, glbJsonLength = 12; // bytes: where a GLB's JSON begins, and where its length is told

const crowdNote = '"limber_crowd"'; // in what a crowd's file says of each of its bodies

/** Of any file. */
export function isCrowd(glb: Uint8Array): boolean {
  if (glb.length < glbJson || new TextDecoder('latin1').decode(glb.subarray(0, 4)) !== 'glTF') return false;
  const length = new DataView(glb.buffer, glb.byteOffset).getUint32(glbJsonLength, true);
  return new TextDecoder('latin1').decode(glb.subarray(glbJson, glbJson + length)).includes(crowdNote);
}

/** Whether a glTF's JSON has animations; one that cannot be read has none. */
async function hasAnimation(file: File): Promise<boolean> {
  let text: Blob = file;
  if (/\.glb$/i.test(file.name)) {
    if (file.size < glbJson) return false;
    const length = new DataView(await file.slice(glbJsonLength, glbJson).arrayBuffer()).getUint32(0, true);
    text = file.slice(glbJson, glbJson + length);
  }
  return /"animations"\s*:\s*\[\s*\{/.test(await text.text());
}

export async function sorted(files: File[]): Promise<Brought> {
  const all: File[] = [];
  for (const file of files) {
    if (!/\.zip$/i.test(file.name)) all.push(file);
    else {
      const inside = unpack(new Uint8Array(await file.arrayBuffer()), file.name);
      inside.forEach((bytes, path) => all.push(new File([bytes as BlobPart], fileName(path))));
    }
  }
  const moving = new Set([...await movingModels(all), ...await fbxMotions(all)]);
  const motions = all.filter((file) => /\.(bvh|npz|vrma)$/i.test(file.name) || moving.has(file));
  const poses = await posesAmong(all);
  const found = all.find((file) => model.test(file.name) && !moving.has(file)) ?? null;
  const report = await reportAmong(all);
  const limits = found === null && motions.length === 0 ? all.find((file) => /\.json$/i.test(file.name) && !poses.includes(file) && file !== report) ?? null : null;
  // What no reader knows is opened all the same: its reader says so.
  const only = all.length === 1 && motions.length === 0 && poses.length === 0 && limits === null && report === null ? all[0]! : null;
  return { model: found ?? only, motions, poses, limits, report, beside: new Map(all.map((file) => [file.name, file])) };
}

const typeOf = (name: string) => ({ png: 'image/png', jpg: 'image/jpeg', jpeg: 'image/jpeg', webp: 'image/webp' }[name.split('.').pop()?.toLowerCase() ?? '']
  ?? 'application/octet-stream');

async function dataAddress(file: File): Promise<string> {
  const blob = new Blob([await file.arrayBuffer()], { type: typeOf(file.name) });
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(String(reader.result));
    reader.onerror = () => reject(new Error(say('{file} cannot be read', { file: file.name })));
    reader.readAsDataURL(blob);
  });
}

/** A glTF with the buffers and images that lie beside it put in; what is not there stays a reference. */
export async function withBuffers(bytes: Uint8Array, beside: Map<string, File>): Promise<Uint8Array> {
  let document: { buffers?: { uri?: unknown }[]; images?: { uri?: unknown }[] };
  try {
    document = JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    return bytes; // the engine says what is wrong
  }
  let changed = false;
  for (const part of [document.buffers, document.images].flatMap((list) => (Array.isArray(list) ? list : []))) {
    const uri = part?.uri;
    if (typeof uri !== 'string' || uri.startsWith('data:')) continue;
    const file = beside.get(fileName(decoded(uri)));
    if (!file) continue;
    part.uri = await dataAddress(file);
    changed = true;
  }
  return changed ? new TextEncoder().encode(JSON.stringify(document)) : bytes;
}

/** An FBX file with the pictures that came with it in one archive, which the engine reads as it is. */
export async function withPictures(bytes: Uint8Array, name: string, beside: Map<string, File>): Promise<Uint8Array> {
  const pictures = [...beside].filter(([path]) => /\.(png|jpe?g)$/i.test(path));
  if (pictures.length === 0) return bytes;
  const files: Record<string, Uint8Array> = { [name]: bytes };
  for (const [path, file] of pictures) files[path] = new Uint8Array(await file.arrayBuffer());
  return zipSync(files, { level: 0 });
}

function decoded(uri: string): string {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}
