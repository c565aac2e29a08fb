// The second minute: what a person trusts a day's work to. What does not come or is not written yet is said, two tabs do
// not fight, what is made stands on the floor and is drawn lit.
//
//   node apps/studio/tests/second_minute_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, chooseMotion, download, dragMouse, jointPlace, jointPosition, lastJointOf, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { walkBvh } from './walk_bvh.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const size = { width: 900, height: 600 };
const desk = await openStudio(browser, server.address, { ...size, search: '?sample=biped' });
let { page } = desk;

const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const noticeText = (of = page) => of.locator('#notice').textContent();
const kept = (of = page) => of.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.kept());
async function openSample(page, name) {
  await page.locator('#samples').selectOption(name);
  await page.waitForFunction((wanted) => globalThis.limberStudio.state()?.name === wanted, name);
  await settled(page);
}
async function dragHand(of, by = -60) {
  const hand = await lastJointOf(of, 'left hand'), from = await jointPlace(of, hand);
  await dragMouse(of, from, { x: from.x - 10, y: from.y + by });
  return hand;
}
const walkFile = { name: 'walk.bvh', mimeType: 'text/plain', buffer: Buffer.from(walkBvh()) };

const statue = join('..', 'shared', 'data', 'meshes', 'statue_hermes.fbx'), black = existsSync(statue) ? statue : null;
if (black === null) console.log('skipped: an FBX that knows no colour (the shared models are not there)');

/** A sample with its origin that far above its soles, in metres. */
function sampleFromMiddle(name, height) {
  const path = join(output, `${name}_middle.glb`);
  execFileSync(program, ['sample', name, '--quiet', '-o', path]);
  const glb = readFileSync(path), length = glb.readUInt32LE(12), gltf = JSON.parse(glb.toString('utf8', 20, 20 + length));
  const roots = gltf.scenes[gltf.scene ?? 0].nodes;
  gltf.nodes.push({ children: roots, translation: [0, -height, 0] });
  gltf.scenes[gltf.scene ?? 0].nodes = [gltf.nodes.length - 1];
  const text = Buffer.from(JSON.stringify(gltf)), json = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const head = Buffer.from(glb.subarray(0, 20));
  head.writeUInt32LE(json.length, 12);
  const whole = Buffer.concat([head, json, glb.subarray(20 + length)]);
  whole.writeUInt32LE(whole.length, 8);
  return whole;
}

/** A first visit where the engine does not come as it should. */
async function visitWithout(answer, { locale = 'en-US', file = /limber_engine.*\.(wasm|zst)/, told = '#notice' } = {}) {
  const context = await browser.newContext({ viewport: size, locale, serviceWorkers: 'block' }), visit = await context.newPage();
  await context.route(file, answer);
  await visit.goto(server.address);
  await visit.locator(told).waitFor();
  const text = await visit.locator(told).textContent();
  await context.close();
  return text;
}

/** A person whose origin is at mid-body walks on the floor that is drawn. */
async function walksOnTheFloor(page) {
  await page.locator('#file').setInputFiles({ name: 'middle.glb', mimeType: 'model/gltf-binary', buffer: sampleFromMiddle('biped', 0.9) });
  await page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'middle.glb');
  await settled(page);
  const { box } = await sessionState(page);
  assert.ok(Math.abs(box.min[1] + 0.9) < 0.02, `the soles are at ${box.min[1]}`);
  await motionPlayed(page, () => chooseMotion(page, 'walk'));
  await page.locator('#play').click();
  await settled(page);
  const feet = [await lastJointOf(page, 'left foot'), await lastJointOf(page, 'right foot')], lowest = [Infinity, Infinity];
  const { clips, clip, joints } = await sessionState(page), pinned = [];
  for (let i = 0; i < 12; ++i) {
    await page.locator('#scrub').fill((clips[clip].duration * i / 12).toFixed(3));
    await settled(page);
    for (const [side, foot] of feet.entries()) lowest[side] = Math.min(lowest[side], (await jointPosition(page, foot))[1]);
    pinned.push(await page.locator('#joints li.pinned').evaluateAll((rows) => rows.map(({ dataset }) => Number(dataset.joint))));
  }
  for (const foot of feet) {
    const held = pinned.map((shown) => shown.some((joint) => joints[joint].name === foot));
    assert.ok(held.includes(true) && held.includes(false), `${foot} is shown as pinned at ${held}`);
  }
  await page.screenshot({ path: join(output, `second_minute_floor_${page.viewportSize().width}.png`) });
  await page.locator('#clips').selectOption('');
  await settled(page);
  await page.locator('main canvas').focus();
  await page.keyboard.press('Alt+r');
  await settled(page);
  for (const [side, foot] of feet.entries()) {
    const rest = (await jointPosition(page, foot))[1];
    assert.ok(Math.abs(lowest[side] - rest) < 0.03, `${foot} is at ${lowest[side]}, standing at ${rest}`);
  }
}

