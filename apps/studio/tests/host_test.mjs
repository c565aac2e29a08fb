// limber studio --host: the page for a phone in the same network, here on addresses of this machine alone.
//
//   node apps/studio/tests/host_test.mjs PROGRAM DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { X509Certificate } from 'node:crypto';
import { chmodSync, existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { request } from 'node:https';
import { networkInterfaces } from 'node:os';
import { join, resolve } from 'node:path';
import { connect } from 'node:tls';
import jsQR from 'jsqr';
import { jointPosition, launch, openStudio, runCases, sessionState, settled } from './page.mjs';

const [program, dist, output] = process.argv.slice(2).map((path) => resolve(path));
const data = join(output, 'host_data'), pem = join(data, 'limber/studio.pem');
rmSync(data, { recursive: true, force: true });
mkdirSync(data, { recursive: true });

const environment = { ...process.env, XDG_DATA_HOME: data };
const running = new Set();

/** The program once it listens, with what it has printed. */
async function start(...options) {
  const child = spawn(program, ['studio', '--port', '0', '--host', ...options], { stdio: ['ignore', 'pipe', 'inherit'], env: environment });
  running.add(child);
  const server = { child, said: '', ended: new Promise((done) => child.once('exit', (code) => done(code))) };
  await new Promise((done, failed) => {
    child.stdout.on('data', (text) => { server.said += text; if (/fingerprint [0-9A-F:]{95}\n/.test(server.said)) done(); });
    child.on('exit', (code) => failed(new Error(`ended at once: ${code}`)));
  });
  server.address = new URL(/https:\S+/.exec(server.said)[0]);
  return server;
}

async function stop(server) {
  const begun = Date.now();
  server.child.kill('SIGINT');
  assert.equal(await server.ended, 0);
  running.delete(server.child);
  return Date.now() - begun;
}

/** A path as it is written; what a browser adds is up to the case. */
const ask = (server, path, { headers = {}, method = 'GET', body } = {}) => new Promise((done, failed) => {
  const { hostname, port } = server.address;
  const sent = request({ host: hostname.replace(/[[\]]/g, ''), port, path, method, headers, rejectUnauthorized: false, agent: false }, (response) => {
    const parts = [];
    response.on('data', (part) => parts.push(part));
    response.on('end', () => done({ status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) }));
  }).on('error', failed);
  sent.end(body);
});

const cookieOf = (answer) => answer.headers['set-cookie'][0].split(';')[0];

/** What a camera sees of the half blocks in the text. */
function readCode(text) {
  const lines = text.split('\n').filter((line) => /^[ \u2580\u2584\u2588]{25,}$/.test(line));
  const scale = 4, width = lines[0].length * scale, height = 2 * lines.length * scale, pixels = new Uint8ClampedArray(4 * width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const row = Math.floor(y / scale), letter = lines[row >> 1][Math.floor(x / scale)];
      const dark = letter === '\u2588' || letter === (row % 2 === 0 ? '\u2580' : '\u2584');
      pixels.set(dark ? [0, 0, 0, 255] : [255, 255, 255, 255], 4 * (y * width + x));
    }
  }
  return jsQR(pixels, width, height, { inversionAttempts: 'dontInvert' })?.data;
}

const certificate = () => new X509Certificate(readFileSync(pem));
const server = await start('127.0.0.1');
const { port } = server.address, name = `127.0.0.1:${port}`;
let cookie, browser, shown = { screenshot: async () => {} };

