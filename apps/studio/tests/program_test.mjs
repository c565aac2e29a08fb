// The page out of the program: limber studio.
//
//   node apps/studio/tests/program_test.mjs PROGRAM DIST
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { request } from 'node:http';
import { join, relative, resolve } from 'node:path';

const [program, dist] = process.argv.slice(2).map((path) => resolve(path));
const server = spawn(program, ['studio', '--port', '0'], { stdio: ['ignore', 'pipe', 'inherit'] });
const address = await new Promise((found, failed) => {
  server.stdout.on('data', (text) => { const at = /http:\S+/.exec(text); if (at) found(at[0]); });
  server.on('exit', (code) => failed(new Error(`ended at once: ${code}`)));
});
const port = Number(new URL(address).port);

/** As it is written: fetch would tidy the path up. */
const get = (path, { headers = {}, method = 'GET' } = {}) => new Promise((done, failed) => request({ host: '127.0.0.1', port, path, headers, method }, (response) => {
  const parts = [];
  response.on('data', (part) => parts.push(part));
  response.on('end', () => done({ status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) }));
}).on('error', failed).end());

const cases = {
  async 'it listens on the loopback address alone'() {
    assert.equal(new URL(address).hostname, '127.0.0.1');
    const listening = readFileSync('/proc/net/tcp', 'utf8').split('\n').map((line) => line.trim().split(/\s+/))
      .filter(([, local, , state]) => state === '0A' && parseInt(local.split(':')[1], 16) === port);
    assert.deepEqual(listening.map(([, local]) => local.split(':')[0]), ['0100007F']);
  },
  async 'every file of the page comes as it was built, with its type'() {
    const types = { html: /^text\/html/, js: /^text\/javascript/, css: /^text\/css/, wasm: /^application\/wasm$/, zst: /^application\/octet-stream$/,
      lrd: /^application\/octet-stream$/,
      png: /^image\/png$/, webmanifest: /^application\/manifest\+json$/ };
    const files = readdirSync(dist, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
    assert.ok(files.length >= 4);
    for (const entry of files) {
      const path = join(entry.parentPath, entry.name);
      const { status, headers, body } = await get(`/${relative(dist, path)}`);
      assert.equal(status, 200, path);
      assert.ok(body.equals(readFileSync(path)), `${path} differs`);
      assert.match(headers['content-type'], types[entry.name.split('.').pop()]);
      assert.equal(headers['cross-origin-opener-policy'], 'same-origin');
    }
    assert.ok((await get('/')).body.equals(readFileSync(join(dist, 'index.html'))));
  },
  async 'nothing else comes'() {
    for (const path of ['/no', '/../CMakeLists.txt', '/assets/', '/%2e%2e/etc/passwd', '/index.html/']) {
      assert.equal((await get(path)).status, 404, path);
    }
  },
  async 'a page of another site is not answered, whatever name it gives this machine'() {
    for (const host of ['evil.example', `evil.example:${port}`, `127.0.0.1.evil.example:${port}`, `192.168.1.1:${port}`]) {
      assert.equal((await get('/', { headers: { host } })).status, 403, host);
    }
    assert.equal((await get('/', { headers: { host: `127.0.0.1:${port}`, origin: 'https://evil.example' } })).status, 403);
    assert.equal((await get('/', { headers: { host: `localhost:${port}`, origin: `http://localhost:${port}` } })).status, 200);
    assert.equal((await get('/', { headers: { host: 'localhost:9000' } })).status, 200, 'a port that is forwarded');
  },
  async 'it is only read from'() {
    assert.equal((await get('/', { method: 'HEAD' })).status, 200);
    for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS']) assert.equal((await get('/', { method })).status, 405, method);
  },
  async 'a port that is taken is told'() {
    const second = spawnSync(program, ['studio', '--port', String(port)], { encoding: 'utf8', timeout: 10_000 });
    assert.equal(second.status, 1);
    assert.match(second.stderr, /port/);
  },
  async 'an interrupt ends it'() {
    const ended = new Promise((done) => server.once('exit', (code) => done(code)));
    server.kill('SIGINT');
    assert.equal(await ended, 0);
  },
};

let passed = 0, failed = 0;
for (const [name, run] of Object.entries(cases)) {
  try {
    await run();
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`FAILED ${name}: ${error.stack}`);
  }
}
server.kill();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
