// The page as an app: kept by its service worker, opened without a network, replaced by the next build as a whole.
//
//   node apps/studio/tests/install_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { join, relative, resolve } from 'node:path';
import { barriers, jointPlace, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
const site = join(output, 'site'), place = join(site, 'school/studio'); // below a path of its own
rmSync(site, { recursive: true, force: true });
mkdirSync(site, { recursive: true });
cpSync(dist, place, { recursive: true });

const filesIn = (folder) => readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile())
  .map((entry) => relative(folder, join(entry.parentPath, entry.name)));

/** A build whose page and main script are others, and say so; its service worker knows it. */
function otherBuild(of, to, mark) {
  cpSync(of, to, { recursive: true });
  const main = /assets\/(index-[^"']*)\.js/.exec(readFileSync(join(to, 'index.html'), 'utf8'))[1];
  renameSync(join(to, `assets/${main}.js`), join(to, `assets/${main}${mark}.js`));
  for (const name of filesIn(to).filter((path) => /\.(js|html)$/.test(path) && path !== 'service_worker.js')) {
    writeFileSync(join(to, name), readFileSync(join(to, name), 'utf8').replaceAll(`${main}.js`, `${main}${mark}.js`).replace('<html', `<html data-build="${mark}"`));
  }
  const files = Object.fromEntries(filesIn(to).filter((name) => name !== 'service_worker.js').map((name) => [
    name.replace(/^index\.html$/, ''), `sha256-${createHash('sha256').update(readFileSync(join(to, name))).digest('base64')}`]));
  const script = join(to, 'service_worker.js'), code = readFileSync(script, 'utf8');
  const changed = code.replace(/^const version="\w+",builtFiles=\{.*?\};/, () => `const version="${mark}",builtFiles=${JSON.stringify(files)};`);
  assert.notEqual(changed, code);
  writeFileSync(script, changed);
  return to;
}

function publish(folder) {
  rmSync(place, { recursive: true });
  cpSync(folder, place, { recursive: true });
}

const second = otherBuild(dist, join(site, 'second'), 'Second');
let server = await serve(site);
const address = `${server.address}school/studio/`;
const browser = await launch();
let page, context;

/** Waits until a service worker has the page in its hands, and all of a build. */
const taken = (of = page) => of.waitForFunction(() => navigator.serviceWorker.controller?.state === 'activated');

async function visit(options = {}) {
  const opened = await openStudio(browser, address, { serviceWorkers: 'allow', ...options });
  ({ page, context } = opened);
  await taken();
  return opened;
}

/** Until no build waits any more: the browser takes a moment to let go of a page that was closed. */
async function nothingWaits(of) {
  const wire = await context.newCDPSession(of), builds = new Map();
  await new Promise((resolve) => {
    wire.on('ServiceWorker.workerVersionUpdated', ({ versions }) => {
      for (const { versionId, status } of versions) builds.set(versionId, status);
      const now = [...builds.values()];
      if (now.includes('activated') && !now.some((status) => ['new', 'installing', 'installed', 'activating'].includes(status))) resolve();
    });
    void wire.send('ServiceWorker.enable');
  });
  await wire.detach();
}

async function newPage(search = '') {
  const other = await context.newPage();
  await other.goto(address + search);
  await settled(other);
  return other;
}

/** All that service workers keep: the bytes' hashes by cache and path. */
const kept = (of = page) => of.evaluate(async () => {
  const found = {};
  for (const name of await caches.keys()) {
    const cache = await caches.open(name);
    found[name] = {};
    for (const request of await cache.keys()) {
      const bytes = await (await cache.match(request)).arrayBuffer(), digest = await crypto.subtle.digest('SHA-256', bytes);
      found[name][request.url] = [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, '0')).join('');
    }
  }
  return found;
});

const keptWhole = (folder) => Object.fromEntries(filesIn(folder).filter((name) => name !== 'service_worker.js').map((name) => [
  new URL(name.replace(/^index\.html$/, ''), address).href, createHash('sha256').update(readFileSync(join(folder, name))).digest('hex')]));

/** Of which build the page is. */
const build = (of = page) => of.evaluate(() => document.documentElement.dataset.build ?? 'first');

async function dragAHandle(of) {
  const { joints } = await sessionState(of), { name } = joints.at(-1);
  const before = await jointPosition(of, name), from = await jointPlace(of, name);
  await of.mouse.move(from.x, from.y);
  await of.mouse.down();
  for (let i = 1; i <= 5; ++i) await of.mouse.move(from.x + 8 * i, from.y - 6 * i);
  await of.mouse.up();
  await settled(of);
  assert.notDeepEqual(await jointPosition(of, name), before);
  return name;
}

/** The page asks whether there is another version. */
const lookForUpdate = (of = page) => of.evaluate(async () => { await (await navigator.serviceWorker.ready).update().catch(() => {}); });

/** Sends the page a file of the content, as often as `repeats` says, as the system does where another app shares one. */
async function share(name, repeats, content) {
  await Promise.all([page.waitForURL(/shared/), page.evaluate((file) => {
    const form = document.createElement('form'), files = new DataTransfer(), input = document.createElement('input');
    files.items.add(new File(Array(file.repeats).fill(new Blob([new Uint8Array(file.content)])), file.name));
    Object.assign(input, { type: 'file', name: 'files', files: files.files });
    Object.assign(form, { method: 'post', enctype: 'multipart/form-data', action: './share' });
    form.append(input);
    document.body.append(form);
    form.submit();
  }, { name, repeats, content })]);
}

const cases = {
  async 'the manifest is one that Chromium installs, with its icons'() {
    await visit();
    const devtools = await context.newCDPSession(page);
    const { url, errors, data } = await devtools.send('Page.getAppManifest');
    assert.equal(url, new URL('manifest.webmanifest', address).href);
    assert.deepEqual(errors, []);
    const { installabilityErrors } = await devtools.send('Page.getInstallabilityErrors');
    // A context of the tests is a private window, the only thing that is amiss.
    assert.deepEqual(installabilityErrors.map(({ errorId }) => errorId).filter((id) => id !== 'in-incognito'), []);
    const manifest = JSON.parse(data), icons = [...manifest.icons, { src: './icon_180.png', sizes: '180x180' }];
    for (const { src, sizes } of icons) {
      const size = await page.evaluate(async (from) => {
        const { width, height } = await createImageBitmap(await (await fetch(from)).blob());
        return `${width}x${height}`;
      }, src);
      assert.equal(size, sizes, src);
    }
    assert.equal(await page.locator('link[rel=apple-touch-icon]').getAttribute('href'), './icon_180.png');
  },
  async 'a first visit keeps every file of the build, and nothing of what is opened'() {
    const file = join(output, 'private.glb');
    execFileSync(program, ['sample', 'stool', '-o', file, '--quiet']);
    await page.locator('#file').setInputFiles(file);
    await page.waitForFunction(() => globalThis.limberStudio.state()?.name.startsWith('private'));
    await settled(page);
    const [[name, files], ...others] = Object.entries(await kept());
    assert.deepEqual(others, []);
    assert.match(name, /school\/studio\/ [0-9a-f]{16}$/);
    assert.deepEqual(files, keptWhole(dist));
  },
  async 'offline, a reload and a new page start and pose; what is fetched when asked for is there, too'() {
    await context.setOffline(true);
    await page.reload();
    await settled(page);
    await dragAHandle(page);
    const other = await newPage('?sample=biped&language=de');
    assert.equal(await other.locator('html').getAttribute('lang'), 'de');
    await dragAHandle(other);
    const download = other.waitForEvent('download');
    await other.locator('#export-as').selectOption('usdz');
    assert.ok((await download).suggestedFilename().endsWith('.usdz'));
    const all = await other.evaluate(async (paths) => (await Promise.all(paths.map((path) => fetch(path)))).map(({ status }) => status),
      filesIn(dist).filter((path) => path.startsWith('assets/')));
    assert.ok(all.length > 5 && all.every((status) => status === 200));
    await other.close();
    await context.setOffline(false);
  },
  async 'with the server stopped, a new page starts'() {
    const port = Number(new URL(server.address).port);
    await server.close();
    const other = await newPage('?sample=biped');
    await dragAHandle(other);
    await other.close();
    for (server = null; !server;) { // another program may have the port for a moment
      server = await serve(site, port).catch(() => new Promise((wait) => setTimeout(wait, 1000, null)));
    }
  },
  async 'a build that is published in part is not taken'() {
    publish(second);
    cpSync(join(dist, 'index.html'), join(place, 'index.html')); // still that of the build before
    await lookForUpdate();
    await page.waitForFunction(async () => { const { installing, waiting } = await navigator.serviceWorker.ready; return !installing && !waiting; });
    await page.reload();
    await settled(page);
    assert.equal(await build(), 'first');
    assert.equal(await page.locator('#new-version').count(), 0);
    assert.deepEqual(Object.values(await kept())[0], keptWhole(dist));
  },
  async 'a new build waits, and the page stays as it is'() {
    publish(second);
    await lookForUpdate();
    await page.locator('#new-version').waitFor();
    assert.match(await page.locator('#new-version').textContent(), /new version/);
    assert.deepEqual(await barriers(page), []);
    await page.goto(`${address}?language=de`);
    await settled(page);
    assert.equal(await build(), 'first', 'a reload alone takes nothing');
    assert.match(await page.locator('#new-version').textContent(), /neue Version/);
  },
  async 'it is not taken while the old one is open elsewhere'() {
    const other = await newPage();
    await page.locator('#take-version').click();
    await page.locator('#new-version', { hasText: 'anderen Tab' }).waitFor();
    assert.equal(await build(other), 'first');
    assert.equal(await build(), 'first');
    await other.close();
  },
  async 'when it is taken, it is taken whole, and what was done is kept'() {
    const joint = await dragAHandle(page), posed = await jointPosition(page, joint), { name } = await sessionState(page);
    server.served.clear();
    let reloads = false;
    const load = page.waitForEvent('load').then(() => { reloads = true; });
    while (!reloads) { // the browser takes a moment to let go of the page that was closed
      await page.locator('#take-version').click({ timeout: 2000 }).catch(() => {});
      await Promise.race([load, new Promise((wait) => setTimeout(wait, 1000))]);
    }
    await settled(page);
    assert.equal(await build(), 'Second');
    assert.equal((await sessionState(page)).name, name);
    assert.deepEqual(await jointPosition(page, joint), posed);
    const all = await kept();
    assert.equal(Object.keys(all).length, 1);
    assert.deepEqual(Object.values(all)[0], keptWhole(second));
    const loaded = await page.evaluate(() => performance.getEntriesByType('resource').map(({ name: url }) => url).filter((url) => /index-.*\.js/.test(url)));
    assert.ok(loaded.length > 0 && loaded.every((url) => url.includes('Second')), loaded.join(' '));
    assert.deepEqual([...server.served].filter((path) => path.includes('assets')), [], 'all of it was there before');
  },
  async 'later is later; once the page is closed, the next one has the new build'() {
    publish(dist);
    await lookForUpdate();
    await page.locator('#later-version').click();
    assert.equal(await page.locator('#new-version').count(), 0);
    const next = await context.newPage();
    await page.close();
    page = next;
    await nothingWaits(page);
    await page.goto(address);
    await settled(page);
    await page.waitForFunction(async () => (await caches.keys()).length === 1);
    assert.equal(await build(), 'first');
    assert.deepEqual(Object.values(await kept())[0], keptWhole(dist));
  },
  async 'two folders of one host keep their builds apart'() {
    const other = await context.newPage();
    await other.goto(`${server.address}second/?sample=biped`);
    await settled(other);
    await taken(other);
    const names = Object.keys(await kept());
    assert.equal(names.length, 2);
    assert.ok(names.some((name) => name.includes('/second/ Second')));
    await other.close();
  },
  async 'a file that another app shares is opened, and kept nowhere but in the document'() {
    await share('shared.glb', 1, [...readFileSync(join(output, 'private.glb'))]);
    await page.waitForFunction(() => globalThis.limberStudio?.state()?.name.startsWith('shared'));
    await settled(page);
    assert.equal(new URL(page.url()).search, '');
    assert.deepEqual(Object.values(await kept()).flatMap(Object.keys).filter((url) => /share/.test(url)), []);
  },
  async 'a shared file beyond what a browser can open is refused by its size'() {
    await share('large.glb', 501, Array(1e6).fill(0));
    await page.getByText('This file is too large for a browser').waitFor();
    assert.doesNotMatch(await page.evaluate(() => globalThis.limberStudio.state()?.name ?? ''), /^large/);
  },
  async 'a form that another site sends is turned away'() {
    const other = await serve(site), stranger = await context.newPage();
    const studio = page.url();
    const plain = new URL('plain', other.address).href;  // not the studio's page, which may load itself anew
    await stranger.route(plain, (route) => route.fulfill({ contentType: 'text/html', body: '<p>another site' }));
    await stranger.goto(plain);
    const [answer] = await Promise.all([stranger.waitForResponse((response) => response.url().endsWith('/share')), stranger.evaluate((action) => {
      const form = document.createElement('form');
      Object.assign(form, { method: 'post', enctype: 'multipart/form-data', action });
      document.body.append(form);
      setTimeout(() => form.submit());  // which ends this page, once its answer is here
    }, new URL('share', studio).href)]);
    assert.equal(answer.status(), 403);
    await stranger.close();
    other.close();
  },
  async 'a file that the system opens with the studio is opened'() {
    await context.addInitScript((bytes) => {
      const file = { getFile: async () => new File([new Uint8Array(bytes)], 'launched.glb') };
      Object.defineProperty(globalThis, 'launchQueue', { configurable: true, value: { setConsumer: (take) => take({ files: [file] }) } });
    }, [...readFileSync(join(output, 'private.glb'))]);
    await page.reload();
    await page.waitForFunction(() => globalThis.limberStudio?.state()?.name.startsWith('launched'));
    await settled(page);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
