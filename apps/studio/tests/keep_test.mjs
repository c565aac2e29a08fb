// Nothing is lost, nothing surprises: what is kept over reloads and crashes, what is asked before it is replaced, quick
// changes of mind, files that belong together.
//
//   node apps/studio/tests/keep_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// The page killed at any moment: kill_test.mjs. Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { walkBvh } from './walk_bvh.mjs';
import { answer, barriers, chooseMotion, download, jointPlace, jointPosition, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const size = { width: 900, height: 600 };
const desk = await openStudio(browser, server.address, { ...size, search: '?sample=biped' });
let { page } = desk;
const errors = [...desk.errors];

/** Another page of the same browser profile, as after a crash: what it had is what is kept. */
async function reopened() {
  await page.waitForFunction(() => globalThis.limberStudio.kept());
  await page.close({ runBeforeUnload: false });
  page = await desk.context.newPage();
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  await page.goto(server.address);
  await settled(page);
}

const wanted = ['name', 'joints', 'clips', 'motions', 'match', 'clip', 'targets', 'pins', 'undo', 'redo', 'ik', 'limited', 'posed'];
async function standing() {
  const state = await sessionState(page), places = [];
  for (const { name } of state.joints) places.push(await jointPosition(page, name));
  return { ...Object.fromEntries(wanted.map((part) => [part, state[part]])), places };
}
function expectSame(now, before) {
  for (const part of wanted) assert.deepEqual(now[part], before[part], part);
  now.places.forEach((place, joint) => place.forEach((value, i) => assert.ok(Math.abs(value - before.places[joint][i]) < 1e-5, `joint ${joint}`)));
}

const keys = async (key) => {
  await page.locator('main canvas').focus();
  await page.keyboard.press(key);
};
const open = (files) => page.locator('#file').setInputFiles(files.map(([name, buffer]) => ({ name, mimeType: 'application/octet-stream', buffer })));
const opened = async (name) => {
  await page.waitForFunction((wantedName) => globalThis.limberStudio.state()?.name === wantedName, name);
  await settled(page);
};

/** A square of two triangles as glTF with its buffer beside it. */
function squareFiles() {
  const positions = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]), triangles = new Uint16Array([0, 1, 2, 0, 2, 3]);
  const bytes = Buffer.concat([Buffer.from(positions.buffer), Buffer.from(triangles.buffer)]);
  const gltf = {
    asset: { version: '2.0' }, buffers: [{ uri: 'square%20data.bin', byteLength: bytes.length }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 12 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5123, count: 6, type: 'SCALAR' }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }], nodes: [{ mesh: 0 }], scenes: [{ nodes: [0] }], scene: 0,
  };
  return [['square.gltf', Buffer.from(JSON.stringify(gltf))], ['square data.bin', bytes]];
}

/** Stored, not packed. */
function zipOf(files) {
  const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n;
  });
  const crcOf = (bytes) => ~bytes.reduce((crc, byte) => crcTable[(crc ^ byte) & 255] ^ (crc >>> 8), ~0) >>> 0;
  const parts = [], directory = [];
  let at = 0;
  for (const [name, bytes] of files) {
    const path = Buffer.from(`folder/${name}`), fields = Buffer.alloc(26);
    fields.writeUInt16LE(20, 0);
    fields.writeUInt32LE(crcOf(bytes), 10);
    fields.writeUInt32LE(bytes.length, 14);
    fields.writeUInt32LE(bytes.length, 18);
    fields.writeUInt16LE(path.length, 22);
    parts.push(Buffer.from('PK\x03\x04', 'latin1'), fields, path, bytes);
    const tail = Buffer.alloc(14);
    tail.writeUInt32LE(at, 10);
    directory.push(Buffer.concat([Buffer.from('PK\x01\x02\x14\x00', 'latin1'), fields, tail, path]));
    at += 30 + path.length + bytes.length;
  }
  const listed = Buffer.concat(directory), end = Buffer.alloc(18);
  end.writeUInt16LE(files.length, 4);
  end.writeUInt16LE(files.length, 6);
  end.writeUInt32LE(listed.length, 8);
  end.writeUInt32LE(at, 12);
  return Buffer.concat([...parts, listed, Buffer.from('PK\x05\x06', 'latin1'), end]);
}

const walk = () => chooseMotion(page, 'walk');

