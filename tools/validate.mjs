// Runs the Khronos glTF validator over every .glb, .gltf, .vrm and .vrma below the folders given.
//
//   node tools/validate.mjs FOLDER...
//
// A file passes with no error and no warning, except those that its source had too: a sidecar FILE.source names the
// input that FILE was made from. Prints each file that fails, and ends with "N passed, N failed".
import { readFileSync, readdirSync, existsSync, statSync } from 'node:fs';
import { basename, dirname, extname, join, resolve, sep } from 'node:path';
import { createRequire } from 'node:module';
import { cpus } from 'node:os';
import { Worker, isMainThread, parentPort, workerData } from 'node:worker_threads';

const { validateBytes } = createRequire(import.meta.url)('gltf-validator');

const kError = 0, kWarning = 1;

const isGltf = (path) => ['.glb', '.gltf', '.vrm', '.vrma'].includes(extname(path).toLowerCase());

// A source may have any name: told by its content.
const looksLikeGltf = (bytes) => /^(glTF|\s*\{)/.test(bytes.subarray(0, 64).toString('latin1'));

function filesBelow(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return filesBelow(path);
    return isGltf(path) ? [path] : [];
  }).sort();
}

// How often each error and warning is met: "code" -> { severity, count, example }.
async function issuesOf(path) {
  const folder = resolve(dirname(path));
  const loadBeside = async (uri) => {
    const beside = resolve(folder, decodeURIComponent(uri));
    if (!beside.startsWith(folder + sep)) throw new Error(`${uri} is not beside the file`);
    return new Uint8Array(readFileSync(beside));
  };
  const { issues } = await validateBytes(new Uint8Array(readFileSync(path)), {
    uri: basename(path), maxIssues: 0, externalResourceFunction: loadBeside,
  });
  const found = new Map();
  for (const { code, severity, pointer, message } of issues.messages) {
    if (severity !== kError && severity !== kWarning) continue;
    const entry = found.get(code) ?? { severity, count: 0, example: `${pointer ?? ''}: ${message}` };
    ++entry.count;
    found.set(code, entry);
  }
  return found;
}

// The issues of each source, validated once however many files were made from it.
const sourceIssues = new Map();
async function issuesOfSource(path) {
  const note = `${path}.source`;
  if (!existsSync(note)) return new Map();
  const source = readFileSync(note, 'utf8').trim();
  if (!existsSync(source) || !looksLikeGltf(readFileSync(source))) return new Map();
  if (!sourceIssues.has(source)) sourceIssues.set(source, await issuesOf(source).catch(() => new Map()));
  return sourceIssues.get(source);
}

async function complaintsAbout(path) {
  let found;
  try {
    found = await issuesOf(path);
  } catch (error) {
    return [`cannot be validated: ${error}`];
  }
  const before = await issuesOfSource(path);
  return [...found]
    .filter(([code, { count }]) => count > (before.get(code)?.count ?? 0))
    .map(([code, { severity, count, example }]) =>
      `${severity === kError ? 'error' : 'warning'} ${code} ${count} times, ${before.get(code)?.count ?? 0} in its source: ${example}`);
}

if (isMainThread) {
  await validateFolders(process.argv.slice(2));
} else {
  for (const path of workerData) parentPort.postMessage([path, await complaintsAbout(path)]);
}

async function validateFolders(folders) {
  const missing = folders.filter((folder) => !existsSync(folder) || !statSync(folder).isDirectory());
  if (folders.length === 0 || missing.length > 0) {
    console.error(missing.length > 0 ? `no such folder: ${missing.join(', ')}` : 'usage: node tools/validate.mjs FOLDER...');
    process.exit(2);
  }
  const paths = folders.flatMap(filesBelow), threads = Math.max(1, cpus().length), complaints = new Map();
  await Promise.all(Array.from({ length: threads }, (_, at) => new Promise((done, stopped) => {
    new Worker(new URL(import.meta.url), { workerData: paths.filter((_, i) => i % threads === at) })
      .on('message', ([path, found]) => complaints.set(path, found)).on('error', stopped).on('exit', done);
  })));
  for (const path of paths) for (const complaint of complaints.get(path) ?? ['was not validated']) console.log(`${path}: ${complaint}`);
  const failed = paths.filter((path) => complaints.get(path)?.length !== 0).length;
  console.log(`${paths.length - failed} passed, ${failed} failed`);
  process.exit(failed > 0 ? 1 : 0);
}
