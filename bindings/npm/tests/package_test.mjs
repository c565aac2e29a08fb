// The packed npm package as somebody else installs it: in Node, as a program, in TypeScript, in a page made by vite.
//
//   node bindings/npm/tests/package_test.mjs PACKAGE.tgz LIMBER WORK_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const [tarball, program, work] = process.argv.slice(2).map((path) => resolve(path));
const tools = join(dirname(fileURLToPath(import.meta.url)), '../../../apps/studio/node_modules');
rmSync(work, { recursive: true, force: true });
mkdirSync(work, { recursive: true });
const at = (name) => join(work, name);
const run = (command, args, options = {}) => execFileSync(command, args, { cwd: work, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], ...options });
writeFileSync(at('package.json'), '{"name": "somebody", "private": true, "type": "module"}');
run('npm', ['install', '--offline', '--silent', '--no-audit', '--no-fund', tarball]);
run(program, ['sample', 'biped', '-o', 'model.glb', '--quiet']);
const npx = (...args) => spawnSync('npx', ['--no-install', 'limber', ...args], { cwd: work, encoding: 'utf8' });

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
    const wrong = session.run({ do: 'turn_joint', joint: 'nobody' });
    assert.ok(!wrong.ok && wrong.error.message);
    const broken = limber.rig(new Uint8Array([1, 2, 3]), 'broken.glb');
    assert.ok(!broken.ok && broken.error.where === 'broken.glb');
  },
  async 'its code can be handed over'() {
    const { load } = await import(pathToFileURL(at('node_modules/limber/dist/index.mjs')));
    const limber = await load({ wasmBinary: readFileSync(at('node_modules/limber/dist/limber_engine.wasm')) });
    assert.ok(limber.methods().rigger.some(({ name }) => name === 'template'));
  },
  'the program of the package rigs, too'() {
    const done = npx('rig', 'model.glb', '-o', 'npx.glb', '--handles', '12', '--json', 'report.json');
    assert.equal(done.status, 0, done.stderr);
    assert.deepEqual(readFileSync(at('npx.glb')), readFileSync(at('program.glb')));
    assert.equal(JSON.parse(readFileSync(at('report.json'))).counts.joints, 12);
    assert.match(npx('--version').stdout, /^limber \d+\.\d+\.\d+\n$/);
    assert.match(npx('--help').stdout, /--handles N/);
  },
  'what the program cannot do is one line, and no file'() {
    writeFileSync(at('garbage.glb'), 'glTF');
    for (const [args, code, words] of [
      [['rig', 'nothing.glb', '-o', 'x.glb'], 1, 'nothing.glb: cannot be opened'], [['rig', 'garbage.glb', '-o', 'x.glb'], 1, 'garbage.glb'],
      [['rig', 'model.glb'], 2, '-o OUT.glb'], [['pose', 'model.glb'], 2, 'there is no command'], [['rig', 'model.glb', '-o', 'x.glb', '--handles', 'many'], 2, '--handles'],
      [['rig', 'model.glb', '-o', 'x.glb', '--rigger', 'nobody'], 1, 'nobody'], [['rig', 'model.glb', '-o', 'x.glb', '--colour'], 2, '--colour'],
      [['rig', 'model.glb', '-o', 'x.obj'], 2, 'a .glb is written'], [['rig', 'model.glb', '-o', 'x.glb', '--json', './x.glb'], 2, '--json'],
      [['rig', 'model.glb', '-o', 'x.glb', '--json', 'no/such/folder.json'], 1, 'no/such'],
    ]) {
      const done = npx(...args);
      assert.equal(done.status, code, `${args}: ${done.stderr}`);
      assert.match(done.stderr, /^limber: [^\n]*\n$/);
      assert.ok(done.stderr.includes(words), done.stderr);
      assert.ok(!existsSync(at('x.glb')));
    }
  },
  'a misspelt field does not compile'() {
    // Each line below "@ts-expect-error" has to be wrong, all others right.
    writeFileSync(at('use.ts'), `import { load, type Command } from 'limber';
      const limber = await load(), session = limber.createSession();
      session.run({ do: 'turn_joint', joint: 'head', axis: [0, 1, 0], degrees: 30 });
      const list: Command[] = [{ do: 'undo' }, { do: 'begin_drag', joint: 'head', mode: 'turn' }];
      const result = limber.rig(new Uint8Array(), 'a.glb', { handles: 3 });
      if (result.ok) { const glb: Uint8Array = result.glb; } else { const text: string = result.error.remedy; }
      ${["session.run({ do: 'turn_joint', joint: 'head', axes: [0, 1, 0] });", "session.run({ do: 'turn_joint', degrees: 30 });",
      "session.run({ do: 'turn_joints', joint: 'head' });", "session.run({ do: 'begin_drag', joint: 'head', mode: 'twist' });",
      "session.run({ do: 'move_joint', joint: 'head', offset: [0, 1] });", "limber.rig(new Uint8Array(), 'a.glb', { handle: 3 });",
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
      const limber = await load();
      const result = limber.rig(new Uint8Array(await (await fetch('./model.glb')).arrayBuffer()), 'model.glb', { handles: 12 });
      document.title = result.ok ? 'rigged ' + result.glb.length : result.error.message;`);
    mkdirSync(at('page/public'), { recursive: true });
    writeFileSync(at('page/public/model.glb'), readFileSync(at('model.glb')));
    run(join(tools, '.bin/vite'), ['build', 'page', '--outDir', at('built'), '--base', './', '--logLevel', 'error']);
    const { launch, serve } = await import('../../../apps/studio/tests/page.mjs');
    const server = await serve(at('built')), browser = await launch();
    try {
      const page = await browser.newPage();
      await page.goto(server.address);
      await page.waitForFunction(() => document.title !== 'page', undefined, { timeout: 60000 });
      assert.equal(await page.title(), `rigged ${readFileSync(at('program.glb')).length}`);
    } finally {
      await browser.close();
      server.close();
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
