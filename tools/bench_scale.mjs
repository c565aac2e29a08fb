// Scale: scans of millions of vertices, thousands of models, lists of a hundred thousand, a thousand characters.
//
//   node tools/bench_scale.mjs PROGRAM FOLDER [--largest VERTICES] [--models N] [--characters N]
//
// Called by ./dev bench scale. Prints the tables of docs/scale.md. FOLDER is emptied; the largest scan of 16 million
// vertices takes 1 GB of disk there.
import { execFileSync, spawnSync } from 'node:child_process';
import { closeSync, copyFileSync, linkSync, mkdirSync, openSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync, writeSync } from 'node:fs';
import { cpus } from 'node:os';
import { join, resolve } from 'node:path';

const [program, folder] = process.argv.slice(2, 4).map((path) => resolve(path));
const option = (name, otherwise) => {
  const at = process.argv.indexOf(`--${name}`);
  return at < 0 ? otherwise : Number(process.argv[at + 1]);
};
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const limber = (...words) => execFileSync(program, words.map(String), { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 }).toString();
const seconds = (work) => {
  const begun = performance.now();
  work();
  return (performance.now() - begun) / 1000;
};

/** A body with six limbs, of one piece, as a binary PLY of about so many vertices: the surface of a cube of so many cells,
 *  each point pulled to its distance from the middle. Rough as a scan is; another seed is another body. */
function writeBody(path, vertices, seed = 1) {
  const cells = Math.max(2, Math.round(Math.sqrt(vertices / 6)));
  const random = (n) => { const x = Math.sin(n * 127.1 + seed * 311.7) * 43758.5453; return x - Math.floor(x); };
  const limbs = Array.from({ length: 6 }, (_, limb) => {
    const z = 1 - (2 * limb + 1) / 6, turn = limb * 2.4 + seed, r = Math.sqrt(1 - z * z);
    return { x: r * Math.cos(turn), y: z, z: r * Math.sin(turn), reach: 0.3 + 0.15 * random(limb) };
  });
  const point = (i, j, k, into, at) => {
    const [a, b, c] = [i, j, k].map((n) => Math.tan((n / cells - 0.5) * Math.PI / 2));
    const length = Math.hypot(a, b, c), x = a / length, y = b / length, z = c / length;
    let distance = 0.1 + 0.0004 * random(i + 7919 * j + 104729 * k);
    for (const limb of limbs) distance += limb.reach * Math.exp(14 * (limb.x * x + limb.y * y + limb.z * z - 1));
    into[at] = x * distance;
    into[at + 1] = y * distance;
    into[at + 2] = z * distance;
  };
  const faces = [[0, 1, 2, 0], [0, 1, 2, 1], [1, 2, 0, 0], [1, 2, 0, 1], [2, 0, 1, 0], [2, 0, 1, 1]];
  const row = cells + 1;
  const out = openSync(path, 'w');
  writeSync(out, `ply\nformat binary_little_endian 1.0\nelement vertex ${6 * row * row}\nproperty float x\nproperty float y\nproperty float z\n`
    + `element face ${12 * cells * cells}\nproperty list uchar int vertex_indices\nend_header\n`);
  const places = new Float32Array(3 * row);
  for (const [u, v, w, far] of faces) {
    for (let i = 0; i < row; ++i) {
      for (let j = 0; j < row; ++j) {
        const at = [0, 0, 0];
        [at[u], at[v], at[w]] = [i, j, far * cells];
        point(...at, places, 3 * j);
      }
      writeSync(out, places);
    }
  }
  const triangles = Buffer.alloc(26 * cells);
  faces.forEach(([, , , far], face) => {
    for (let i = 0; i < cells; ++i) {
      for (let j = 0; j < cells; ++j) {
        const corner = face * row * row + i * row + j;
        const [a, b, c, d] = far ? [corner, corner + row, corner + row + 1, corner + 1] : [corner, corner + 1, corner + row + 1, corner + row];
        [[a, b, c], [a, c, d]].forEach((triangle, half) => {
          triangles[26 * j + 13 * half] = 3;
          triangle.forEach((index, k) => triangles.writeInt32LE(index, 26 * j + 13 * half + 1 + 4 * k));
        });
      }
      writeSync(out, triangles);
    }
  });
  closeSync(out);
}