const cases = {
  async 'the code in the terminal is the address'() {
    assert.equal(readCode(server.said), server.address.href);
    assert.match(server.address.href, /^https:\/\/127\.0\.0\.1:\d+\/join\/[\w-]{22}$/);
  },
  async 'the certificate is made once, for this address, and its key is the user\'s alone'() {
    const { subjectAltName, fingerprint256, validTo, ca, publicKey } = certificate();
    assert.ok(subjectAltName.split(', ').includes('IP Address:127.0.0.1'), subjectAltName);
    assert.equal(ca, false);
    assert.equal(publicKey.asymmetricKeyDetails.namedCurve, 'prime256v1');
    const days = (Date.parse(validTo) - Date.now()) / 86_400_000;
    assert.ok(days > 300 && days < 398, `${days} days`);
    assert.ok(server.said.includes(fingerprint256));
    assert.equal(statSync(pem).mode & 0o777, 0o600);
    assert.equal(statSync(join(data, 'limber')).mode & 0o777, 0o700);
    const again = await start('127.0.0.1');
    assert.equal(certificate().fingerprint256, fingerprint256);
    assert.notEqual(again.address.pathname, server.address.pathname, 'each run has a token of its own');
    await stop(again);
  },
  async 'it is made anew where it does not serve: others could read it, damaged, for other addresses'() {
    const whole = readFileSync(pem);
    const madeAnew = async (address = '127.0.0.1') => {
      const before = readFileSync(pem);
      const other = await start(address);
      await stop(other);
      assert.equal(statSync(pem).mode & 0o777, 0o600);
      return !readFileSync(pem).equals(before);
    };
    chmodSync(pem, 0o640);
    assert.ok(await madeAnew());
    for (const damage of [Buffer.alloc(0), whole.subarray(0, whole.length / 2), Buffer.from('-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n')]) {
      writeFileSync(pem, damage);
      assert.ok(await madeAnew());
    }
    assert.ok(!await madeAnew());
    assert.ok(await madeAnew('127.0.0.2'));
    assert.ok(certificate().subjectAltName.includes('127.0.0.2'));
    const endsSoon = spawnSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-days', '1',
      '-subj', '/CN=limber', '-addext', 'subjectAltName=IP:127.0.0.1', '-keyout', '-', '-out', '-'], { encoding: 'utf8' });
    if (endsSoon.status !== 0) return console.log('no openssl program here: a certificate on its last day is not tried');
    writeFileSync(pem, endsSoon.stdout);
    assert.ok(await madeAnew());
  },
  async 'without a cookie there is nothing but what to do'() {
    for (const path of ['/', '/index.html', '/manifest.webmanifest', '/service_worker.js', '/no', '/join/', '/join/AAAAAAAAAAAAAAAAAAAAAA', `${server.address.pathname}x`]) {
      const { status, body, headers } = await ask(server, path);
      assert.equal(status, 403, path);
      assert.match(body.toString(), /limber studio --host/);
      assert.equal(headers['set-cookie'], undefined);
      assert.ok(!body.includes('<script'));
    }
  },
  async 'another Host or Origin is refused before the token is looked at'() {
    for (const host of ['evil.example', `evil.example:${port}`, `localhost:${port}`, `127.0.0.1.evil.example:${port}`, `127.0.0.2:${port}`]) {
      assert.equal((await ask(server, server.address.pathname, { headers: { host } })).status, 403, host);
    }
    for (const origin of ['https://evil.example', 'null', `http://${name}`, `https://127.0.0.2:${port}`]) {
      assert.equal((await ask(server, server.address.pathname, { headers: { origin } })).status, 403, origin);
    }
  },
  async 'the token is exchanged once for a cookie, and a look at it does not use it up'() {
    assert.equal((await ask(server, server.address.pathname, { method: 'HEAD' })).status, 403);
    const answer = await ask(server, server.address.pathname);
    assert.equal(answer.status, 303);
    assert.equal(answer.headers.location, '/');
    assert.match(answer.headers['set-cookie'][0], /^__Host-limber-\d+=[\w-]{43}; Path=\/; Secure; HttpOnly; SameSite=Lax$/);
    cookie = cookieOf(answer);
    const second = await ask(server, server.address.pathname);
    assert.equal(second.status, 403);
    assert.match(second.body.toString(), /used up[^]*--devices[^]*verbraucht/);
    assert.equal((await ask(server, server.address.pathname, { headers: { cookie } })).status, 303, 'whoever is in stays in');
    for (const other of [cookie.slice(0, -1), `${cookie}x`, cookie.replace(/=.*/, '=')]) {
      assert.equal((await ask(server, '/', { headers: { cookie: other } })).status, 403);
    }
    assert.match(server.said, /127\.0\.0\.1 was let in \(1 of 1\)/);
  },
  async 'with the cookie come the page\'s files, with what protects them, and nothing else'() {
    const { status, headers, body } = await ask(server, '/', { headers: { cookie, origin: `https://${name}` } });
    assert.equal(status, 200);
    assert.ok(body.equals(readFileSync(join(dist, 'index.html'))));
    assert.match(headers['content-security-policy'], /default-src 'none'.*frame-ancestors 'none'/);
    assert.ok(!/unsafe-inline|unsafe-eval'/.test(headers['content-security-policy'].replace('wasm-unsafe-eval', '')));
    assert.equal(headers['x-content-type-options'], 'nosniff');
    assert.equal(headers['referrer-policy'], 'no-referrer');
    for (const path of ['/no', '/../CMakeLists.txt', '/assets/', '/%2e%2e/etc/passwd', '/index.html/', '//etc/passwd', '/limber/studio.pem']) {
      assert.equal((await ask(server, path, { headers: { cookie } })).status, 404, path);
    }
    assert.equal((await ask(server, '/', { headers: { cookie }, method: 'HEAD' })).body.length, 0);
    for (const method of ['POST', 'PUT', 'DELETE', 'OPTIONS', 'PATCH']) {
      const refused = await ask(server, '/', { headers: { cookie }, method, body: 'x'.repeat(1000) });
      assert.equal(refused.status, 405, method);
      assert.equal(refused.headers.allow, 'GET, HEAD');
    }
  },
  async 'a request that is too long or too slow is dropped, others are answered meanwhile'() {
    const raw = (text, patience) => new Promise((done) => {
      let answer = '';
      const socket = connect({ host: '127.0.0.1', port, rejectUnauthorized: false }, () => socket.write(text));
      socket.setTimeout(patience, () => { socket.destroy(); done('still open'); });
      socket.on('data', (part) => { answer += part; });
      socket.on('error', () => {});
      socket.on('close', () => done(answer || 'dropped'));
    });
    const start = `GET / HTTP/1.1\r\nHost: ${name}\r\n`;
    const many = Array.from({ length: 3000 }, (_, i) => `X-${i}: aaaaaaaaaa\r\n`).join('');
    assert.match(await raw(`${start}${many}\r\n`, 30_000), /dropped|400/);
    assert.match(await raw(`${'G'.repeat(100_000)}\r\n\r\n`, 30_000), /dropped|4\d\d/);
    const slow = Array.from({ length: 20 }, () => raw(start, 60_000)); // never ends its headers
    assert.equal((await ask(server, '/', { headers: { cookie } })).status, 200);
    assert.ok((await Promise.all(slow)).every((answer) => /dropped|400/.test(answer)));
    // Neither is plain http answered with anything of the page.
    const plain = await new Promise((done) => {
      let answer = '';
      fetch(`http://${name}/`).then((got) => got.text()).catch(() => '').then((text) => { answer = text; done(answer); });
    });
    assert.equal(plain, '');
  },
  async 'the page runs in a browser, in a secure context with the camera in reach'() {
    browser = await launch();
    const phone = await start('127.0.0.1');
    const { page, context, errors } = await openStudio(browser, phone.address.href, { ignoreHTTPSErrors: true, serviceWorkers: 'allow', width: 412, height: 860, touch: true });
    shown = page;
    assert.equal(page.url(), new URL('/', phone.address).href, 'the token is gone from the address');
    const facts = await page.evaluate(() => ({
      secure: isSecureContext, camera: typeof navigator.mediaDevices?.getUserMedia, isolated: crossOriginIsolated, cookies: document.cookie,
      allowed: document.featurePolicy?.allowsFeature('camera'),
    }));
    assert.deepEqual(facts, { secure: true, camera: 'function', isolated: true, cookies: '', allowed: true });
    const { joints } = await sessionState(page), last = joints.at(-1).name, before = await jointPosition(page, last);
    await page.evaluate((joint) => globalThis.limberStudio.position(joint), last);
    await page.locator('.joints li').last().click();
    await page.keyboard.press('ArrowUp');
    await settled(page);
    await page.reload();
    await settled(page);
    assert.ok(before.length === 3 && (await sessionState(page)).joints.length === joints.length);
    const manifest = await page.evaluate(async () => (await fetch(document.querySelector('link[rel=manifest]').href)).status);
    assert.equal(manifest, 200);
    const devtools = await context.newCDPSession(page);
    assert.deepEqual((await devtools.send('Page.getAppManifest')).errors, []);
    // The page runs under its own policy; the refused service worker of an untrusted certificate is no error of it.
    assert.deepEqual(errors.filter((text) => !/service.?worker|SSL certificate/i.test(text)), []);
    const stranger = await browser.newContext({ ignoreHTTPSErrors: true }), door = await stranger.newPage();
    assert.equal((await door.goto(phone.address.href)).status(), 403);
    assert.match(await door.locator('h1').first().textContent(), /used up/);
    await stranger.close();
    assert.ok(await stop(phone) < 5000, 'with the browser\'s connections open');
    await context.close();
  },
  async 'once the certificate is trusted, the page is kept for offline use as well'() {
    const spki = spawnSync('sh', ['-c', `openssl x509 -in '${pem}' -pubkey -noout | openssl pkey -pubin -outform der | openssl dgst -sha256 -binary | base64`], { encoding: 'utf8' }).stdout.trim();
    if (!spki) return console.log('no openssl program here: a trusted certificate is not tried');
    const phone = await start('127.0.0.1'), trusting = await launch({ options: [`--ignore-certificate-errors-spki-list=${spki}`] });
    const { page, context } = await openStudio(trusting, phone.address.href, { serviceWorkers: 'allow' });
    shown = page;
    await page.waitForFunction(() => navigator.serviceWorker.controller?.state === 'activated');
    await stop(phone);
    const other = await context.newPage();
    await other.goto(new URL('/', phone.address).href);
    await settled(other);
    await trusting.close();
  },
  async 'several devices come in by one address where that is said'() {
    const several = await start('127.0.0.1', '--devices', '2');
    const first = await ask(several, several.address.pathname), second = await ask(several, several.address.pathname);
    assert.deepEqual([first.status, second.status, (await ask(several, several.address.pathname)).status], [303, 303, 403]);
    assert.notEqual(cookieOf(first), cookieOf(second));
    assert.match(several.said, /the 2 devices that open/);
    await stop(several);
  },
  async 'without an address it takes that of the network, and listens nowhere else'() {
    const own = Object.values(networkInterfaces()).flat().filter(({ internal }) => !internal).map(({ address }) => address);
    if (own.length === 0) return console.log('no network here: not tried');
    const { address, child, ended } = await start();
    assert.ok(own.includes(address.hostname.replace(/[[\]]/g, '')), address.href);
    await assert.rejects(new Promise((done, failed) => connect({ host: '127.0.0.1', port: address.port, rejectUnauthorized: false }, done).on('error', failed)));
    child.kill('SIGTERM');
    assert.equal(await ended, 0);
  },
  async 'what goes wrong is told in one line'() {
    const tell = (options, more = {}) => {
      const { status, stderr, stdout } = spawnSync(program, ['studio', ...options], { encoding: 'utf8', timeout: 10_000, env: { ...environment, ...more } });
      assert.ok(status === 1 || status === 2, stderr);
      assert.equal(stdout, '');
      assert.match(stderr, /^limber: [^\n]+\n$/);
      return stderr;
    };
    assert.match(tell(['--host', '127.0.0.1', '--port', String(port)]), /port/);
    assert.match(tell(['--host', '192.0.2.77', '--port', '0']), /192\.0\.2\.77.*no address of this machine/);
    assert.match(tell(['--host', 'example.org', '--port', '0']), /no address of this machine/);
    assert.match(tell(['--devices', '2']), /--host/);
    assert.match(tell(['--host', '127.0.0.1', '--devices', '0']), /devices/);
    const file = join(output, 'no_folder');
    writeFileSync(file, '');
    assert.match(tell(['--host', '127.0.0.1', '--port', '0'], { XDG_DATA_HOME: file }), /certificate.*XDG_DATA_HOME/);
    assert.match(tell(['--host', '127.0.0.1', '--port', '0'], { XDG_DATA_HOME: '', HOME: '' }), /certificate.*XDG_DATA_HOME/);
    assert.ok(!existsSync(join(file, 'limber')));
  },
  async 'Ctrl+C ends it at once, with connections open'() {
    const open = connect({ host: '127.0.0.1', port, rejectUnauthorized: false }).on('error', () => {});
    await new Promise((done) => open.once('secureConnect', done));
    assert.ok(await stop(server) < 5000);
    open.destroy();
  },
};

const failed = await runCases(cases, () => shown, output);
await browser?.close();
for (const child of running) child.kill();
process.exit(failed > 0 ? 1 : 0);