function chunksOf(png) {
  const chunks = [];
  for (let at = 8; at < png.length;) {
    const length = png.readUInt32BE(at);
    chunks.push({ kind: png.toString('latin1', at + 4, at + 8), data: png.subarray(at + 8, at + 8 + length) });
    at += length + 12;
  }
  return chunks;
}

const cases = {
  async 'a drag that was never ended stays as far as it went'() {
    await page.goto(`${server.address}?sample=biped`);
    await settled(page);
    const place = await page.evaluate(() => globalThis.limberStudio.place(globalThis.limberStudio.state().joints.at(-1).name));
    const { name } = (await sessionState(page)).joints.at(-1);
    await page.mouse.move(place.x, place.y);
    await page.mouse.down();
    await page.mouse.move(place.x + 40, place.y - 20, { steps: 4 });
    await page.waitForFunction(() => {
      const { idle, kept, state } = globalThis.limberStudio;
      return idle() && kept() && state().dragged !== null;
    });
    const dragged = await sessionState(page);
    assert.notEqual(dragged.dragged, null, 'nothing is dragged');
    const moved = dragged.joints[dragged.dragged].name, before = await jointPosition(page, moved);
    await reopened();
    const after = await jointPosition(page, moved);
    after.forEach((value, i) => assert.ok(Math.abs(value - before[i]) < 1e-5, `${moved} ${name}`));
    assert.equal((await sessionState(page)).undo, 'end_drag');
    // What follows is kept behind the drag's end.
    await keys('m');
    await page.waitForFunction(() => globalThis.limberStudio.idle() && globalThis.limberStudio.kept());
    await reopened();
    assert.equal((await sessionState(page)).undo, 'mirror_pose');
  },
  async 'a motion, its match and what undo takes back are there after a reload'() {
    await page.goto(`${server.address}?sample=biped`);
    await settled(page);
    await motionPlayed(page, () => page.locator('#motion-file').setInputFiles({ name: 'walk.bvh', mimeType: 'text/plain', buffer: Buffer.from(walkBvh()) }));
    await page.locator('#play').click();
    await settled(page);
    await page.locator('#method').selectOption('aligned');
    await settled(page);
    const before = await standing();
    assert.ok(before.match.length > 10);
    await reopened();
    expectSame(await standing(), before);
    assert.ok(await page.locator('#retarget').isVisible());
    await page.locator('#undo').click();
    await settled(page);
    assert.equal((await sessionState(page)).clips[0].source.method, 'limb-ik');
  },
  async 'a part that was taken out of the match can be put in again'() {
    await page.locator('#retarget summary').click();
    const has = async () => (await sessionState(page)).match.some(({ part }) => part === 'leftHand');
    const select = page.getByLabel('left hand in the model');
    const joint = await select.inputValue();
    await select.selectOption('');
    await settled(page);
    assert.equal(await has(), false);
    await page.getByLabel('left hand in the model').selectOption(joint);
    await settled(page);
    assert.equal(await has(), true);
  },
  async 'a corrected frame takes its neighbours along, and stays when the motion is made anew'() {
    await page.locator('#method').selectOption('limb-ik');
    await settled(page);
    const hand = 'leftHand', scrub = async (seconds) => {
      await page.locator('#scrub').fill(String(seconds));
      await settled(page);
    };
    const { joints, match } = await sessionState(page), [joint] = match.find(({ part }) => part === hand).target;
    await scrub(0.5);
    const before = await jointPosition(page, joint);
    await page.locator('#joints li').nth(joints.findIndex(({ name }) => name === joint)).click();
    await page.locator('main canvas').focus();
    for (let i = 0; i < 12; ++i) await page.keyboard.press('ArrowUp');
    await settled(page);
    assert.equal((await sessionState(page)).clips[0].keys.length, 1, 'what is posed becomes a key');
    const distances = [];
    let last = null;
    for (let frame = 5; frame <= 25; ++frame) {
      await scrub((frame / 30).toFixed(4));
      const now = await jointPosition(page, joint);
      if (last) distances.push(Math.hypot(...now.map((value, i) => value - last[i])));
      last = now;
    }
    await scrub(0.5);
    const moved = Math.hypot(...(await jointPosition(page, joint)).map((value, i) => value - before[i]));
    assert.ok(moved > 0.03, `${joint} moved by ${moved}`);
    assert.ok(Math.max(...distances) < 0.5 * moved + 0.05, `a jump of ${Math.max(...distances)} m`);
    await page.locator('#method').selectOption('spacetime');
    await settled(page);
    assert.ok(await page.locator('#ask').isHidden(), 'the correction stays, so nothing is asked');
    assert.equal((await sessionState(page)).clips[0].keys.length, 1);
  },
  async 'the view turns by keys, and a pose on a new clip stays'() {
    await page.goto(`${server.address}?sample=biped`);
    await settled(page);
    const places = () => page.evaluate(() => globalThis.limberStudio.state().joints.map(({ name }) => globalThis.limberStudio.place(name).x));
    await page.locator('main canvas').focus();
    const before = await places();
    await page.keyboard.press('ArrowRight');
    await settled(page);
    const after = await places();
    assert.ok(after.some((x, joint) => Math.abs(x - before[joint]) > 3));
    await page.locator('#add-clip').click();
    await settled(page);
    const joint = (await sessionState(page)).joints.at(-1).name;
    await page.locator('#joints li').last().click();
    await page.locator('main canvas').focus();
    await page.keyboard.press('ArrowUp');
    await settled(page);
    const posed = await jointPosition(page, joint);
    await page.locator('#scrub').fill('1');
    await settled(page);
    await page.locator('#scrub').fill('0');
    await settled(page);
    (await jointPosition(page, joint)).forEach((value, i) => assert.ok(Math.abs(value - posed[i]) < 1e-5));
    assert.equal((await sessionState(page)).clips[0].keys.length, 1);
  },
  async 'what was open before is under Recent'() {
    await page.goto(`${server.address}?sample=stool`);
    await settled(page);
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await page.locator('#open-recent').click();
    const entries = page.locator('#recent li');
    await entries.first().waitFor();
    const before = await entries.count();
    await page.locator('#recent li', { hasText: 'biped' }).first().locator('.pick').click();
    await opened('biped');
    await page.locator('#open-recent').click();
    await entries.first().waitFor();
    await entries.first().getByRole('button', { name: /Forget/ }).click();
    await page.waitForFunction((count) => document.querySelectorAll('#recent li').length < count, before);
    await page.keyboard.press('Escape');
  },
  async 'of forty quick choices the last one counts, with a clip playing'() {
    await motionPlayed(page, walk);
    const names = ['quadruped', 'stool', 'biped', 'robot', 'winged'];
    for (let i = 0; i < 40; ++i) await page.locator('#samples').selectOption(i === 39 ? 'stool' : names[i % names.length]);
    await opened('stool');
    assert.equal((await sessionState(page)).name, 'stool');
    assert.equal(await page.locator('#notice').isVisible(), false);
    assert.equal(await page.locator('[data-value=handles]').getAttribute('aria-pressed'), 'true');
  },
  async 'a skeleton takes the place of handles only where the user agrees'() {
    await page.locator('#samples').selectOption('biped');
    await opened('biped');
    await page.locator('#handles').evaluate((slider) => { slider.value = '250'; slider.dispatchEvent(new Event('input')); });
    await settled(page);
    const before = await standing();
    assert.ok(before.joints.length < 6);
    await walk();
    await answer(page, false);
    expectSame(await standing(), before);
    await walk();
    await answer(page, true);
    assert.equal((await sessionState(page)).clips.length, 1);
  },
  async 'handles take the place of named joints only where the user agrees'() {
    await page.locator('#samples').selectOption('biped');
    await opened('biped');
    await motionPlayed(page, walk);
    const glb = await download(page, () => page.locator('#save-glb').click());
    await open([['person.glb', glb]]);
    await opened('person.glb');
    const before = await standing();
    assert.equal((await sessionState(page)).own_rig, true);
    await page.locator('#open-shelf').click();
    const animal = page.locator('#shelf [data-motion=quadruped-walk][aria-disabled=true]');
    await animal.waitFor();
    assert.match(await animal.getAttribute('title'), /too little in common/);
    await page.keyboard.press('Escape');
    expectSame(await standing(), before);
    await page.locator('#handles').focus();
    await page.keyboard.press('ArrowLeft');
    await answer(page, false);
    expectSame(await standing(), before);
    assert.equal(Number(await page.locator('.count').textContent()), before.joints.length);
    await page.locator('#handles').focus();
    await page.keyboard.press('ArrowLeft');
    await answer(page, true);
    assert.equal((await sessionState(page)).own_rig, false);
    await page.locator('#undo').click();
    await settled(page);
    expectSame({ ...await standing(), redo: null }, before);
  },
  async 'a glTF opens with the buffer beside it, also from a ZIP archive'() {
    await open(squareFiles());
    await opened('square.gltf');
    assert.equal((await sessionState(page)).vertices, 4);
    await page.locator('#samples').selectOption('stool');
    await opened('stool');
    await open([['square.zip', zipOf(squareFiles())]]);
    await opened('square.gltf');
    await open([['broken.zip', Buffer.from('PK\x03\x04 nothing', 'latin1')]]);
    await page.locator('#notice').waitFor();
    await page.locator('#close-notice').click();
  },
  async 'a .limber file brings everything back, here and in the program'() {
    await page.locator('#samples').selectOption('biped');
    await opened('biped');
    await motionPlayed(page, () => page.locator('#motion-file').setInputFiles({ name: 'walk.bvh', mimeType: 'text/plain', buffer: Buffer.from(walkBvh()) }));
    await page.locator('#play').click();
    await settled(page);
    await page.locator('#method').selectOption('aligned');
    await settled(page);
    const before = await standing(), file = await download(page, () => page.locator('#export-as').selectOption('limber'));
    writeFileSync(join(output, 'walking.limber'), file);
    execFileSync(program, ['session', 'replay', join(output, 'walking.limber'), '-o', join(output, 'from_limber.glb'), '--quiet']);
    await page.locator('#samples').selectOption('stool');
    await opened('stool');
    await open([['walking.limber', file]]);
    await opened('biped');
    expectSame(await standing(), before);
    await open([['cut.limber', file.subarray(0, file.length / 2)]]);
    await page.locator('#notice').waitFor();
    await page.locator('#close-notice').click();
    await reopened();
    expectSame(await standing(), before);
  },
  async 'an OBJ has as many vertices as its file'() {
    const obj = 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 5 2\nf 2 5 3\n';
    await open([['shape.obj', Buffer.from(obj)]]);
    await opened('shape.obj');
    assert.equal((await sessionState(page)).vertices, 5);
  },
  async 'an OBJ has the texture that lies beside it'() {
    const obj = 'mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paper\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n';
    const dot = 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==';
    await open([['square.obj', Buffer.from(obj)], ['square.mtl', Buffer.from('newmtl paper\nmap_Kd dot.png\n')], ['dot.png', Buffer.from(dot, 'base64')]]);
    await opened('square.obj');
    const glb = await download(page, () => page.locator('#save-glb').click());
    assert.ok(glb.includes(Buffer.from('\x89PNG', 'latin1')), 'no picture is in it');
  },
  async 'pictures and films show the model and no tools'() {
    await page.locator('#samples').selectOption('biped'); // nothing of it is as red as a handle
    await opened('biped');
    await page.setViewportSize({ width: 800, height: 500 }); // the films of a smaller page take less long
    const take = (button) => download(page, async () => {
      await page.locator('#export-as').selectOption('pictures');
      await page.locator(button).click();
    });
    const colors = (png) => page.evaluate(async (bytes) => {
      const image = await createImageBitmap(new Blob([new Uint8Array(bytes)])), canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [image.width, image.height];
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      let handles = 0, opaque = 0, white = 0;
      for (let i = 0; i < data.length; i += 4) {
        opaque += data[i + 3] > 250;
        white += data[i] + data[i + 1] + data[i + 2] + data[i + 3] === 4 * 255;
        handles += data[i + 3] > 250 && data[i] > 180 && data[i + 1] < 80 && data[i + 2] < 90;
      }
      return { handles, opaque, white, corner: data[3], all: data.length / 4 };
    }, [...png]);
    const red = await colors(await take('#picture'));
    assert.equal(red.handles, 0);
    assert.equal(red.corner, 0, 'the corner is not transparent');
    assert.ok(red.opaque > red.all / 100, `${red.opaque} of ${red.all} pixels are opaque`);
    await page.locator('#export-as').selectOption('pictures');
    assert.ok(await page.locator('#film-clip').isDisabled());
    await page.locator('#no-background').uncheck();
    const onWhite = await colors(await download(page, () => page.locator('#picture').click()));
    assert.equal(onWhite.opaque, onWhite.all);
    assert.ok(onWhite.white > onWhite.all / 4 && onWhite.handles === 0);
    const joint = (await sessionState(page)).joints.at(-1).name, before = await jointPlace(page, joint), turn = await take('#film-turn');
    assert.equal(turn.readUInt32BE(0), 0x1a45dfa3); // EBML
    const after = await jointPlace(page, joint);
    assert.ok(Math.hypot(after.x - before.x, after.y - before.y) < 0.01, 'the view is another one');
    await motionPlayed(page, () => page.locator('#motion-file').setInputFiles({ name: 'walk.bvh', mimeType: 'text/plain', buffer: Buffer.from(walkBvh()) }));
    await page.locator('#export-as').selectOption('pictures');
    await page.locator('#no-background').check();
    const moving = await download(page, () => page.locator('#moving-picture').click()), chunks = chunksOf(moving);
    writeFileSync(join(output, 'walk.png'), moving);
    const frames = chunks.find(({ kind }) => kind === 'acTL').data;
    assert.equal(frames.readUInt32BE(0), 20, 'pictures of a second');
    assert.equal(frames.readUInt32BE(4), 0, 'it repeats for ever');
    assert.equal(chunks.filter(({ kind }) => kind === 'fcTL').length, 20);
    const first = await colors(moving);
    assert.equal(first.handles, 0);
    assert.equal(first.corner, 0);
    assert.equal(await page.evaluate(async (bytes) => {
      const decoder = new ImageDecoder({ data: new Uint8Array(bytes), type: 'image/png' });
      await Promise.all([decoder.tracks.ready, decoder.completed]);
      const { frameCount } = decoder.tracks.selectedTrack, { image } = await decoder.decode({ frameIndex: frameCount - 1 });
      image.close(); // else the console complains
      decoder.close();
      return frameCount;
    }, [...moving]), 20, 'a browser plays them all');
    const film = await take('#film-clip');
    writeFileSync(join(output, 'walk.webm'), film);
    assert.equal(film.readUInt32BE(0), 0x1a45dfa3);
    assert.ok(film.length > 10_000, `${film.length} bytes`);
    await page.setViewportSize(size);
    await settled(page);
  },
  async 'without WebGL the page says so'() {
    const context = await browser.newContext({ viewport: size }), other = await context.newPage();
    await other.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
    await other.goto(server.address);
    await other.locator('#apology').waitFor();
    await context.close();
  },
  async 'where the browser keeps nothing, the page says so'() {
    const context = await browser.newContext({ viewport: size }), other = await context.newPage();
    await other.addInitScript(() => { Object.defineProperty(globalThis, 'indexedDB', { value: { open: () => { throw new Error('no storage'); } } }); });
    await other.goto(`${server.address}?sample=stool`);
    await other.waitForFunction(() => /cannot keep/.test(document.querySelector('#notice')?.textContent ?? ''));
    await context.close();
  },
  async 'everybody can use every state of the page'() {
    for (const [width, height, schemes] of [[1280, 800, ['light', 'dark']], [390, 844, ['light']]]) {
      const { page: at, context } = await openStudio(browser, server.address, { width, height, touch: width < 500, search: '?sample=biped' });
      const expectNone = async (state) => {
        for (const colorScheme of schemes) {
          await at.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
          assert.deepEqual(await barriers(at), [], `${state}, ${colorScheme}, ${width} wide`);
        }
      };
      await expectNone('a model');
      await motionPlayed(at, () => chooseMotion(at, 'walk'));
      await at.locator('#play').click();
      await settled(at);
      await at.locator('#retarget summary').click();
      await at.locator('#methods summary').click();
      await expectNone('a motion');
      await at.locator('#open-recent').click();
      await at.locator('#recent').waitFor();
      await expectNone('recent');
      await at.keyboard.press('Escape');
      await at.keyboard.press('?');
      await at.locator('#help').waitFor();
      await expectNone('help');
      await at.keyboard.press('Escape');
      await at.locator('#file').setInputFiles({ name: 'none.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('glTF nothing') });
      await at.locator('#notice').waitFor();
      await expectNone('an error');
      await context.close();
    }
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