const figure = (value) => (value >= 100 ? value.toFixed(0) : value >= 0.995 ? value.toFixed(1) : value.toPrecision(2));
const rowOf = (cells) => console.log(`| ${cells.join(' | ')} |`);
function table(title, header, rows = []) {
  console.log(`\n${title}\n`);
  [header, header.map(() => '---'), ...rows].forEach(rowOf);
}

function scans() {
  const stages = ['read', 'weld', 'collapse', 'surface and bones in sight', 'factorise', 'solve'];
  const exponent = (now, before, of) => (before && of(before) > 0.05 ? ` (n^${(Math.log(of(now) / of(before)) / Math.log(now.vertices / before.vertices)).toFixed(2)})` : '');
  let before = null;
  table('One scan, 50 handles, seconds; growth from the row above', ['vertices', 'all', 'memory', 'bytes a vertex', ...stages]);
  for (let vertices = 10_000; vertices <= option('largest', 4_000_000); vertices *= vertices < 1e6 ? 10 : 2) {
    writeBody(join(folder, 'scan.ply'), vertices);
    const plan = { limber_batch: 1, command: ['rig', '{input}', '-o', '{output}', '--handles', '50', '--threads', '0'],
      output: '.glb', inputs: ['scan.ply'], limits: { seconds: 3600, memory_mb: 65536 } };
    writeFileSync(join(folder, 'plan.json'), JSON.stringify(plan));
    rmSync(join(folder, 'out'), { recursive: true, force: true });
    limber('batch', 'plan.json', '-o', 'out', '-q', '--jobs', 1);
    const records = join(folder, 'out/.limber-batch/records');
    const record = JSON.parse(readFileSync(join(records, readdirSync(records)[0]), 'utf8').trim().split('\n').at(-1));
    // A plan names no second file to write: the stages are those of another run.
    limber('rig', 'scan.ply', '-o', 'report.glb', '--handles', 50, '--json', 'report.json', '-q');
    const report = JSON.parse(readFileSync(join(folder, 'report.json'), 'utf8'));
    const spent = new Map();
    const gather = (list) => list.forEach(({ name, seconds: took, steps }) => {
      spent.set(name, (spent.get(name) ?? 0) + took);
      gather(steps ?? []);
    });
    gather(report.stages);
    const row = { vertices: report.counts.welded_vertices, all: record.seconds, bytes: record.peak_memory, spent };
    const time = (of) => figure(of(row)) + exponent(row, before, of);
    rowOf([row.vertices, time((one) => one.all), `${(row.bytes / 1e9).toFixed(2)} GB`, (row.bytes / row.vertices).toFixed(0),
      ...stages.map((stage) => time((one) => one.spent.get(stage) ?? 0))]);
    before = row;
  }
  rmSync(join(folder, 'scan.ply'));
  rmSync(join(folder, 'out'), { recursive: true, force: true });
}

function batches() {
  const models = option('models', 2000);
  mkdirSync(join(folder, 'models'));
  for (let n = 0; n < models; ++n) writeBody(join(folder, `models/${n}.ply`), 2000 + (n * 8000) / models, n);
  const plan = { limber_batch: 1, command: ['rig', '{input}', '-o', '{output}', '--handles', '20'], output: '.glb', inputs: ['models/'], limits: { seconds: 60, memory_mb: 2048 } };
  writeFileSync(join(folder, 'plan.json'), JSON.stringify(plan));
  const first = seconds(() => limber('batch', 'plan.json', '-o', 'out', '-q'));
  const again = seconds(() => limber('batch', 'plan.json', '-o', 'out', '-q'));
  table(`${models} models of 2 to 10k vertices, rigged with 20 handles`, ['', ''], [
    ['seconds', figure(first)], ['models a second', figure(models / first)], ['called again, nothing to do: seconds', figure(again)]]);
  rmSync(join(folder, 'models'), { recursive: true });
  rmSync(join(folder, 'out'), { recursive: true });
}

