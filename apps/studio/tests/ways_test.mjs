// The ways into augmented reality on devices that have no WebXR, or less than they claim: what is offered, and what is said
// where it fails.
//
//   node apps/studio/tests/ways_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { overlayBarriers, pictureOfScreen, turnScreen } from './ar_phone.mjs';
import { download, dragMouse, jointPlace, jointPosition, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { readUsd } from './usd_points.mjs';
import { emulatePhone } from './xr_phone.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist);
const browser = await launch({ options: ['--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream'] });
const android = 'Mozilla/5.0 (Linux; Android 12; Phone) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/120 Mobile Safari/537.36';

/** What of a device stands in for the browser's own, before the page loads; `becomeDevice` makes it another one. */
function stub() {
  let device = {};
  const { mediaDevices, xr, userAgent } = navigator, { enumerateDevices, getUserMedia } = mediaDevices, { isSessionSupported } = xr;
  xr.isSessionSupported = async (mode) => Boolean(device.xr) && isSessionSupported.call(xr, mode);
  mediaDevices.enumerateDevices = async () => (device.cameras === 0 ? [] : enumerateDevices.call(mediaDevices));
  mediaDevices.getUserMedia = async (wanted) => {
    if (device.camera) throw new DOMException('stub', device.camera);
    return getUserMedia.call(mediaDevices, wanted);
  };
  Object.defineProperty(navigator, 'userAgent', { get: () => device.userAgent ?? userAgent });
  const { supports } = DOMTokenList.prototype, { click } = HTMLAnchorElement.prototype;
  DOMTokenList.prototype.supports = function (token) { return (token === 'ar' && Boolean(device.quickLook)) || supports.call(this, token); };
  HTMLAnchorElement.prototype.click = function () {
    if (this.href.startsWith('intent:')) globalThis.intent = this.href;
    else if (this.rel !== 'ar') click.call(this);
    else globalThis.quickLook = { href: this.href, children: [...this.children].map(({ tagName }) => tagName), bytes: fetch(this.href).then((answer) => answer.arrayBuffer()) };
  };
  const stop = (event) => event.stopImmediatePropagation();
  Object.defineProperty(navigator, 'canShare', { value: ({ files }) => Boolean(device.shares) && files.every(({ name }) => name.endsWith(device.shares)) });
  Object.defineProperty(navigator, 'share', { value: async ({ files }) => { globalThis.sharedFile = { name: files[0].name, type: files[0].type, size: files[0].size }; } });
  const events = globalThis.DeviceOrientationEvent, { requestPermission } = events;
  globalThis.becomeDevice = (next) => {
    device = next;
    // Who listens already is told of changes alone.
    if (device.sensors) addEventListener('deviceorientation', stop);
    else removeEventListener('deviceorientation', stop);
    if (device.sensors === 'none') delete events.requestPermission;
    else events.requestPermission = device.sensors ? async () => device.sensors : requestPermission;
    mediaDevices.dispatchEvent(new Event('devicechange'));
  };
}

let shown, errors, sensors, whole = false;

async function open({ prepare = async () => {}, ...options } = {}) {
  await shown?.context().close();
  let context;
  ({ page: shown, context, errors } = await openStudio(browser, server.address, {
    width: 390, height: 844, touch: true, search: '?sample=stool', ...options,
    prepare: async (before) => {
      await emulatePhone(before);
      await before.addInitScript(stub);
      await prepare(before);
    },
  }));
  sensors = await context.newCDPSession(shown);
}

/** The open page finds itself on another device. `turned`: the angles that its sensors give; `xr`: WebXR is claimed. With
 *  `options` of `open` there is a new page, as there is after a case that failed. */
async function on(device, steps, options = null) {
  if (options || !whole) await open(options ?? {});
  whole = false;
  const page = shown, button = page.locator('#view-in-ar');
  const become = (next) => page.evaluate((made) => becomeDevice(made), next);
  const turn = (alpha, beta, gamma) => sensors.send('DeviceOrientation.setDeviceOrientationOverride', { alpha, beta, gamma });
  if (device.turned) await turn(...device.turned);
  await become(device);
  const offered = () => page.locator('#ways [data-way]').evaluateAll((all) => all.map((one) => one.dataset.way));
  await steps({
    page, button, offered, turn, become,
    clean: async () => assert.deepEqual(await overlayBarriers(page), []),
    shot: (name) => page.screenshot({ path: join(output, `ways_${name}.png`) }),
    /** By the menu, also where there is no button. */
    async list() {
      await page.locator('#export-as').selectOption('ar-ways');
      await page.locator('#ways').waitFor();
      return offered();
    },
    async press() {
      await button.tap();
      await page.locator('#ways').waitFor();
      return offered();
    },
    notice: async () => {
      await page.locator('#app #notice').waitFor();
      return page.locator('#app #notice').textContent();
    },
    take: (way) => page.locator(`#ways [data-way=${way}]`).tap(),
    async close() {
      await page.locator('#ways-close').tap();
      await page.locator('#ways').waitFor({ state: 'detached' });
    },
    async leave() {
      await page.locator('#ar-close').tap();
      await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
      assert.equal(await page.evaluate(() => document.querySelector('video')), null);
    },
  });
  assert.deepEqual(errors, []);
  whole = true;
}

const flat = [0, 60, 0]; // the phone looks at the floor ahead

const cases = {
  async 'a device that has nothing: no button, and the menu says why'() {
    await on({ cameras: 0 }, async ({ page, button, list, clean, shot }) => {
      await button.waitFor({ state: 'hidden' });
      assert.deepEqual(await list(), []);
      const told = await page.locator('#ways').textContent();
      for (const why of ['on its screen alone', 'no WebXR', 'No camera was found', 'Only iPhones', 'Only Android', 'does not share']) assert.ok(told.includes(why), why);
      await clean();
      await shot('none');
      await page.keyboard.press('Escape');
      await page.locator('#ways').waitFor({ state: 'detached' });
    });
  },
  async 'Quick Look alone is opened at once, with the model as it is posed'() {
    await on({ cameras: 0, quickLook: true }, async ({ page, button, list, close }) => {
      const heights = async () => {
        await page.evaluate(() => { globalThis.quickLook = null; });
        await button.tap();
        await page.waitForFunction(() => globalThis.quickLook);
        const { href, children } = await page.evaluate(() => ({ ...globalThis.quickLook, bytes: null }));
        assert.deepEqual(children, ['IMG']);
        assert.ok(href.startsWith('blob:'));
        const bytes = await page.evaluate(async () => [...new Uint8Array(await globalThis.quickLook.bytes)]);
        const top = readUsd(bytes).points.reduce((most, [, y]) => Math.max(most, y), -Infinity);
        return { href, top };
      };
      const before = await heights();
      const { joints } = await sessionState(page), places = await Promise.all(joints.map(({ name }) => jointPlace(page, name)));
      const at = places.reduce((highest, place) => (place.y < highest.y ? place : highest));
      await dragMouse(page, at, { x: at.x, y: at.y - 60 });
      assert.equal((await sessionState(page)).posed, true);
      const after = await heights();
      assert.ok(after.top > before.top + 0.01, JSON.stringify([before, after]));
      assert.notEqual(after.href, before.href);
      assert.deepEqual(await list(), ['quick-look']);
      assert.match(await page.locator('#ways').textContent(), /to look at, not to pose/);
      await close();
    });
  },
  async 'several ways: the best first, by keyboard as well'() {
    await on({ quickLook: true, turned: flat }, async ({ page, button, press, clean, shot, leave }) => {
      assert.deepEqual(await press(), ['card', 'camera', 'quick-look']);
      assert.match(await page.locator('#ways').textContent(), /walking does not move the view/);
      await clean();
      await shot('several');
      await page.keyboard.press('Escape');
      await button.focus();
      await page.keyboard.press('Enter');
      await page.locator('#ways').waitFor();
      assert.equal(await page.evaluate(() => document.activeElement.dataset.way), 'card');
      await page.keyboard.press('Tab'); // to the printed card
      await page.keyboard.press('Tab');
      await page.keyboard.press('Enter');
      await page.locator('#ar-place').waitFor();
      await leave();
    });
  },
  async 'the card on paper: its size in millimetres, its cells, what goes to the printer'() {
    await on({ sensors: 'none' }, async ({ page, press, clean, shot, close }) => {
      assert.deepEqual(await press(), ['card']);
      await page.locator('#ways-print-card').tap();
      await page.locator('#print-card').waitFor();
      const code = Number(readFileSync(createRequire(import.meta.url).resolve('js-aruco2/src/dictionaries/aruco_mip_16h3.js'), 'utf8').match(/codeList: \[(.*?)\]/s)[1].split(',')[11]);
      for (const [paper, width, height] of [['a4', 210, 297], ['letter', 215.9, 279.4]]) {
        await page.locator('#card-paper').selectOption(paper);
        const svg = String(await download(page, () => page.locator('#card-save').tap()));
        assert.ok(svg.includes(`width="${width}mm"`) && svg.includes(`height="${height}mm"`) && svg.includes(`viewBox="0 0 ${width} ${height}"`));
        assert.match(svg, /class="ruler" d="M[\d.]+ [\d.]+h100M/);
        // Drawn at 4 pixels for a millimetre: the white rim, the black frame and the bits, a cell of 80/6 mm each.
        const cells = await page.evaluate(async ([text, wide, high]) => {
          const image = new Image();
          image.src = URL.createObjectURL(new Blob([text], { type: 'image/svg+xml' }));
          await image.decode();
          const canvas = document.createElement('canvas');
          [canvas.width, canvas.height] = [wide * 4, high * 4];
          const context = canvas.getContext('2d');
          context.drawImage(image, 0, 0, wide * 4, high * 4);
          const cell = 80 / 6, left = (wide - 8 * cell) / 2;
          return Array.from({ length: 64 }, (_, i) => context.getImageData(4 * (left + cell * (i % 8 + 0.5)), 4 * (30 + cell * (Math.floor(i / 8) + 0.5)), 1, 1).data[0] > 128);
        }, [svg, width, height]);
        assert.deepEqual(cells, cells.map((_, i) => {
          const x = i % 8, y = Math.floor(i / 8);
          if (x < 2 || x > 5 || y < 2 || y > 5) return x === 0 || x === 7 || y === 0 || y === 7;
          return ((code >> (15 - (4 * (y - 2) + x - 2))) & 1) === 1;
        }));
      }
      await clean();
      await shot('print_card');
      await page.locator('#card-print').tap();
      const printed = await page.evaluate(() => {
        const { document: sheet } = document.querySelector('.print-frame').contentWindow;
        return sheet.querySelector('svg').getAttribute('width') + sheet.querySelector('style').textContent;
      });
      assert.match(printed, /^215.9mm.*size: letter; margin: 0/);
      await page.locator('#card-close').tap();
      await page.locator('#print-card').waitFor({ state: 'detached' });
      await close();
    });
  },
  async 'the card on a screen: as large as a bank card says, and kept'() {
    await on({ cameras: 0 }, async ({ page, clean, shot }) => {
      await page.setViewportSize({ width: 1280, height: 800 });
      const shownAt = async () => {
        await page.locator('#export-as').selectOption('ar-show-card');
        await page.locator('#show-card').waitFor();
        const width = async (selector) => (await page.locator(selector).boundingBox()).width;
        return { card: await width('.shown-card svg'), bank: await width('.bank-card') };
      };
      await shownAt();
      await page.locator('#card-scale').focus();
      await page.keyboard.press('ArrowRight');
      await page.locator('#card-scale').fill('5');
      await clean();
      await shot('show_card');
      await page.keyboard.press('Escape');
      await page.locator('#show-card').waitFor({ state: 'detached' });
      const { card, bank } = await shownAt();
      assert.ok(Math.abs(card - 5 * 80 * 8 / 6) < 0.5 && Math.abs(bank - 5 * 85.6) < 0.5, JSON.stringify({ card, bank }));
      await page.keyboard.press('Escape');
      await page.setViewportSize({ width: 390, height: 844 });
    });
  },
  async 'sharing where the device has no viewer of its own, and the browser lets models out'() {
    await on({ cameras: 0, shares: 'usdz' }, async ({ page, button, list, close }) => {
      await button.tap();
      await page.waitForFunction(() => globalThis.sharedFile);
      const { name, type, size } = await page.evaluate(() => globalThis.sharedFile);
      assert.equal(type, 'model/vnd.usdz+zip');
      assert.match(name, /\.usdz$/);
      assert.ok(size > 1000);
      assert.deepEqual(await list(), ['share']);
      await close();
    });
  },
  async 'without motion sensors there is the card; what is said while it is not seen'() {
    await on({ sensors: 'none' }, async ({ page, press, take, clean, shot, leave }) => {
      assert.deepEqual(await press(), ['card']);
      await take('card');
      await page.waitForFunction(() => document.querySelector('#ar-line')?.textContent.includes('The card is not seen'));
      await clean();
      await shot('card_not_seen');
      // Nothing can stand on it yet.
      assert.equal(await page.locator('#ar-place').isVisible(), false);
      await page.touchscreen.tap(195, 420);
      await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
      assert.equal(await page.locator('#ar-pose').isVisible(), false);
      await leave();
    });
  },
  async 'camera view: placed, turned with the device, posed, ended'() {
    await on({ turned: flat }, async ({ page, press, take, turn, clean, shot }) => {
      await press();
      await take('camera');
      await page.locator('#ar-place').waitFor();
      await page.waitForFunction(() => document.querySelector('#ar-line').textContent.includes('Tap to place'));
      await shot('camera_placing');
      await page.locator('#ar-place').tap();
      await page.locator('#ar-pose').waitFor();
      await page.waitForFunction(() => document.querySelector('#ar-line').textContent.includes('walking does not move the view'));
      await settled(page);
      await clean();
      await shot('camera_placed');
      // A picture, with what the camera sees beside the model: as on the screen, outside the disc of the test picture, which turns.
      const screen = await page.screenshot(), taken = await download(page, () => page.locator('#ar-picture').tap());
      const colors = await page.evaluate((pictures) => Promise.all(pictures.map(async (bytes) => {
        const bitmap = await createImageBitmap(new Blob([new Uint8Array(bytes)])), context = new OffscreenCanvas(390, 844).getContext('2d');
        context.drawImage(bitmap, 0, 0, 390, 844);
        return [[20, 180], [370, 180], [195, 690]].map(([x, y]) => [...context.getImageData(x, y, 1, 1).data]);
      })), [[...screen], [...taken]]);
      for (const [i, color] of colors[0].entries()) assert.ok(color.every((value, c) => Math.abs(value - colors[1][i][c]) < 24), JSON.stringify(colors));
      assert.ok(colors[1].every(([r, g, b]) => g > r + 30 && g > b + 30), `the test picture is green: ${JSON.stringify(colors[1])}`);
      const spot = (at) => page.evaluate((asked) => globalThis.limberStudio.ar.spot(asked), at);
      const frames = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      // The middle of the screen: 60 degrees from the table plane is 30 below level, 1.4 m above the floor.
      const ahead = [0, 0, -1.4 / Math.tan(Math.PI / 6)], middle = await spot(ahead);
      assert.ok(Math.hypot(middle.x - 195, middle.y - 422) < 1, JSON.stringify(middle));
      const lower = await spot([0, 0, -1.4 / Math.tan(40 * Math.PI / 180)]), pixels = (lower.y - middle.y) / Math.tan(10 * Math.PI / 180); // focal length
      await turn(10, 60, 0); // to the left about the upright: what was in the middle is at the right
      await frames();
      const turned = await spot(ahead);
      assert.ok(turned.x > 195 + 0.8 * pixels * Math.tan(Math.PI / 18) * Math.cos(Math.PI / 6), JSON.stringify(turned));
      await turn(0, 70, 0); // up: it goes down
      await frames();
      const up = await spot(ahead);
      assert.ok(Math.abs(up.x - 195) < 1 && Math.abs(up.y - 422 - pixels * Math.tan(Math.PI / 18)) < 2, JSON.stringify([up, pixels]));
      // Screen and device a quarter to the left, the camera looking as at first: the picture is upright, and fills the width.
      await turnScreen(sensors, true);
      await turn(90, 0, -60);
      await page.waitForFunction(() => innerWidth === 844 && screen.orientation.angle === 90);
      await frames();
      const [here, above, below] = [await spot(ahead), await spot([0, 0.5, ahead[2]]), await spot([0, 0, -1.4 / Math.tan(40 * Math.PI / 180)])];
      assert.ok(Math.hypot(here.x - 422, here.y - 195) < 1, JSON.stringify(here));
      assert.ok(Math.abs(above.x - 422) < 1 && above.y < here.y - 30, JSON.stringify(above));
      const [upright, turnedOver] = await page.evaluate(([...screens]) => {
        const { videoWidth, videoHeight } = document.querySelector('#ar video');
        return screens.map(([width, height]) => Math.max(width / videoWidth, height / videoHeight));
      }, [[390, 844], [844, 390]]);
      const longer = (below.y - here.y) / Math.tan(10 * Math.PI / 180);
      assert.ok(Math.abs(longer - (pixels * turnedOver) / upright) < 2, `as large as what the camera sees: ${longer} of ${pixels} pixels`);
      await clean();
      await pictureOfScreen(sensors, join(output, 'ways_camera_landscape.png'));
      await turnScreen(sensors, false);
      // It looks at the sky: where a model is to go has no surface.
      await turn(0, 150, 0);
      await page.locator('#ar-again').tap();
      await page.waitForFunction(() => document.querySelector('#ar-line').textContent.includes('Point the device down'));
      await turn(0, 60, 0);
      await page.waitForFunction(() => document.querySelector('#ar-line').textContent.includes('Tap to place'));
      await page.locator('#ar-place').tap();
      await page.locator('#ar-pose').tap();
      await settled(page);
      await shot('camera_posing');
      // Hidden in between, and the camera taken away in the end: the desk is back and nothing is lost.
      await page.evaluate(() => {
        Object.defineProperty(document, 'visibilityState', { value: 'hidden', configurable: true });
        document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
      });
      await page.waitForFunction(() => document.querySelector('#ar-line').textContent.includes('Waiting'));
      await page.evaluate(() => {
        delete document.visibilityState;
        document.dispatchEvent(new Event('visibilitychange', { bubbles: true }));
      });
      await page.waitForFunction(() => !document.querySelector('#ar-line').textContent.includes('Waiting'));
      const stood = await jointPosition(page, (await sessionState(page)).joints.at(-1).name);
      await page.evaluate(() => document.querySelector('#ar video').srcObject.getTracks()[0].dispatchEvent(new Event('ended')));
      await page.waitForFunction(() => document.querySelector('#app').checkVisibility());
      await settled(page);
      assert.match(await page.locator('#notice').textContent(), /The device has ended augmented reality/);
      assert.deepEqual(await jointPosition(page, (await sessionState(page)).joints.at(-1).name), stood);
      assert.equal(await page.evaluate(() => document.querySelector('video')), null);
      await page.locator('#close-notice').tap();
    });
  },
  // A way that failed is offered last from then on: those that fail come after those that do not.
  async 'a browser that claims WebXR and refuses: what is left is offered, and WebXR again, last'() {
    await on({ turned: flat, xr: true }, async ({ page, press, button, offered, take, shot, close, leave }) => {
      await page.evaluate(() => { phone.refuse = 'NotSupportedError'; });
      const before = await sessionState(page);
      await button.tap();
      await page.locator('#ways').waitFor();
      assert.match(await page.locator('#ways h2').textContent(), /does not begin augmented reality/);
      assert.deepEqual(await offered(), ['card', 'camera', 'webxr']);
      await shot('webxr_refused');
      assert.deepEqual(await sessionState(page), before);
      await close();
      assert.deepEqual(await press(), ['card', 'camera', 'webxr']);
      await page.evaluate(() => { phone.refuse = null; });
      await take('webxr');
      await page.waitForFunction(() => phone.session);
      await leave();
    });
  },
  async 'sensors refused, or silent'() {
    await on({}, async ({ page, become, press, take, offered, close }) => {
      for (const [answer, words] of [['denied', 'The motion sensors are not allowed'], ['granted', 'This device does not say how it is turned']]) {
        await become({ sensors: answer });
        await press();
        await take('camera');
        await page.waitForFunction((told) => document.querySelector('#ways h2')?.textContent === told, words);
        assert.deepEqual(await offered(), ['card', 'camera']);
        await close();
      }
      assert.equal(await page.evaluate(() => document.querySelector('video')), null);
    });
  },
  async 'the camera refused, missing or in use: said, and what is left is offered'() {
    const device = { quickLook: true, turned: flat };
    await on(device, async ({ page, become, press, take, offered, clean, shot, close }) => {
      for (const [name, words] of [['NotAllowedError', 'The camera is not allowed'], ['NotFoundError', 'There is no camera'], ['NotReadableError', 'The camera is in use']]) {
        await become({ ...device, camera: name });
        await press();
        await take(name === 'NotFoundError' ? 'card' : 'camera');
        await page.locator('#ways[aria-label]').waitFor();
        await page.waitForFunction((told) => document.querySelector('#ways h2')?.textContent === told, words);
        assert.deepEqual(await offered(), ['quick-look', 'card', 'camera']);
        assert.equal(await page.locator('#ar').count(), 0);
        assert.equal(await page.locator('#app').isVisible(), true);
        if (name === 'NotAllowedError') {
          await clean();
          await shot('camera_refused');
        }
        await close();
      }
    });
  },
  async 'with nothing else, a refused camera is told at the desk, and asked for again'() {
    await on({ turned: flat, camera: 'NotAllowedError' }, async ({ page, become, press, take, notice, leave }) => {
      await press();
      await take('camera');
      assert.match(await notice(), /The camera is not allowed/);
      await page.locator('#close-notice').tap();
      await become({ turned: flat });
      await press();
      await take('camera');
      await page.locator('#ar-place').waitFor();
      await leave();
    });
  },
  async 'Scene Viewer: on Android, for a model at a public address and for no other'() {
    let glb;
    await on({ cameras: 0, userAgent: android }, async ({ page, list }) => {
      assert.deepEqual(await list(), []);
      assert.match(await page.locator('#ways').textContent(), /needs an address on the web/);
      await page.keyboard.press('Escape');
      glb = await download(page, () => page.locator('#save-glb').tap());
    });
    const address = 'https://models.example.org/stool.glb';
    await on({ cameras: 0, userAgent: android }, async ({ page, button, notice }) => {
      await button.tap();
      await page.waitForFunction(() => globalThis.intent);
      const intent = await page.evaluate(() => globalThis.intent);
      assert.match(intent, /^intent:\/\/arvr\.google\.com\/scene-viewer\/1\.0\?/);
      assert.equal(new URLSearchParams(intent.slice(intent.indexOf('?'), intent.indexOf('#'))).get('file'), address);
      // A device without it comes back to the page.
      const back = decodeURIComponent(intent.match(/S\.browser_fallback_url=(.*?);/)[1]);
      await page.evaluate((to) => location.assign(to), back);
      assert.match(await notice(), /has no Scene Viewer/);
      assert.equal((await sessionState(page)).name, 'stool.glb');
    }, { search: `?model=${encodeURIComponent(address)}`,
      prepare: (context) => context.route(address, (route) => route.fulfill({ body: glb, contentType: 'model/gltf-binary', headers: { 'access-control-allow-origin': '*' } })) });
  },
  async 'German'() {
    await on({ quickLook: true, turned: flat }, async ({ page, press, shot }) => {
      await press();
      assert.match(await page.locator('#ways').textContent(), /Kamera-Ansicht/);
      await shot('german');
    }, { locale: 'de-DE' });
  },
};

const failed = await runCases(cases, () => shown, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
