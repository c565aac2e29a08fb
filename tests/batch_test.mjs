// A batch of many models, killed at random moments and gone on with, against the same batch in one go.
//
//   node tests/batch_test.mjs PROGRAM OUTPUT_FOLDER [FOLDER_OF_FAULTY_FILES] [--models N] [--kills N]
//
// Models are copies of the project's own samples, each with a name of its own. Ends with "N passed, N failed".
import { spawn, spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, symlinkSync, truncateSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

const words = process.argv.slice(2).filter((word, at, all) => !word.startsWith('--') && !all[at - 1]?.startsWith('--'));
const optionOf = (name, otherwise) => Number(process.argv[process.argv.indexOf(`--${name}`) + 1 || process.argv.length] ?? otherwise);
const [program, folder, faulty] = [resolve(words[0]), resolve(words[1]), words[2] && resolve(words[2])];
const models = optionOf('models', 300), kills = optionOf('kills', 20);

let passed = 0, failed = 0;
function check(what, isRight, seen = '') {
  if (isRight) ++passed; else { ++failed; console.log(`FAILED: ${what} ${seen}`); }
}

// The stage's table: what was measured on the way, for the end.
const measured = [];
const measure = (what, value) => measured.push(`| ${what} | ${value} |`);

const limber = (...words) => spawnSync(program, words, { encoding: 'utf8', maxBuffer: 1 << 28 });
const sha256 = (file) => createHash('sha256').update(readFileSync(file)).digest('hex');

// A GLB whose JSON has another generator, so that no two models have the same bytes.
function namedCopy(glb, name) {
  const length = glb.readUInt32LE(12), json = JSON.parse(glb.subarray(20, 20 + length).toString());
  json.asset.generator = name;
  let text = JSON.stringify(json);
  text += ' '.repeat(-text.length & 3);
  const head = Buffer.alloc(20);
  glb.copy(head, 0, 0, 20);
  head.writeUInt32LE(text.length, 12);
  head.writeUInt32LE(glb.length - length + text.length, 8);
  return Buffer.concat([head, Buffer.from(text), glb.subarray(20 + length)]);
}

function makeModels(place) {
  mkdirSync(place, { recursive: true });
  const samples = ['biped', 'quadruped', 'winged', 'theropod', 'stool'].map((sample) => {
    const file = join(folder, `${sample}.glb`);
    limber('sample', sample, '-o', file, '--quiet');
    return readFileSync(file);
  });
  for (let i = 0; i < models; ++i) writeFileSync(join(place, `model_${String(i).padStart(5, '0')}.glb`), namedCopy(samples[i % samples.length], `copy ${i}`));
}

const planOf = (name, inputs, limits = { seconds: 20, memory_mb: 2048 }, options = ['--handles', '12']) => {
  const file = join(folder, name);
  writeFileSync(file, JSON.stringify({
    limber_batch: 1, command: ['rig', '{input}', '-o', '{output}', ...options], output: '.glb', inputs, limits,
  }));
  return file;
};

const statusOf = (out) => JSON.parse(limber('batch', 'status', out, '--json').stdout);
const recordsIn = (out) => {
  const place = join(out, '.limber-batch/records');
  return readdirSync(place).flatMap((file) => readFileSync(join(place, file), 'utf8').split('\n').filter(Boolean).map((line) => JSON.parse(line)));
};

function hashesBelow(place) {
  const hashes = new Map();
  for (const entry of readdirSync(place, { withFileTypes: true, recursive: true })) {
    if (!entry.isFile() || entry.parentPath?.includes('.limber-batch') || entry.path?.includes('.limber-batch')) continue;
    const file = join(entry.parentPath ?? entry.path, entry.name);
    hashes.set(file.slice(place.length), sha256(file));
  }
  return hashes;
}

// Runs the batch until it ends by itself or is killed after so many seconds; the exit code, or null.
function runFor(words, seconds) {
  return new Promise((done) => {
    const child = spawn(program, words, { stdio: 'ignore' });
    const timer = seconds && setTimeout(() => child.kill('SIGKILL'), 1000 * seconds);
    child.on('exit', (code) => { clearTimeout(timer); done(code); });
  });
}

// The same moments each time: a linear congruential generator (Numerical Recipes' constants).
let state = 20;
const random = () => { state = (1664525 * state + 1013904223) >>> 0; return state / 2 ** 32; };

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
makeModels(join(folder, 'models'));
const plan = planOf('plan.json', ['models']);

const whole = join(folder, 'whole'), begun = Date.now();
const first = limber('batch', plan, '-o', whole);
const seconds = (Date.now() - begun) / 1000;
check('the batch ends well', first.status === 0, first.stderr);
measure(`${models} models of the project's own samples rigged: a second`, (models / seconds).toFixed(1));
check('all are done', statusOf(whole).done === models);

const again = Date.now();
check('nothing is done again', limber('batch', plan, '-o', whole).stdout.includes(`0 run`));
measure('gone over again, nothing to do: seconds', ((Date.now() - again) / 1000).toFixed(2));

const killed = join(folder, 'killed');
let ended = 0;
for (let i = 0; i < kills; ++i) {
  const code = await runFor(['batch', plan, '-o', killed, '--quiet'], (0.2 + 1.3 * random()) * seconds / kills);
  if (code !== null) ++ended;
}
check('it was killed while it worked', ended < kills);
check('it ends after all', await runFor(['batch', plan, '-o', killed, '--quiet'], 0) === 0);
const right = hashesBelow(whole), resumed = hashesBelow(killed);
check('no output is lost', resumed.size === models, resumed.size);
check('outputs are the same to the byte', [...right].every(([name, hash]) => resumed.get(name) === hash));
const records = recordsIn(killed);
check('no record is doubled', new Set(records.map(({ output }) => output)).size === records.length, records.length);
check('hashes are those of the files', records.every(({ output, output_sha256 }) => sha256(join(killed, output)) === output_sha256));
measure(`killed ${kills - ended} times and gone on with: outputs lost, doubled, or of other bytes`,
  models - resumed.size + records.length - new Set(records.map(({ output }) => output)).size + [...right].filter(([name, hash]) => resumed.get(name) !== hash).length);
check('nothing unfinished stays', readdirSync(join(killed, '.limber-batch')).every((name) => !name.startsWith('unfinished')));

// Shards at the same time, into one folder.
const shards = join(folder, 'shards');
const codes = await Promise.all([1, 2, 3].map((shard) => runFor(['batch', plan, '-o', shards, '--shard', `${shard}/3`, '--jobs', '1', '--quiet'], 0)));
check('each shard ends well', codes.every((code) => code === 0), codes);
check('shards make the whole', limber('batch', 'status', shards, '--merge', join(folder, 'merged.jsonl')).status === 0);
const merged = readFileSync(join(folder, 'merged.jsonl'), 'utf8').split('\n').filter(Boolean).map((line) => JSON.parse(line));
check('merged records are those of one go', merged.length === models && merged.every(({ output, output_sha256 }) => right.get(`/${output}`) === output_sha256));

// What is huge or has no end costs itself alone.
{
  const place = join(folder, 'endless'), out = join(folder, 'endless_out');
  mkdirSync(place);
  const [good] = readdirSync(join(folder, 'models'));
  cpSync(join(folder, 'models', good), join(place, 'good.glb'));
  cpSync(join(folder, 'models', good), join(place, 'waits.glb'));
  check('a pipe is made', spawnSync('mkfifo', [join(place, 'pipe.glb')]).status === 0);
  symlinkSync('/dev/zero', join(place, 'zeros.glb'));
  for (const [name, size] of [['huge.ply', 1e12], ['large.ply', 4e8], ['large.obj', 4e8], ['large.stl', 4e8], ['large.glb', 4e8]]) {
    // A head that promises as much as follows: zeros, without a place on the disk.
    writeFileSync(join(place, name), name.endsWith('.ply') ? `ply\nformat binary_little_endian 1.0\nelement vertex ${Math.floor(size / 12)}\n`
      + 'property float x\nproperty float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n' : '');
    truncateSync(join(place, name), size);
  }
  const names = readdirSync(place), adapters = join(folder, 'adapters');
  // One entry waits for a program that does not end.
  mkdirSync(adapters);
  writeFileSync(join(adapters, 'sleeper.json'), JSON.stringify({ limber_adapter: 1, kind: 'rig',
    steps: [{ command: ['/bin/sh', '-c', 'sleep 1000', '{input}'] }] }));
  writeFileSync(join(folder, 'endless.jsonl'), names.map((name) => JSON.stringify({ path: `endless/${name}`,
    options: name === 'waits.glb' ? ['--rigger', 'sleeper'] : ['--handles', '12'] })).join('\n'));
  const plan = planOf('endless.json', ['endless.jsonl'], { seconds: 5, memory_mb: 512 }, []);
  const begun = Date.now(), run = limber('batch', plan, '-o', out, '--quiet', '--adapter-folder', adapters), records = recordsIn(out);
  check('huge and endless inputs end', run.status === 1 && records.length === names.length, run.stderr);
  check('the good one among them is done', records.filter(({ outcome }) => outcome === 'done').map(({ output }) => output).join() === 'endless/good.glb',
    JSON.stringify(records));
  check('what waits is ended', records.find(({ input }) => input === 'endless/waits.glb')?.outcome === 'timed-out', JSON.stringify(records));
  check('each says why', records.every(({ outcome, problem }) => outcome === 'done' || problem));
  measure(`a good file among ${names.length - 1} huge and endless ones (limits of 5 s and 512 MB): seconds, done`,
    `${((Date.now() - begun) / 1000).toFixed(1)}, ${records.filter(({ outcome }) => outcome === 'done').length}`);
}

// What is damaged costs itself alone.
if (faulty && existsSync(faulty)) {
  cpSync(faulty, join(folder, 'faulty'), { recursive: true });
  const mixed = planOf('mixed.json', ['models/model_000*.glb', 'faulty/**/*.*']), out = join(folder, 'mixed');
  const run = limber('batch', mixed, '-o', out, '--quiet'), status = statusOf(out);
  const good = readdirSync(join(folder, 'models')).filter((name) => name.startsWith('model_000')).length;
  check('a batch with damaged files tells by its code', run.status === 1, run.status);
  check('damaged files cost themselves alone', recordsIn(out).filter(({ input, outcome }) => input.startsWith('models') && outcome === 'done').length === good);
  check('every entry has an outcome', status.open === 0 && status.failed > 0 && status.entries > good);
  measure(`${good} good models among ${status.entries - good} damaged ones: done of the good`,
    recordsIn(out).filter(({ input, outcome }) => input.startsWith('models') && outcome === 'done').length);
  check('failures are told in groups', status.failures.reduce((sum, { count }) => sum + count, 0) === status.failed && status.failures.length < status.failed);
}

// A plan of very many entries: known and told in no time.
const many = join(folder, 'many.jsonl'), manyOut = join(folder, 'many');
writeFileSync(many, Array.from({ length: 100000 }, (_, i) => JSON.stringify({ path: `none/${i}.glb` })).join('\n'));
const startedMany = Date.now();
await runFor(['batch', planOf('many.json', ['many.jsonl']), '-o', manyOut, '--quiet'], 0);
const ranMany = (Date.now() - startedMany) / 1000, toldAt = Date.now(), told = statusOf(manyOut);
measure('100,000 entries that are not there, tried: seconds', ranMany.toFixed(1));
measure('status of these: seconds', ((Date.now() - toldAt) / 1000).toFixed(2));
check('100000 entries are told', told.entries === 100000 && told.failed === 100000 && told.failures.length === 1, JSON.stringify(told).slice(0, 200));

console.log(['| batch | |', '| --- | --- |', ...measured].join('\n'));
for (const part of ['endless', 'endless_out', 'faulty', 'mixed', 'many', 'killed', 'shards']) rmSync(join(folder, part), { recursive: true, force: true });
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