/** One file under many names; a file system allows some 65,000 links to one. */
function linkAll(source, targets) {
  targets.forEach((target, n) => (n % 30_000 === 0 ? copyFileSync(source, target) : linkSync(targets[n - (n % 30_000)], target)));
}

/** One entry is done; the others get its line and its output under their names, as if each had been. */
function longLists() {
  const entries = 100_000;
  writeBody(join(folder, 'one.ply'), 500);
  const names = Array.from({ length: entries }, (_, n) => `${String(n).padStart(6, '0')}.ply`);
  mkdirSync(join(folder, 'many'));
  linkAll(join(folder, 'one.ply'), names.map((name) => join(folder, 'many', name)));
  writeFileSync(join(folder, 'list.txt'), `${names.map((name) => `many/${name}`).join('\n')}\n`);
  const plan = { limber_batch: 1, command: ['rig', '{input}', '-o', '{output}', '--handles', '3'], output: '.glb', inputs: ['list.txt'], limits: { seconds: 60, memory_mb: 2048 } };
  writeFileSync(join(folder, 'plan.json'), JSON.stringify(plan));
  const start = seconds(() => limber('batch', 'plan.json', '-o', 'out', '-q', '--shard', `1/${entries}`));
  const records = join(folder, 'out/.limber-batch/records');
  const file = join(records, readdirSync(records)[0]);
  const line = readFileSync(file, 'utf8').trim().split('\n').at(-1), done = JSON.parse(line);
  writeFileSync(file, names.map((name) => `${line.replaceAll(done.input.split('/').at(-1), name).replaceAll(done.output.split('/').at(-1), name.replace('.ply', '.glb'))}\n`).join(''));
  const outputOf = (name) => join(folder, 'out', done.output.replace(names[0].replace('.ply', '.glb'), name.replace('.ply', '.glb')));
  linkAll(outputOf(names[0]), names.slice(1).map(outputOf));
  let status;
  const asked = seconds(() => { status = spawnSync(program, ['batch', 'status', 'out', '--json'], { cwd: folder, maxBuffer: 1 << 28 }).stdout.toString(); });
  table(`${entries} entries in a list`, ['', ''], [['start, one entry, end: seconds', figure(start)], ['status of all: seconds', figure(asked)],
    ['of those, done', JSON.parse(status).done ?? JSON.stringify(JSON.parse(status)).slice(0, 80)]]);
  for (const name of ['many', 'out']) rmSync(join(folder, name), { recursive: true });
}

function characters() {
  const count = option('characters', 1000);
  limber('sample', 'biped', '-o', 'biped.glb');
  limber('rig', 'biped.glb', '-o', 'rigged.glb', '--template', 'humanoid', '-q');
  limber('sample', 'walk', '-o', 'walk.bvh');
  const frames = 300, [, now, each] = readFileSync(join(folder, 'walk.bvh'), 'utf8').match(/Frames:\s*(\d+)\s*Frame Time:\s*([\d.]+)/);
  limber('convert', 'walk.bvh', 'long.bvh', '--fps', (frames - 1) / ((now - 1) * each), '-q');
  mkdirSync(join(folder, 'people'));
  const names = Array.from({ length: count }, (_, n) => `people/${n}.glb`);
  for (const name of names) linkSync(join(folder, 'rigged.glb'), join(folder, name));
  writeFileSync(join(folder, 'people.txt'), `${names.join('\n')}\n`);
  const took = seconds(() => limber('retarget', '--characters', 'people.txt', 'long.bvh', '-o', 'moved', '-q'));
  const bytes = readdirSync(join(folder, 'moved')).reduce((sum, name) => sum + statSync(join(folder, 'moved', name)).size, 0);
  table(`One motion of ${frames} frames onto ${count} characters of 8k vertices`, ['', ''], [['seconds', figure(took)], ['megabytes written', figure(bytes / 1e6)]]);
}

console.log(`${cpus().length} processors, ${cpus()[0].model}`);
scans();
batches();
longLists();
characters();
rmSync(folder, { recursive: true });
