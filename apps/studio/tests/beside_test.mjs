// What stands beside the model: comparisons, a second character, contact sheets, limits, the outliner's lists, and
// models of other formats.
//
//   node apps/studio/tests/beside_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { asciiFbx, asciiPly, binaryStl, triangleCount, vertexCount, vrmOf } from './small_files.mjs';
import { walkBvh } from './walk_bvh.mjs';
import { barriers, download, jointPlace, jointPosition, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 1000, height: 640, search: '?sample=biped' });

const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const columns = (count) => page.waitForFunction((n) => document.querySelectorAll('#comparison dl').length === n, count);

async function openMotion(name, buffer) {
  await motionPlayed(page, () => page.locator('#motion-file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer }));
  await settled(page);
  assert.equal(await page.locator('#notice').isVisible(), false, await page.locator('#notice').textContent());
}

/** At a place of the slider, in thousandths. */
async function setHandles(place) {
  await page.locator('#handles').evaluate((slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }, String(place));
  await settled(page);
}

async function pause() {
  if ((await page.locator('#play').getAttribute('aria-pressed')) === 'true') await page.locator('#play').click();
  await settled(page);
}

/** The figures below each of those that are compared. */
const measured = () => page.$$eval('#comparison dl', (lists) => lists.map((list) => Object.fromEntries(
  [...list.querySelectorAll('dt')].map((name) => [name.textContent, name.nextElementSibling.textContent]))));

const limits = (joint) => JSON.stringify({
  limber_limits: 1, joints: { [joint]: { type: 'ball-and-socket', x: [-40, 60], z: [-30, 30], twist: [-20, 20] } },
});

let walking = null;
const cases = {
  async 'another rigger stands beside the model, with figures below each'() {
    await page.locator('#methods summary').click();
    await page.locator('#compare-rigger').click();
    await columns(2);
    await settled(page);
    const { joints } = await sessionState(page);
    const [own, other] = await measured();
    assert.equal(Number(own.Joints), joints.length);
    assert.notDeepEqual(other, own, 'the other rigger\'s figures are those of the first');
    assert.equal((await sessionState(page)).undo, null, 'the document was changed');
    await page.locator('#end-comparison').click();
    await settled(page);
    assert.equal(await page.locator('#comparison').isVisible(), false);
  },
  async 'a comparison goes along with the pose'() {
    await page.locator('#compare-solver').click();
    await page.getByLabel('The method beside it').selectOption('fabrik');
    await columns(2);
    const { targets } = await sessionState(page);
    await page.locator('#joints li').last().click();
    await page.locator('#pin').click();
    await page.locator('main canvas').focus();
    await page.keyboard.press('ArrowUp');
    await settled(page);
    await page.waitForFunction(() => document.querySelectorAll('#comparison dl').length === 2 && globalThis.limberStudio.idle());
    assert.ok((await measured()).every((figures) => 'Pins missed by' in figures));
    await page.locator('#end-comparison').click();
    await page.locator('#targets li button').last().click();
    await settled(page);
    assert.equal((await sessionState(page)).targets.length, targets.length);
    await page.locator('#reset').click();
    await settled(page);
  },
  async 'a row of a study\u2019s report stands beside the model, with the report\u2019s figures'() {
    const { undo } = await sessionState(page);
    const cell = (more) => ({ kind: 'rig', group: '', model: 'fox', motion: '', skinning: 'bone-heat', options: '', retargeting: '', solver: '', outcome: 'done', problem: '', ...more });
    const cells = [cell({ rigger: 'uni<b>rig</b>', measure: 'joint_to_joint', value: 1 }), cell({ rigger: 'own', measure: 'seconds', value: 1 }),
      cell({ rigger: 'curve-skeleton', options: '2 influences', measure: 'joint_to_joint', value: 3.25 }), cell({ rigger: 'sphere-mesh', measure: 'joint_to_joint', value: 4 }),
      cell({ kind: 'retarget', rigger: '', skinning: '', retargeting: 'copy', measure: 'sliding', value: 2 })];
    const bring = (input, text) => page.locator(input).setInputFiles({ name: 'cells.json', mimeType: 'application/json', buffer: Buffer.from(text) });
    await bring('#report-file', JSON.stringify({ title: 'Riggers', cells }));
    await columns(3); // the model's, the row's, and the report's own
    await settled(page);
    const choice = page.getByLabel('The method beside it');
    assert.equal(await choice.inputValue(), 'curve-skeleton + bone-heat, 2 influences');
    assert.deepEqual(await choice.locator('option:disabled').allTextContents(),
      ['uni<b>rig</b> + bone-heat (not in the page)', 'own + bone-heat (keeps each model\u2019s own skeleton)', 'copy (needs a motion)']);
    const [own, other, reported] = await measured();
    assert.notDeepEqual(other, own);
    assert.deepEqual(reported, { 'Ended well': '1/1', 'joint to joint': '3.25' });
    await page.locator('#comparison .report summary').click();
    await page.screenshot({ path: join(output, 'beside_report.png') });
    assert.match(await page.locator('#comparison .report').textContent(), /options that are not set here: 2 influences/);
    await page.locator('#compare-another').click();
    await columns(5);
    await settled(page);
    assert.equal(await page.locator('#compare-another').isDisabled(), true);
    assert.deepEqual(await barriers(page), []);
    assert.equal((await sessionState(page)).undo, undo, 'the document was changed');
    await page.locator('#end-comparison').click();
    await settled(page);
    // As any other file; what is no report is refused, and one of which nothing can be done says so.
    for (const [text, notice] of [['{"cells":[7]}', /holds no rows/], [JSON.stringify({ cells: cells.slice(0, 2) }), /none of the report\u2019s rows.*uni<b>rig/]]) {
      await bring('#file', text);
      await page.locator('#notice').waitFor();
      assert.match(await page.locator('#notice').textContent(), notice);
      await page.locator('#close-notice').click();
    }
    assert.equal(await page.locator('#comparison').isVisible(), false);
  },
  async 'handles that make no person become a named skeleton when a motion is opened'() {
    await setHandles(330);
    assert.ok((await sessionState(page)).joints.length < 9);
    await openMotion('walk.bvh', Buffer.from(walkBvh()));
    await pause();
    const { rigger, clips, match } = await sessionState(page);
    assert.equal(rigger, 'template');
    assert.equal(clips[0].name, 'walk');
    assert.ok(match.length > 14);
    walking = await download(page, () => page.locator('#save-glb').click());
  },
  async 'methods of retargeting are compared by what they do to the motion'() {
    await page.locator('#compare-retargeting').click();
    await columns(2);
    await page.locator('#compare-another').click();
    await columns(3);
    for (const figures of await measured()) assert.match(figures['Feet slide'], /cm\/s/);
    await page.locator('#end-comparison').click();
    await settled(page);
    // A row of a report does the same.
    const row = { kind: 'retarget', group: '', model: 'fox', motion: 'walk', retargeting: 'copy', solver: '', outcome: 'done', measure: 'sliding', value: 2 };
    await page.locator('#report-file').setInputFiles({ name: 'cells.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify({ cells: [row] })) });
    await columns(3);
    const [own, copied, reported] = await measured();
    assert.match(copied['Feet slide'], /cm\/s/);
    assert.notDeepEqual(copied, own);
    assert.equal(reported.sliding, '2');
    await page.locator('#end-comparison').click();
    await settled(page);
  },
  async 'a clip at a glance'() {
    const before = await page.locator('#time').textContent();
    await page.locator('#open-sheet').click();
    await page.locator('#contact-sheet').waitFor({ state: 'visible' });
    // Its pictures differ from each other, and are not empty.
    const sums = await page.locator('#sheet').evaluate((sheet) => [0, 1, 2].map((i) => {
      const { data } = sheet.getContext('2d').getImageData(8 + 328 * i, 8 + 248, 320, 200);
      return data.reduce((sum, value) => sum + value, 0);
    }));
    assert.equal(new Set(sums).size, 3);
    assert.ok((await download(page, () => page.locator('#save-sheet').click())).length > 5000);
    await page.locator('#contact-sheet').getByRole('button', { name: 'Close' }).click();
    assert.equal(await page.locator('#time').textContent(), before);
  },
  async 'clips are listed, renamed, and kept by another number of handles'() {
    await page.locator('#clip-list li').first().dblclick();
    await page.locator('#rename').fill('stroll');
    await page.keyboard.press('Enter');
    await settled(page);
    assert.deepEqual((await sessionState(page)).clips.map(({ name }) => name), ['stroll']);
    await setHandles(600);
    const { clips, rigger } = await sessionState(page);
    assert.equal(rigger, 'sphere-mesh');
    assert.deepEqual(clips.map(({ name }) => name), ['stroll']);
    assert.ok(Math.abs(clips[0].duration - 1) < 0.02);
  },
  async 'a second character plays beside the first'() {
    await page.locator('#samples').selectOption('robot');
    await page.waitForFunction(() => globalThis.limberStudio.state().name === 'robot');
    await settled(page);
    await openMotion('walker.glb', walking);
    await pause();
    assert.equal((await sessionState(page)).clips[0].source.motion, 'walker');
    await page.locator('#source-shown').waitFor({ state: 'visible' });
    await page.screenshot({ path: `${output}/second_character.png` });
    const canvas = page.locator('main canvas');
    const shown = await canvas.screenshot();
    await page.locator('#source-shown').uncheck();
    await settled(page);
    assert.ok(!shown.equals(await canvas.screenshot()), 'nothing was drawn for it');
  },
  async 'a mesh is hidden and shown'() {
    await page.locator('#meshes').evaluate((list) => { list.parentElement.open = true; });
    const canvas = page.locator('main canvas');
    const shown = await canvas.screenshot();
    await page.locator('#meshes button').first().click();
    await settled(page);
    assert.ok(!shown.equals(await canvas.screenshot()));
    await page.locator('#meshes button').first().click();
    await settled(page);
  },
  async 'limits are loaded and drawn as cones'() {
    await page.locator('#samples').selectOption('biped');
    await settled(page);
    const { joints } = await sessionState(page);
    const joint = joints.find(({ parent }) => parent === 0).name;
    await page.locator('#file').setInputFiles({ name: 'limits.json', mimeType: 'application/json', buffer: Buffer.from(limits(joint)) });
    await page.waitForFunction(() => globalThis.limberStudio.state().limited);
    const { limit_outlines: outlines } = await sessionState(page);
    assert.equal(outlines.length, 1);
    assert.equal(joints[outlines[0].joint].name, joint);
    assert.ok(outlines[0].rim.every((at) => Math.abs(Math.hypot(...at) - 1) < 1e-6));
    const canvas = page.locator('main canvas');
    const shown = await canvas.screenshot();
    await page.locator('#limits').uncheck();
    await settled(page);
    assert.ok(!shown.equals(await canvas.screenshot()), 'no cone was drawn');
    await page.locator('#file').setInputFiles({ name: 'limits.json', mimeType: 'application/json', buffer: Buffer.from(limits('nobody')) });
    await page.locator('#notice').waitFor({ state: 'visible' });
    await page.locator('#close-notice').click();
    assert.equal((await sessionState(page)).limited, true, 'what was there went');
    await page.locator('#undo').click();
    await settled(page);
  },
  async 'a ring of the gizmo turns the joint while it is dragged'() {
    await page.locator('#gizmo').check();
    const { joints } = await sessionState(page);
    // One with something that hangs on it, to see it turn.
    const child = joints.findIndex(({ parent }) => parent > 0), name = joints[joints[child].parent].name;
    await page.locator(`#joint-${joints[child].parent}`).click();
    await page.locator('main canvas').focus();
    await page.keyboard.press('1');
    await page.keyboard.press('r');
    await settled(page);
    const place = await jointPlace(page, name), before = await jointPosition(page, joints[child].name);
    // The ring that faces the camera.
    let radius = 20;
    for (; radius < 150; radius += 2) {
      await page.mouse.move(place.x + radius * 0.7, place.y - radius * 0.7);
      if (['Z', 'E'].includes(await page.evaluate(() => globalThis.limberStudio.gizmoAxis()))) break;
    }
    await page.mouse.down();
    await page.mouse.move(place.x + radius, place.y, { steps: 4 });
    await page.waitForFunction(() => globalThis.limberStudio.idle());
    assert.equal((await sessionState(page)).dragged, joints[child].parent);
    const turned = distance(await jointPosition(page, joints[child].name), before);
    await page.mouse.up();
    await settled(page);
    assert.ok(turned > 1e-3, 'it did not turn before it was let go');
    assert.ok(distance(await jointPosition(page, joints[child].name), before) > 1e-3);
    await page.locator('#undo').click();
    await settled(page);
    assert.ok(distance(await jointPosition(page, joints[child].name), before) < 1e-6);
  },
  async 'PLY, STL, FBX and VRM open'() {
    const files = { 'tower.ply': asciiPly(), 'tower.stl': binaryStl(), 'tower.fbx': asciiFbx() };
    for (const [name, buffer] of Object.entries(files)) {
      await page.locator('#file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer });
      await page.waitForFunction((wanted) => globalThis.limberStudio.state().name === wanted || !document.querySelector('#notice').hidden, name);
      await settled(page);
      const { name: opened, triangles, vertices, box } = await sessionState(page);
      assert.equal(opened, name, await page.locator('#notice').textContent());
      assert.equal(triangles, triangleCount, name);
      assert.ok(vertices <= vertexCount, `${name}: ${vertices} vertices`);
      const tall = box.max[1] - box.min[1];
      assert.ok(Math.abs(tall / (box.max[0] - box.min[0]) - 1.6 / 0.5) < 1e-3, `${name}: ${JSON.stringify(box)}`);
    }
    const glb = await download(page, () => page.locator('#save-glb').click());
    await page.locator('#file').setInputFiles({ name: 'tower.vrm', mimeType: 'application/octet-stream', buffer: vrmOf(glb) });
    await page.waitForFunction(() => globalThis.limberStudio.state().name === 'tower.vrm');
    await settled(page);
    assert.equal((await sessionState(page)).own_rig, true);
  },
  async 'a PLY that is cut off is refused, as by the program'() {
    const whole = asciiPly(), before = (await sessionState(page)).name;
    const buffer = whole.subarray(0, whole.length / 2);
    await page.locator('#file').setInputFiles({ name: 'cut.ply', mimeType: 'application/octet-stream', buffer });
    await page.waitForFunction(() => !document.querySelector('#notice').hidden);
    assert.match(await page.locator('#notice').textContent(), /annot be read as PLY: it is cut off: it holds less than its header announces/);
    assert.equal((await sessionState(page)).name, before);
    await page.locator('#close-notice').click();
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
