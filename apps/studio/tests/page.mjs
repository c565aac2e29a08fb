// A browser with the built page in it, for the tests and for the pictures of the documentation.
import { createServer } from 'node:http';
import { existsSync, readFileSync } from 'node:fs';
import { extname, join, normalize } from 'node:path';
import { createRequire } from 'node:module';
import { chromium } from 'playwright-core';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary', '.png': 'image/png',
  '.webmanifest': 'application/manifest+json' };
export const browserProgram = process.env.LIMBER_BROWSER ?? '/usr/bin/chromium';

/** Pixels drawn for one of the page: half take a tenth to a fifth less time. Pictures that are looked at, and what measures by them, want 1. */
const pixelDensity = Number(process.env.LIMBER_PIXEL_DENSITY ?? 0.5);

/** Serves a folder on a port of the loopback address, 0 takes a free one; `served` names the files that were asked for. */
export async function serve(folder, port = 0) {
  const served = new Set(), server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    const file = join(folder, normalize(path.endsWith('/') ? `${path}index.html` : path));
    if (!file.startsWith(folder) || !existsSync(file)) return response.writeHead(404).end();
    served.add(file);
    response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream' }).end(readFileSync(file));
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, served, close: () => { server.close(); server.closeAllConnections(); } };
}

/** Frames are drawn in software, so tests do without smooth edges: several samples for each pixel take half the time. What is
 *  not WebGL is drawn without the graphics process, which takes a quarter off the whole. */
export async function launch({ smooth = false, options = [] } = {}) {
  const browser = await chromium.launch({
    executablePath: browserProgram,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader-webgl', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
      ...(smooth ? [] : ['--webgl-antialiasing-mode=none']), ...options],
  });
  const newContext = browser.newContext.bind(browser);
  browser.newContext = async (wanted) => {
    const context = await newContext(wanted);
    context.setDefaultTimeout(120_000); // a slow machine is no failure
    return context;
  };
  return browser;
}

/** The page once its model stands. What the page throws is collected in `errors`. Its service worker, which fetches all files
 *  for offline, runs only where `serviceWorkers` is 'allow'. */
export async function openStudio(browser, address, { width = 1280, height = 800, touch = false, search = '', locale = 'en-US', prepare = async () => {}, ...more } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: pixelDensity, hasTouch: touch, locale, acceptDownloads: true, serviceWorkers: 'block', ...more });
  await prepare(context);
  const page = await context.newPage();
  const errors = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  await page.goto(address + search);
  await settled(page);
  return { page, context, errors };
}

/** Nothing under way, and the frame drawn. Asked between frames: in a frame, a clip that plays has just asked for its next moment. */
export async function settled(page) {
  await page.waitForFunction(() => globalThis.limberStudio?.idle() && document.querySelector('#facts').textContent !== '', undefined, { polling: 15 });
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

/** The answer to a question that the page asks, once it does. */
export async function answer(page, yes) {
  await page.locator(yes ? '#ask-yes' : '#ask-no').click();
  await settled(page);
}

/** Until the motion that was chosen is on the model, which may be given a skeleton first. */
export async function motionPlayed(page, choose) {
  const before = (await sessionState(page)).clips.length;
  const came = ([selector, count]) => globalThis.limberStudio.state().clips.length > count || document.querySelector(selector)?.checkVisibility();
  await choose();
  await page.waitForFunction(came, ['#ask, #notice:not([hidden])', before]);
  if (await page.locator('#ask').isVisible()) await answer(page, true);
  await page.waitForFunction(came, ['#notice:not([hidden])', before]);
  if (await page.locator('#notice').isVisible()) throw new Error(await page.locator('#notice').textContent());
}

/** Puts a motion of the shelf on the model. */
export async function chooseMotion(page, name) {
  await page.locator('#open-shelf').click();
  await page.locator(`#shelf [data-motion="${name}"]`).click();
}

export async function download(page, click) {
  const [file] = await Promise.all([page.waitForEvent('download'), click()]);
  return readFileSync(await file.path());
}

/** Runs each of them; gives how many failed. `page` gives the page that is shown then, for a picture of it. LIMBER_TIMES=1 tells how long each took,
 *  LIMBER_ONLY=regex runs those whose names match. */
export async function runCases(cases, page, output) {
  let passed = 0, failed = 0;
  const only = new RegExp(process.env.LIMBER_ONLY ?? '');
  for (const [name, run] of Object.entries(cases).filter(([one]) => only.test(one))) {
    const begun = performance.now();
    try {
      await run();
      ++passed;
      if (process.env.LIMBER_TIMES) console.log(`${((performance.now() - begun) / 1000).toFixed(1)} s  ${name}`);
    } catch (error) {
      ++failed;
      console.log(`FAILED ${name}: ${error.stack ?? error}`);
      await (typeof page === 'function' ? page() : page).screenshot({ path: join(output, `failed_${failed}.png`) }).catch(() => {});
    }
  }
  console.log(`${passed} passed, ${failed} failed`);
  return failed;
}

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
/** What keeps people out who read with ears or press keys, and text that cannot be made out, with colors that are on
 *  their way to others there at once; each with where. */
export async function barriers(of) {
  await of.evaluate(() => document.getAnimations().forEach((one) => { if (one instanceof CSSTransition) one.finish(); }));
  await of.evaluate(axe);
  const { violations } = await of.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
  return violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target} ${failureSummary}`));
}

/** Pressed there, let go here, in pixels of the page. */
export async function dragMouse(page, from, to) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
  await page.mouse.move(to.x, to.y);
  await page.mouse.up();
  await settled(page);
}

/** Where a joint is drawn, in pixels of the page. */
export const jointPlace = (page, name) => page.evaluate((joint) => globalThis.limberStudio.place(joint), name);
/** Where a joint stands, in metres. */
export const jointPosition = (page, name) => page.evaluate((joint) => globalThis.limberStudio.position(joint), name);
export const sessionState = (page) => page.evaluate(() => globalThis.limberStudio.state());
/** The joint that is this part of the body; where several are, the last. */
export async function lastJointOf(page, part) {
  const found = (await sessionState(page)).joints.filter((joint) => joint.part === part).at(-1);
  if (!found) throw new Error(`no joint is a ${part}`);
  return found.name;
}
