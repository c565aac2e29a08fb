// The packed npm package as somebody else installs it: in Node, as a program, in TypeScript, in a page made by vite.
//
//   node bindings/npm/tests/package_test.mjs PACKAGE.tgz LIMBER WORK_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch, serve } from '../../../apps/studio/tests/page.mjs';

const [tarball, program, work] = process.argv.slice(2).map((path) => resolve(path));
const tools = join(dirname(fileURLToPath(import.meta.url)), '../../../apps/studio/node_modules');
rmSync(work, { recursive: true, force: true });
mkdirSync(work, { recursive: true });
const at = (name) => join(work, name);
const run = (command, args, options = {}) => execFileSync(command, args, { cwd: work, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], ...options });
writeFileSync(at('own.json'), '{"joints": [{"name": "root", "position": [0, 1, 0]}, {"name": "top", "parent": "root", "position": [0, 2, 0]}]}');
writeFileSync(at('package.json'), '{"name": "somebody", "private": true, "type": "module"}');
run('npm', ['install', '--offline', '--silent', '--no-audit', '--no-fund', tarball]);
run(program, ['sample', 'biped', '-o', 'model.glb', '--quiet']);
run(program, ['rig', 'model.glb', '--template', 'humanoid', '-o', 'person.glb', '--quiet']); // a template of one's own
// Why `npx limber rig` does not take them; every other option of the program it does.
const notOffered = {
  'from-animation': 'bones of a mesh that moves are found by the native program alone', clip: 'goes with --from-animation', bones: 'goes with --from-animation',
  fps: 'goes with --from-animation', 'adapter-folder': 'the engine starts no programs', adapter: 'the engine starts no programs', seed: 'goes with --adapter',
  reading: 'networks of your own are given to the engine, setShapeWeights', threads: 'the engine has one thread',
};
/** Of a help text: the options by name, each with its words. */
const optionsIn = (help) => new Map([...help.matchAll(/^  (?:-\w,)?--([a-z-]+)(.*(?:\n {4,}\S.*)*)/gm)].map(([, name, words]) => [name, words]));
writeFileSync(at('worker.mjs'), "export { startWorker } from 'limber/worker';");
const { startWorker } = await import(pathToFileURL(at('worker.mjs')));
const npx = (...args) => spawnSync('npx', ['--no-install', 'limber', ...args], { cwd: work, encoding: 'utf8' });