/** What the engine refuses in the match is not shown, and a row that was taken out can be put in again. */
async function matchIsCorrected(page) {
  await openSample(page, 'biped');
  await motionPlayed(page, () => page.locator('#motion-file').setInputFiles(walkFile));
  await page.locator('#play').click();
  await settled(page);
  await page.locator('#retarget summary').click();
  const hand = page.getByLabel('left hand in the model'), foot = page.getByLabel('right foot in the model');
  const before = await hand.inputValue(), { match } = await sessionState(page);
  await hand.selectOption(await foot.inputValue());
  await settled(page);
  assert.match(await noticeText(page), /cannot be the left hand: another part has it/);
  assert.deepEqual((await sessionState(page)).match, match);
  assert.equal(await hand.inputValue(), before);
  await page.locator('#close-notice').click();
  // However long the engine takes, and whatever the page shows meanwhile.
  await hand.selectOption('');
  await page.locator('#loop').click();
  await page.locator('#loop').click();
  await settled(page);
  assert.ok(!(await sessionState(page)).match.some(({ part }) => part === 'leftHand'));
  await hand.selectOption(before);
  await settled(page);
  assert.ok((await sessionState(page)).match.some(({ part }) => part === 'leftHand'));
}

const cases = {
  async 'an engine that does not come is told in the user\'s words, with what to do'() {
    assert.match(await visitWithout((route) => route.abort('internetdisconnected')), /did not arrive.*connection.*load the page again/);
    assert.match(await visitWithout((route) => route.fulfill({ status: 404 })), /did not arrive.*tell whoever runs this site.*404/);
    assert.match(await visitWithout((route) => route.fulfill({ body: 'no engine' })), /cannot run the studio.*use another one/);
    const german = await visitWithout((route) => route.abort('internetdisconnected'), { locale: 'de-DE' });
    assert.match(german, /nicht angekommen.*Verbindung/);
    assert.doesNotMatch(german, /fetch/);
  },
  async 'the rest of the engine, where it does not come when it is needed, is told'() {
    const prepare = (context) => context.route(/limber_engine_rest/, (route) => route.abort('internetdisconnected'));
    const visit = await openStudio(browser, server.address, { search: '?sample=biped', prepare });
    await visit.page.locator('#file').setInputFiles({ name: 'middle.glb', mimeType: 'model/gltf-binary', buffer: sampleFromMiddle('biped', 0.9) });
    await visit.page.locator('#notice').waitFor();
    assert.match(await visit.page.locator('#notice').textContent(), /did not arrive.*connection.*load the page again/);
    await visit.context.close();
  },
  async 'the networks that read shapes come when a skeleton is fitted; where they do not, that is told, and the next try gets them'() {
    let asked = 0;
    const prepare = (context) => context.route(/shapes-.*\.lrd/, (route) => (++asked === 1 ? route.abort('internetdisconnected') : route.continue()));
    const visit = await openStudio(browser, server.address, { search: '?sample=biped', prepare }), at = visit.page;
    await settled(at);
    assert.equal(asked, 0);
    await at.locator('#methods summary').click();
    await at.locator('#rigger').selectOption('template');
    await at.locator('#notice').waitFor();
    assert.match(await at.locator('#notice').textContent(), /did not arrive.*connection/);
    await at.locator('#rigger').selectOption('curve-skeleton');
    await settled(at);
    await at.locator('#rigger').selectOption('template');
    await at.waitForFunction(() => globalThis.limberStudio.state()?.rigger === 'template');
    assert.equal(asked, 2);
    await visit.context.close();
  },
  async 'whether a model can be rigged is said before any work: what it is, its pose, what stands in the way'() {
    let asked = 0;
    const prepare = (context) => context.route(/shapes-.*\.lrd/, (route) => (++asked === 1 ? route.abort('internetdisconnected') : route.continue()));
    const visit = await openStudio(browser, server.address, { ...size, search: '?sample=biped', prepare }), at = visit.page;
    const check = async () => {
      await at.locator('#check-rig').click();
      await settled(at);
      return at.locator('#rig-check').innerText();
    };
    const given = () => at.locator('#give-skeleton').isVisible();
    await at.locator('#methods summary').click();
    const before = await sessionState(at);
    assert.match(await check(), /could not be found out now/);
    assert.deepEqual([await at.locator('#notice').isVisible(), await given()], [false, false]);
    assert.match(await check(), /^Person.*, \d+ % sure\s+A pose\s+(Nothing stands in the way\.|In doubt: .*)$/);
    assert.deepEqual([await sessionState(at), await given()], [before, true]);
    assert.deepEqual(await barriers(at), []);
    await at.screenshot({ path: join(output, 'second_minute_rig_check.png') });
    await openSample(at, 'stool');
    assert.equal(await at.locator('#rig-check').innerText(), '');
    assert.match(await check(), /^It is like no body that is known \(likeliest: .*, \d+ % sure\)\s+Handles suit it better/);
    assert.equal(await given(), false);
    await openSample(at, 'biped');
    await check();
    await at.locator('#give-skeleton').click();
    await at.waitForFunction(() => globalThis.limberStudio.state()?.rigger === 'template');
    await settled(at);
    assert.equal(await at.locator('#check-rig').isVisible(), false);
    assert.equal(asked, 2);
    await visit.context.close();
  },
  async 'a page whose code does not come or does not run says so, in all its languages'() {
    const visit = (file, answer) => visitWithout(answer, { file, told: '#apology' });
    const said = [
      await visit(/assets\/index-.*\.js$/, (route) => route.fulfill({ status: 404 })),
      await visit(/assets\/main-.*\.js$/, (route) => route.abort('internetdisconnected')),
      await visit(/assets\/main-.*\.js$/, (route) => route.fulfill({ contentType: 'text/javascript', body: 'throw new Error("too old")' })),
    ];
    for (const text of said) assert.match(text, /did not arrive[^]*load the page again[^]*nicht angekommen[^]*lade die Seite neu/);
    assert.match(said[0], /assets\/index-.*\.js/);
    assert.match(said[1], /assets\/main-.*\.js/);
    assert.match(said[2], /too old/);
  },
  async 'who leaves before all is written is asked first'() {
    await kept();
    // Another one who writes holds the store up.
    await page.evaluate(() => new Promise((held) => {
      indexedDB.open('limber-studio').onsuccess = ({ target: { result } }) => {
        const store = result.transaction(['documents', 'requests'], 'readwrite').objectStore('requests');
        const again = () => { if (!globalThis.letGo) store.count().onsuccess = again; };
        again();
        held();
      };
    }));
    const hand = await dragHand(page), at = await jointPosition(page, hand);
    const [asked] = await Promise.all([page.waitForEvent('dialog'), page.close({ runBeforeUnload: true })]);
    assert.equal(asked.type(), 'beforeunload');
    await asked.dismiss();
    await page.evaluate(() => { globalThis.letGo = true; });
    await kept();
    let dialogs = 0;
    page.on('dialog', (dialog) => { ++dialogs; void dialog.accept(); });
    await page.goto(server.address);
    await settled(page);
    assert.equal(dialogs, 0, 'asked though all was written');
    assert.ok(distance(await jointPosition(page, hand), at) < 1e-5);
  },
  async 'in two tabs nothing is lost, and the second says that it goes on with a copy'() {
    const second = await desk.context.newPage();
    await second.goto(server.address);
    await settled(second);
    assert.match(await noticeText(second), /open in another tab as well.*copy/);
    const hand = await dragHand(page, -30), other = await dragHand(second, 50);
    await Promise.all([kept(page), kept(second)]);
    const [here, there] = [await jointPosition(page, hand), await jointPosition(second, other)];
    assert.ok(distance(here, there) > 0.05);
    await second.close();
    await page.goto(server.address);
    await settled(page);
    const found = [await jointPosition(page, hand)], { undo } = await sessionState(page);
    assert.ok(undo, 'the last one is open again, with what was done');
    await page.locator('#open-recent').click(); // it lists the others
    await page.locator('#recent li', { hasText: 'biped' }).first().locator('.pick').click();
    await page.waitForFunction((before) => globalThis.limberStudio.idle() && JSON.stringify(globalThis.limberStudio.position(before[0])) !== before[1], [hand, JSON.stringify(found[0])]);
    await settled(page);
    found.push(await jointPosition(page, hand));
    for (const place of [here, there]) assert.ok(found.some((one) => distance(one, place) < 1e-5), `${place} is not in ${JSON.stringify(found)}`);
  },
  async 'a person whose origin is at mid-body walks on the floor that is drawn'() { await walksOnTheFloor(page); },
  async 'what the engine refuses in the match is not shown, and a row that was taken out can be put in again'() { await matchIsCorrected(page); },
  async 'both on a narrow screen as well'() {
    const narrow = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, isMobile: true, search: '?sample=stool' });
    await walksOnTheFloor(narrow.page);
    await matchIsCorrected(narrow.page);
    assert.deepEqual(narrow.errors, []);
    await narrow.context.close();
  },
  async 'a shelf that does not come says so, and comes when it is asked for again'() {
    const visit = await openStudio(browser, server.address, { ...size, search: '?sample=biped' });
    for (const [opener, dialog, file] of [['#open-shelf', '#shelf', /assets\/motion_shelf-.*\.js$/], ['#open-poses', '#poses', /assets\/pose_library-.*\.js$/]]) {
      await visit.context.route(file, (route) => route.abort('internetdisconnected'));
      await visit.page.locator(opener).click();
      await visit.page.locator('#notice').waitFor();
      assert.match(await noticeText(visit.page), /did not arrive.*connection/);
      await visit.page.locator('#close-notice').click();
      assert.equal(await visit.page.locator(dialog).count(), 0);
      await visit.context.unroute(file);
      await visit.page.locator(opener).click();
      await visit.page.locator(dialog).waitFor();
      await visit.page.keyboard.press('Escape');
    }
    await visit.context.close();
  },
  async 'what the browser throws away while the page is open is told, before more is lost'() {
    const visit = await openStudio(browser, server.address, { ...size, search: '?sample=biped' });
    await kept(visit.page);
    const wire = await visit.context.newCDPSession(visit.page);
    await wire.send('Storage.clearDataForOrigin', { origin: new URL(server.address).origin, storageTypes: 'indexeddb' });
    const hand = await dragHand(visit.page), there = await jointPosition(visit.page, hand);
    await visit.page.locator('#notice').waitFor();
    assert.match(await noticeText(visit.page), /cannot keep your work.*Save it as a file before you leave/);
    const [asked] = await Promise.all([visit.page.waitForEvent('dialog'), visit.page.close({ runBeforeUnload: true })]);
    assert.equal(asked.type(), 'beforeunload');
    await asked.dismiss();
    const saved = await download(visit.page, () => visit.page.locator('#export-as').selectOption('limber'));
    await visit.context.close();
    const again = await openStudio(browser, server.address, { ...size, search: '?sample=stool' });
    await again.page.locator('#file').setInputFiles({ name: 'saved.limber', mimeType: 'application/zip', buffer: saved });
    await again.page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'biped');
    await settled(again.page);
    assert.ok(distance(await jointPosition(again.page, hand), there) < 1e-5);
    await again.context.close();
  },
  ...(black === null ? {} : { async 'an FBX that knows no colour is drawn lit'() {
    await page.locator('#file').setInputFiles(black);
    await page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'statue_hermes.fbx');
    await settled(page);
    const png = await download(page, async () => {
      await page.locator('#export-as').selectOption('pictures');
      await page.locator('#picture').click();
    });
    const light = await page.evaluate(async (bytes) => {
      const image = await createImageBitmap(new Blob([new Uint8Array(bytes)])), context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height), seen = [];
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 250) seen.push(data[i + 1]);
      return seen.sort((a, b) => a - b)[seen.length >> 1];
    }, [...png]);
    assert.ok(light > 60, `half of it is darker than ${light} of 255`);
  } }),
  async 'nothing was thrown'() { assert.deepEqual(desk.errors, []); },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