/** Of a GLB: its clips, each with the times and the values of its channels by joint and path, in one list. */
function clipsIn(glb) {
  const size = glb.readUInt32LE(12), { animations, accessors, bufferViews, nodes } = JSON.parse(glb.subarray(20, 20 + size)), binary = glb.subarray(28 + size);
  const numbers = (index) => {
    const { bufferView, byteOffset = 0, count, type } = accessors[index], begin = (bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
    return Array.from({ length: count * { SCALAR: 1, VEC3: 3, VEC4: 4 }[type] }, (_, k) => binary.readFloatLE(begin + 4 * k));
  };
  return animations.map(({ name, channels, samplers }) => ({ name, channels: Object.fromEntries(channels.map(({ sampler, target }) =>
    [`${nodes[target.node].name} ${target.path}`, [samplers[sampler].input, samplers[sampler].output].flatMap(numbers)])) }));
}

/** The page's title tells what it fitted a template to, on its own thread and in a worker. */
async function expectRigged(address) {
  const browser = await launch();
  try {
    const page = await browser.newPage();
    await page.goto(address);
    await page.waitForFunction(() => document.title !== 'page', undefined, { timeout: 60000 });
    const rigged = `rigged ${readFileSync(at('person.glb')).length}`;
    assert.equal(await page.title(), `${rigged}, ${rigged}`);
  } finally {
    await browser.close();
  }
}

const cases = {
  async 'Node gets the bytes of the program'() {
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const limber = await load();
    const result = limber.rig(readFileSync(at('model.glb')), 'model.glb', { handles: 12 });
    assert.ok(result.ok);
    run(program, ['rig', 'model.glb', '--handles', '12', '-o', 'program.glb', '--quiet']);
    assert.deepEqual(Buffer.from(result.glb), readFileSync(at('program.glb')));
    assert.equal(result.report.counts.joints, 12);
    const session = limber.createSession();
    assert.ok(session.run({ do: 'open_sample', name: 'stool' }).ok);
    const wrong = session.run({ do: 'set_turn', joint: 'nobody' });
    assert.ok(!wrong.ok && wrong.error.message);
    const broken = limber.rig(new Uint8Array([1, 2, 3]), 'broken.glb');
    assert.ok(!broken.ok && broken.error.where === 'broken.glb');
  },
  async 'errors name options as its own calls do, and progress is told'() {
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const stages = new Set();
    const limber = await load({ onProgress: (stage, fraction) => { assert.ok(fraction >= 0 && fraction <= 1); stages.add(stage.split(':')[0]); } });
    const model = readFileSync(at('model.glb'));
    for (const [options, where, remedy] of [
      [{ existingRig: 'keep-skeleton', handles: 3 }, 'handles', "leave existingRig: 'keep-skeleton' out"], [{ maxInfluences: 9 }, 'maxInfluences', ''],
      [{ up: '+y' }, 'up', "name one: template: 'auto'"], [{ handles: '3' }, 'handles', ''], [{ handels: 3 }, 'handels', null], [{ handles: NaN }, 'handles', ''],
      [{ template: { name: 'own.json', bytes: new Uint8Array([1]) } }, 'own.json', null],
      [{ template: 'nobody' }, 'template', null], [{ pieces: 'nobody' }, 'pieces', null], [{ template: 'humanoid', up: '' }, 'up', ''],
      [{ template: 'humanoid', pins: { head: [0, 1] } }, 'pins', ''], [{ handles: 99999999999 }, 'handles', ''],
      [{ template: { name: 'own.json', bytes: new Uint8Array([1]) }, maxInfluences: 9 }, 'maxInfluences', ''], // before its file is read
      ...[null, { name: '', bytes: new Uint8Array([1]) }, { name: 'own.bvh' }, { bytes: new Uint8Array([1]) }, { name: 'own.bvh', bytes: 'text' }]
        .map((template) => [{ template }, 'template', '']),
      [null, 'options', ''], [{ handles: 3n }, 'options', ''],
    ]) {
      const { ok, error } = limber.rig(model, 'model.glb', options);
      assert.ok(!ok);
      assert.ok(error.where.startsWith(where), JSON.stringify(error));
      if (remedy !== null) assert.equal(error.remedy, remedy);
    }
    for (const wrong of [[undefined, 'model.glb'], ['text'], [model, 3]]) assert.ok(!limber.rig(...wrong).ok);
    const own = readFileSync(at('own.json')), content = own.buffer.slice(own.byteOffset, own.byteOffset + own.length);
    assert.deepEqual(limber.rig(model, 'model.glb', { template: { name: 'own.json', bytes: content } }).glb,
      limber.rig(model, 'model.glb', { template: { name: 'own.json', bytes: own } }).glb);
    stages.clear();
    assert.match(limber.rig(readFileSync(at('person.glb')), 'person.glb').error.remedy, /^existingRig: 'replace' takes it out first/);
    assert.equal(stages.size, 0);
    assert.ok(limber.rig(model, 'model.glb', { handles: 5 }).ok);
    assert.ok(stages.has('rig') && stages.has('skin'), [...stages].join());
    assert.deepEqual(limber.rigChoices().pieces.map(({ name }) => name), ['auto', 'rigid', 'soft']);
  },
  async 'a listener that throws stops its call, and is heard'() {
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const enough = new Error('enough'), model = readFileSync(at('model.glb'));
    let told = 0, throws = true;
    const limber = await load({ onProgress: () => { told += 1; if (throws) throw enough; } });
    const session = limber.createSession();
    for (const call of [() => limber.rig(model, 'model.glb', { handles: 5 }), () => session.run({ do: 'open_sample', name: 'stool' })]) {
      told = 0;
      assert.throws(call, (error) => error === enough);
      assert.equal(told, 1);
    }
    throws = false;
    assert.ok(limber.rig(model, 'model.glb', { handles: 5 }).ok && session.run({ do: 'open_sample', name: 'stool' }).ok);
  },
  async 'its code can be handed over'() {
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const limber = await load({ wasmBinary: readFileSync(at('node_modules/limber/dist/limber_engine.wasm')) });
    assert.ok(limber.methods().rigger.some(({ name }) => name === 'template'));
  },
  async 'the networks that read shapes are read when a template is fitted'() {
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const shapes = at('node_modules/limber/dist/shapes.lrd'), bytes = readFileSync(shapes), model = readFileSync(at('model.glb')), options = { template: 'humanoid' };
    assert.ok(bytes.length < 1.5e6, `${bytes.length} bytes`);
    renameSync(shapes, at('shapes.lrd'));
    try {
      const limber = await load(), worker = await startWorker();
      assert.ok(limber.rig(model, 'model.glb', { handles: 5 }).ok);
      assert.throws(() => limber.rig(model, 'model.glb', options), /no such file.*shapes\.lrd/);
      assert.match((await worker.rig(model, 'model.glb', options)).error.message, /no such file.*shapes\.lrd/);
      const broken = limber.setShapeWeights(new Uint8Array([1, 2, 3]), 'broken.lrd');
      assert.ok(!broken.ok && broken.error.where.startsWith('broken.lrd'));
      assert.ok(limber.setShapeWeights(bytes).ok && (await worker.setShapeWeights(bytes)).ok);
      assert.deepEqual(Buffer.from(limber.rig(model, 'model.glb', options).glb), readFileSync(at('person.glb')));
      assert.ok((await worker.rig(model, 'model.glb', options)).ok);
      worker.stop();
    } finally {
      renameSync(at('shapes.lrd'), shapes);
    }
  },
  'the program of the package rigs, too'() {
    const done = npx('rig', 'model.glb', '-o', 'npx.glb', '--handles', '12', '--json', 'report.json');
    assert.equal(done.status, 0, done.stderr);
    assert.deepEqual(readFileSync(at('npx.glb')), readFileSync(at('program.glb')));
    assert.equal(JSON.parse(readFileSync(at('report.json'))).counts.joints, 12);
    assert.match(npx('--version').stdout, /^limber \d+\.\d+\.\d+\n$/);
  },
  'the program of the package rigs by every option of the native one'() {
    const own = ['--template', 'person.glb'], turned = ['--up', '+y', '--front', '+z', '--upright', '--chains'];
    for (const [model, ...words] of [
      ['model.glb', '--template', 'humanoid', '--pin', 'leftHand=0.71,1.33,0.02', '--pin', 'head=0,1.6,0', ...turned], ['model.glb', ...own, '--max-influences', '2'],
      ['model.glb', '--rigger', 'curve-skeleton', '--skinning', 'envelopes', '--pieces', 'rigid'], ['person.glb', '--keep-skeleton', '--max-influences', '8'],
      ['person.glb', '--replace-rig', '--handles', '9'], ['model.glb', '--template', 'own.json'],
      ['model.glb', '--template', 'humanoid', '--up', '+y', '--front', '-z'], ['model.glb', '--template', 'humanoid', '--up', '-x'],
      ['model.glb', '--template', 'nobody'], ['model.glb', '--pieces', 'nobody'], ['model.glb', '--template', 'humanoid', '--pin', '__proto__=0,1,0'],
      ...['--handles', '--template', '--up', '--skinning', '--json'].map((option) => ['model.glb', option, '']),
    ]) {
      const expected = spawnSync(program, ['rig', model, ...words, '-q', '-o', 'native.glb'], { cwd: work, encoding: 'utf8' });
      const done = npx('rig', model, ...words, '-q', '-o', 'npx.glb');
      assert.equal(done.status, expected.status, `${words}: ${done.stderr}${expected.stderr}`);
      if (expected.status === 0) assert.deepEqual(readFileSync(at('npx.glb')), readFileSync(at('native.glb')), `${words}`);
      assert.equal(done.stderr, expected.stderr.replace('limber rig --help', 'limber --help'));
    }
    const piped = spawnSync('npx', ['--no-install', 'limber', 'rig', '-', '-o', '-', '--handles', '12', '--json', 'piped.json'], { cwd: work, input: readFileSync(at('model.glb')) });
    assert.deepEqual(piped.stdout, readFileSync(at('program.glb')));
    const { limber, command, input, output } = JSON.parse(readFileSync(at('piped.json')));
    assert.deepEqual([command, input, output], ['rig', { file: '-', format: 'glb' }, '-']);
    assert.match(limber, /^\d+\.\d+\.\d+$/);
  },
  'the program of the package retargets: the clips of the native one'() {
    for (const motion of ['walk', 'run']) run(program, ['sample', motion, '-o', `${motion}.bvh`, '--quiet']);
    run(program, ['retarget', 'person.glb', 'walk.bvh', 'run.bvh', '-o', 'two.glb', '--quiet']); // a motion with two clips
    for (const motions of [['walk.bvh', 'run.bvh'], ['two.glb']]) {
      run(program, ['retarget', 'person.glb', ...motions, '-o', 'native.glb', '--quiet']);
      const done = npx('retarget', 'person.glb', ...motions, '-o', 'npx.glb');
      assert.deepEqual([done.status, done.stdout], [0, 'written: npx.glb\n'], done.stderr);
      const clips = clipsIn(readFileSync(at('npx.glb'))), expected = clipsIn(readFileSync(at('native.glb')));
      assert.deepEqual(clips.map(({ name }) => name), ['walk', 'run']);
      for (const [i, { name, channels }] of expected.entries()) {
        assert.equal(clips[i].name, name);
        assert.deepEqual(Object.keys(clips[i].channels).sort(), Object.keys(channels).sort());
        for (const [channel, values] of Object.entries(channels)) {
          assert.ok(values.length > 4 && values.length === clips[i].channels[channel].length, channel);
          values.forEach((value, k) => assert.ok(Math.abs(value - clips[i].channels[channel][k]) < 1e-6, channel));
        }
      }
    }
    for (const [args, code, words] of [
      [['person.glb', '-o', 'x.glb'], 2, 'retarget takes a rigged model, motions and -o OUT.glb'], [['person.glb', 'walk.bvh'], 2, '-o OUT.glb'],
      [['person.glb', 'walk.bvh', '-o', 'x.gltf'], 2, 'a .glb is written'], [['person.glb', 'walk.bvh', '-o', 'x.glb', '--handles', '3'], 2, '--handles is no option of retarget'],
      [['model.glb', 'walk.bvh', '-o', 'x.glb'], 1, 'has no rig to move'], [['person.glb', 'nothing.bvh', '-o', 'x.glb'], 1, 'nothing.bvh: cannot be opened'],
      [['person.glb', 'own.json', '-o', 'x.glb'], 1, 'own.json'], [['walk.bvh', 'walk.bvh', '-o', 'x.glb'], 1, 'walk.bvh'],
    ]) {
      const done = npx('retarget', ...args);
      assert.equal(done.status, code, `${args}: ${done.stderr}`);
      assert.match(done.stderr, /^limber: [^\n]*\n$/);
      assert.ok(done.stderr.includes(words), done.stderr);
      assert.ok(!existsSync(at('x.glb')));
    }
    assert.match(npx('retarget', '--help').stdout, /MODEL\.glb MOTIONS/);
  },
  'its options are those of the native program, in the same words'() {
    const native = optionsIn(run(program, ['rig', '--help'])), here = optionsIn(npx('--help').stdout);
    assert.ok(native.size > 15 && here.size > 10);
    assert.deepEqual([...native.keys()].filter((name) => !here.has(name)).sort(), Object.keys(notOffered).sort());
    for (const [name, words] of here) {
      assert.ok(native.has(name), `--${name} is none of the program's`);
      const told = words.trim().replace(/^[A-Z]+ +/, '');
      if (name !== 'output') assert.ok(native.get(name).includes(told), `--${name}: ${told}`); // the native program writes .gltf, too
    }
    const lists = run(program, ['rig', '--help']);
    for (const [line] of npx('--help').stdout.matchAll(/^  [a-z]+(-[a-z]+)* {2,}\S.*$/gm)) assert.ok(lists.includes(line), line);
  },
  'what the program cannot do is one line, and no file'() {
    writeFileSync(at('garbage.glb'), 'glTF');
    mkdirSync(at('folder.glb'));
    run(program, ['sample', 'stool', '-o', 'lone.glb', '--quiet']); // no template is likely: a warning
    for (const [args, code, words] of [
      [['rig', 'nothing.glb', '-o', 'x.glb'], 1, 'nothing.glb: cannot be opened'], [['rig', 'garbage.glb', '-o', 'x.glb'], 1, 'garbage.glb'],
      [['rig', 'model.glb'], 2, '-o OUT.glb'], [['pose', 'model.glb'], 2, 'there is no command'], [['rig', 'model.glb', '-o', 'x.glb', '--handles', 'many'], 2, '--handles'],
      [['rig', 'model.glb', '-o', 'x.glb', '--pin', 'head=0,1,0'], 2, '--pin: takes a template to fit (name one: --template auto)'],
      [['rig', 'model.glb', '-o', 'x.glb', '--template', 'auto', '--pin', 'head=0,1'], 2, '--pin takes JOINT=x,y,z'],
      [['rig', 'model.glb', '-o', 'x.glb', '--max-influences', '9'], 2, '--max-influences: takes 1 to 8'], [['rig', 'model.glb', '-o', 'x.glb', '--up', '+w'], 2, '--up'],
      [['rig', 'person.glb', '-o', 'x.glb'], 1, '--replace-rig takes it out first'], [['rig', 'person.glb', '-o', 'x.glb', '--keep-skeleton', '--replace-rig'], 2, 'excludes'],
      [['rig', 'person.glb', '-o', 'x.glb', '--keep-skeleton', '--handles', '4'], 2, 'leave --keep-skeleton out'],
      [['rig', 'model.glb', '-o', 'x.glb', '--template', 'nothing.bvh'], 1, 'nothing.bvh: cannot be opened'],
      [['rig', 'model.glb', '-o', 'x.glb', '--template', 'garbage.glb'], 1, 'garbage.glb'], [['rig', 'lone.glb', '-o', 'x.glb', '--template', 'auto', '--strict'], 1, '--strict'],
      [['rig', 'model.glb', '-o', 'x.glb', '--rigger', 'nobody'], 1, 'nobody'], [['rig', 'model.glb', '-o', 'x.glb', '--colour'], 2, '--colour'],
      [['rig', 'model.glb', '-o', 'x.obj'], 2, 'a .glb is written'], [['rig', 'model.glb', '-o', 'x.glb', '--json', './x.glb'], 2, '--json'],
      [['rig', 'model.glb', '-o', 'x.glb', '--json', 'no/such/folder.json'], 1, 'no/such/folder.json: cannot be written: no such file'],
      [['rig', 'model.glb', '-o', 'no/such/x.glb', '--json', 'left.json', '--handles', '5'], 1, 'no/such/x.glb: cannot be written'],
      [['rig', 'model.glb', '-o', 'folder.glb', '--json', 'left.json', '--handles', '5'], 1, 'folder.glb: is a folder, not a file'],
      [['rig', 'model.glb', '-o', 'x.glb', '--handles', '3', '--handles', '5'], 2, '--handles: is given twice'], [['rig', 'model.glb', '-o', 'x.glb', '--handles', '-1'], 2, '--handles'],
      [['rig', 'model.glb', '-o', 'x.glb', '--handles', '99999999999'], 2, '--handles'], [['rig', 'model.glb', '-o', 'x.glb', '--up'], 2, '--up'],
    ]) {
      const done = npx(...args);
      assert.equal(done.status, code, `${args}: ${done.stderr}`);
      assert.match(done.stderr, /^limber: [^\n]*\n$/);
      assert.ok(done.stderr.includes(words), done.stderr);
      assert.ok(!existsSync(at('x.glb')) && !existsSync(at('left.json')), `${args}`);
    }
    assert.deepEqual(readdirSync(work).filter((name) => name.endsWith('.part')), []);
    const cut = spawnSync('bash', ['-o', 'pipefail', '-c', 'npx --no-install limber rig model.glb --handles 12 -o - | head -c 10 | wc -c'], { cwd: work, encoding: 'utf8' });
    assert.deepEqual([cut.status, cut.stdout.trim(), cut.stderr], [141, '10', '']);
  },
  async 'in a worker: the same answers, while this thread goes on'() {
    const worker = await startWorker(), model = readFileSync(at('model.glb')), stages = new Set();
    let ticks = 0;
    const ticking = setInterval(() => { ticks += 1; }, 1);
    const result = await worker.rig(model, 'model.glb', { handles: 12 }, { onProgress: (stage) => stages.add(stage.split(':')[0]) });
    clearInterval(ticking);
    assert.ok(result.ok && ticks > 10 && stages.size > 0, `${ticks} ticks, ${[...stages]}`);
    assert.deepEqual(Buffer.from(result.glb), readFileSync(at('program.glb')));
    assert.deepEqual(model, readFileSync(at('model.glb'))); // files are copied, not handed over
    const { ok, error } = await worker.rig(model, 'model.glb', { up: '+y' });
    assert.ok(!ok && error.where === 'up');
    assert.ok((await worker.methods()).rigger.length > 1);
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const limber = await load(), here = limber.createSession(), session = await worker.createSession(), other = await worker.createSession();
    assert.deepEqual(Object.keys(worker).filter((name) => name !== 'stop').sort(), Object.keys(limber).filter((name) => name !== 'forkSession').sort());
    assert.deepEqual(Object.keys(session).filter((name) => name !== 'fork').sort(), Object.keys(here).filter((name) => name !== 'handle').sort());
    for (const command of [{ do: 'open_sample', name: 'stool' }, { do: 'set_handles', count: 5 }, { do: 'undo' }, { do: 'set_turn', joint: 'nobody' }]) {
      assert.deepEqual(await session.run(command), here.run(command));
    }
    assert.deepEqual(await session.model(), here.model());
    const { check } = here.rigCheck();
    assert.deepEqual([(await session.rigCheck()).check, check.pose, check.advice[0].kind], [check, null, 'no-template']);
    assert.deepEqual((await session.export('glb')).bytes, here.export('glb').bytes);
    const fork = await session.fork();
    assert.ok((await fork.run({ do: 'set_handles', count: 4 })).ok);
    assert.deepEqual(await session.record(), here.record());
    assert.ok(!(await other.run({ do: 'undo' })).ok);
    await other.free();
    const freed = await other.run({ do: 'undo' });
    assert.equal(freed.error.message, 'the session was freed');
    await assert.rejects(other.record(), ({ error: { message } }) => message === 'the session was freed');
    await other.free();
    const uncopied = await worker.rig(model, 'model.glb', { handles: () => 5 });
    assert.ok(!uncopied.ok && uncopied.error.code === 'bad-argument' && uncopied.error.where === 'rig');
    assert.ok((await worker.methods()).rigger.length > 1);
    worker.stop();
  },
  async 'a worker that is stopped says so, and goes on anew'() {
    const worker = await startWorker(), model = readFileSync(at('model.glb')), cancelled = (answer) => !answer.ok && answer.error.code === 'cancelled';
    const session = await worker.createSession(), stopping = new AbortController();
    const slow = worker.rig(model, 'model.glb', { template: 'auto' }, { signal: stopping.signal, onProgress: () => stopping.abort() });
    const behind = session.run({ do: 'open_sample', name: 'stool' });
    assert.ok(cancelled(await slow) && cancelled(await behind) && cancelled(await session.run({ do: 'undo' })));
    assert.ok(cancelled(await worker.rig(model, 'model.glb', {}, { signal: stopping.signal })));
    assert.ok((await worker.rig(model, 'model.glb', { handles: 5 }, { signal: new AbortController().signal })).ok);
    const waiting = worker.createSession();
    worker.stop();
    await assert.rejects(waiting, (error) => error.error.code === 'cancelled');
    await session.free();
    const broken = await (await startWorker({ wasmBinary: new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]) })).rig(model, 'model.glb'); // a module without content
    assert.ok(!broken.ok && broken.error.code === 'worker');
    const enough = new Error('enough'), behindIt = worker.rig(model, 'model.glb', {}, { onProgress: () => { throw enough; } }), next = worker.rig(model, 'model.glb', { handles: 5 });
    await assert.rejects(behindIt, (error) => error === enough);
    assert.ok(cancelled(await next) && (await worker.rig(model, 'model.glb', { handles: 5 })).ok);
    worker.stop();
    writeFileSync(at('ends.mjs'), `import { startWorker } from 'limber/worker';
      const worker = await startWorker();
      console.log(!(await worker.rig(new Uint8Array(), 'a.glb', { handles: () => 5 })).ok && (await worker.methods()).rigger.length > 1);`);
    assert.equal(run('node', ['ends.mjs'], { timeout: 60000 }), 'true\n'); // although nobody stopped it
  },
  async 'a worker that cannot start, or ends by itself, says so'() {
    const { connect, WorkerError } = await import(pathToFileURL(at('node_modules/limber/dist/worker/client.mjs')));
    const unstarted = connect(() => { throw new Error('no threads here'); }, null), said = /^the worker broke: no threads here$/;
    for (let i = 0; i < 2; i += 1) assert.match((await unstarted.rig(new Uint8Array(), 'a.glb')).error.message, said);
    await assert.rejects(unstarted.methods(), (error) => error instanceof WorkerError && said.test(error.message));
    const killed = connect((tell, broken) => ({ post: ({ id }) => id && setTimeout(broken, 1, 'it ended with code 1'), stop() {}, hold() {} }), null);
    for (let i = 0; i < 2; i += 1) assert.match((await killed.rig(new Uint8Array(), 'a.glb')).error.message, /it ended with code 1/);
  },
  'a misspelt field does not compile'() {
    // Each line below "@ts-expect-error" has to be wrong, all others right.
    writeFileSync(at('use.ts'), `import { load, type Command } from 'limber';
      import { startWorker, WorkerError, type RigResult } from 'limber/worker';
      const worker = await startWorker(), remote = await worker.createSession(), text: string = new WorkerError({ code: '', message: '', where: '', remedy: '' }).error.code;
      const rigged: RigResult = await worker.rig(new Uint8Array(), 'a.glb', { pins: { head: [0, 1, 2] }, up: '+y' }, { onProgress: (stage, fraction) => stage.at(fraction) });
      const turned = await remote.run({ do: 'set_turn', joint: 'head', turn: [0, 30, 0], relative: true });
      if (turned.ok) { const skin: Float32Array = turned.skin; } else { const remedy: string = turned.error.remedy; }
      const checked = await remote.rigCheck(), pose: 'T' | 'A' | 'hanging' | 'other' | null = checked.ok ? checked.check.pose : null;
      const names: string[] = (await worker.rigChoices()).template.map(({ name }) => name);
      const limber = await load(), session = limber.createSession();
      session.run({ do: 'set_turn', joint: 'head', turn: [0, 30, 0], relative: true });
      const list: Command[] = [{ do: 'undo' }, { do: 'begin_drag', joint: 'head', mode: 'turn' }];
      const result = limber.rig(new Uint8Array(), 'a.glb', { handles: 3 });
      if (result.ok) { const glb: Uint8Array = result.glb; } else { const text: string = result.error.remedy; }
      ${["session.run({ do: 'set_turn', joint: 'head', turns: [0, 1, 0] });", "session.run({ do: 'set_turn', turn: [0, 30, 0] });",
      "session.run({ do: 'set_turns', joint: 'head' });", "session.run({ do: 'begin_drag', joint: 'head', mode: 'twist' });",
      "session.run({ do: 'place_joint', joint: 'head', position: [0, 1] });", "limber.rig(new Uint8Array(), 'a.glb', { handle: 3 });",
      "await worker.rig(new Uint8Array(), 'a.glb', { handle: 3 });", "await remote.run({ do: 'set_turn', turn: [0, 30, 0] });", "remote.handle;",
      "await worker.createSession(3);", "limber.rig(new Uint8Array(), 'a.glb', { up: '+w' });", "limber.rig(new Uint8Array(), 'a.glb', { pins: { head: [0, 1] } });",
      "limber.rig(new Uint8Array(), 'a.glb', { existingRig: 'keep' });", "limber.rig(new Uint8Array(), 'a.glb', { template: { name: 'own.bvh' } });",
    ].map((wrong) => `// @ts-expect-error\n${wrong}`).join('\n')}`);
    for (const more of [['--module', 'nodenext', '--moduleResolution', 'nodenext'], ['--module', 'esnext', '--moduleResolution', 'bundler']]) {
      const done = spawnSync(join(tools, '.bin/tsc'), ['--noEmit', '--strict', '--target', 'es2022', ...more, 'use.ts'], { cwd: work, encoding: 'utf8' });
      assert.equal(done.status, 0, done.stdout);
    }
  },
  async 'a page made by vite rigs with it'() {
    mkdirSync(at('page'), { recursive: true });
    writeFileSync(at('page/index.html'), '<!doctype html><title>page</title><script type="module" src="./main.js"></script>');
    writeFileSync(at('page/main.js'), `import { load } from 'limber';
      import { startWorker } from 'limber/worker';
      const model = new Uint8Array(await (await fetch('./model.glb')).arrayBuffer());
      const told = (result) => (result.ok ? 'rigged ' + result.glb.length : result.error.message);
      const options = { template: 'humanoid' }, here = told((await load()).rig(model, 'model.glb', options));
      document.title = here + ', ' + told(await (await startWorker()).rig(model, 'model.glb', options));`);
    mkdirSync(at('page/public'), { recursive: true });
    writeFileSync(at('page/public/model.glb'), readFileSync(at('model.glb')));
    run(join(tools, '.bin/vite'), ['build', 'page', '--outDir', at('built'), '--base', './', '--logLevel', 'error']);
    const server = await serve(at('built'));
    try {
      await expectRigged(server.address);
    } finally {
      server.close();
    }
  },
  async 'so does a page that vite serves while it is written'() {
    const server = spawn(join(tools, '.bin/vite'), ['page', '--host', '127.0.0.1', '--port', '5270'], { cwd: work, env: { ...process.env, NO_COLOR: '1' } });
    try {
      const address = await new Promise((resolve, reject) => {
        let told = '';
        server.stdout.on('data', (text) => {
          told += text;
          const [found] = told.match(/http:\/\/127\.0\.0\.1:\d+\//) ?? [];
          if (found) resolve(found);
        });
        server.on('exit', () => reject(new Error(`vite: ${told}`)));
      });
      await expectRigged(address);
    } finally {
      server.kill();
    }
  },
};

let passed = 0, failed = 0;
for (const [name, test] of Object.entries(cases)) {
  try {
    await test();
    passed += 1;
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${name}: ${error.stack}`);
  }
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
