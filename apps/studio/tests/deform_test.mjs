// The deformer that is chosen: what is drawn, exported and compared is the surface that the engine bends.
//
//   node apps/studio/tests/deform_test.mjs DIST NATIVE_PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { download, jointPlace, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';
import { readUsd } from './usd_points.mjs';

const [dist, program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 1100, height: 760, deviceScaleFactor: 1, search: '?sample=biped' });

const deformers = ['linear-blend', 'dual-quaternion', 'centers-of-rotation', 'delta-mush', 'direct-delta-mush'];

/** A person with limbs bent and twisted, and an arm that is scaled. */
function bentPerson() {
  const at = (name) => join(output, name), run = (...args) => execFileSync(program, [...args, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  run('sample', 'biped', '-o', at('deform_biped.glb'));
  run('rig', at('deform_biped.glb'), '--rigger', 'template', '-o', at('deform_rigged.glb'));
  run('pose', at('deform_rigged.glb'), '--turn', 'leftLowerLeg=x:110', '--turn', 'rightUpperLeg=x:-95', '--turn', 'rightLowerArm=x:150',
    '--turn', 'leftUpperArm=z:50', '--turn', 'spine=y:60', '-o', at('deform_bent.glb'));
  const glb = readFileSync(at('deform_bent.glb')), length = glb.readUInt32LE(12), text = glb.subarray(20, 20 + length).toString();
  const json = JSON.parse(text);
  json.nodes.find(({ name }) => name === 'leftLowerArm').scale = [1.6, 0.8, 1.1];
  let changed = JSON.stringify(json);
  changed += ' '.repeat((4 - (Buffer.byteLength(changed) % 4)) % 4);
  const chunk = Buffer.from(changed), made = Buffer.concat([glb.subarray(0, 20), chunk, glb.subarray(20 + length)]);
  made.writeUInt32LE(chunk.length, 12);
  made.writeUInt32LE(made.length, 8);
  return made;
}

async function choose(name) {
  await page.locator('#deformer').selectOption(name);
  await settled(page);
}

/** The surface by the engine: vertices, and triangles of them. */
async function engineSurface() {
  const text = (await download(page, () => page.locator('#export-as').selectOption('obj'))).toString();
  return {
    vertices: [...text.matchAll(/^v (\S+) (\S+) (\S+)$/gm)].map(([, ...xyz]) => xyz.map(Number)),
    triangles: [...text.matchAll(/^f (\d+)\S* (\d+)\S* (\d+)\S*$/gm)].map(([, ...corners]) => corners.map((corner) => Number(corner) - 1)),
  };
}

/** The page's picture, with the model and without. */
async function pictures() {
  const shot = async () => (await page.locator('main canvas').screenshot()).toString('base64'), eyes = page.locator('#meshes button');
  const turnAll = async () => {
    for (let i = 0; i < await eyes.count(); ++i) await eyes.nth(i).dispatchEvent('click');
    await settled(page);
  };
  const shown = await shot();
  await turnAll();
  const without = await shot();
  await turnAll();
  assert.notEqual(shown, without, 'there is no model in the picture');
  return [shown, without];
}

/** How many pixels of the model lie further than one pixel from where the surface covers the picture, or the other way round, of
 *  all that it covers. */
async function misdrawn([shown, without], surface) {
  return page.evaluate(async ({ shown, without, surface }) => {
    const { left, top, width, height } = document.querySelector('main canvas').getBoundingClientRect();
    const pixels = async (png) => {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
      const context = new OffscreenCanvas(width, height).getContext('2d');
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, width, height).data;
    };
    const a = await pixels(shown), b = await pixels(without), count = width * height;
    const drawn = Array.from({ length: count }, (_, i) => [0, 1, 2].reduce((sum, c) => sum + Math.abs(a[4 * i + c] - b[4 * i + c]), 0) > 12);
    const context = new OffscreenCanvas(width, height).getContext('2d');
    const places = surface.vertices.map((vertex) => globalThis.limberStudio.placeOf(vertex));
    for (const corners of surface.triangles) {
      context.beginPath();
      for (const corner of corners) context.lineTo(places[corner].x - left, places[corner].y - top);
      context.closePath();
      context.fill();
      context.stroke();
    }
    const { data } = context.getImageData(0, 0, width, height), covered = drawn.map((_, i) => data[4 * i + 3] > 127);
    const near = (mask, i, value) => {
      for (const down of [-1, 0, 1]) for (const along of [-1, 0, 1]) if (mask[i + down * width + along] === value) return true;
      return false;
    };
    let wrong = 0, all = 0;
    for (let i = 0; i < count; ++i) {
      all += covered[i];
      wrong += drawn[i] !== covered[i] && !near(covered, i, drawn[i]) ? 1 : 0;
      wrong += drawn[i] !== covered[i] && !near(drawn, i, covered[i]) ? 1 : 0;
    }
    return { share: wrong / all, all };
  }, { shown, without, surface });
}

/** The farthest that a vertex of the USDZ is from every one of the engine's, metres. */
async function usdzApart({ vertices }) {
  const { points } = readUsd(await download(page, () => page.locator('#export-as').selectOption('usdz')));
  assert.ok(points.length >= 0.9 * vertices.length, `${points.length} points`);
  const different = [...new Map(points.map((point) => [point.join(), point])).values()]; // three.js gives each triangle its own
  return Math.max(...different.map((p) => Math.min(...vertices.map((v) => Math.hypot(p[0] - v[0], p[1] - v[1], p[2] - v[2])))));
}

/** Distortion above 1 of each triangle (limber/evaluate/skin/surface_stretch.h), at most 1. */
function stretches(rest, posed) {
  const edges = ({ vertices }, [a, b, c]) => [b, c].map((corner) => vertices[corner].map((value, axis) => value - vertices[a][axis]));
  const dot = (u, v) => u.reduce((sum, value, axis) => sum + value * v[axis], 0);
  return posed.triangles.map((corners) => {
    // In the frame of the triangle at rest: columns of the map are what becomes of its first edge's direction and of the one across.
    const [u, v] = edges(rest, corners), [p, q] = edges(posed, corners), length = Math.hypot(...u), along = dot(u, v) / length;
    const across = Math.sqrt(Math.max(0, dot(v, v) - along * along));
    const first = p.map((value) => value / length), second = q.map((value, axis) => (value - along * first[axis]) / across);
    const sum = dot(first, first) + dot(second, second), turned = Math.hypot(dot(first, first) - dot(second, second), 2 * dot(first, second));
    return Math.min(1, Math.max(Math.sqrt((sum + turned) / 2), 1 / Math.sqrt(Math.max(1e-12, (sum - turned) / 2))) - 1);
  });
}

/** Where one triangle alone faces the camera: the heat that is drawn there, and the one that it should have. */
async function drawnHeat(surface, heats) {
  const shot = (await page.locator('main canvas').screenshot()).toString('base64');
  return page.evaluate(async ({ shot, surface, heats }) => {
    const { left, top, width, height } = document.querySelector('main canvas').getBoundingClientRect();
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${shot}`)).blob());
    const context = new OffscreenCanvas(width, height).getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    const places = surface.vertices.map((vertex) => globalThis.limberStudio.placeOf(vertex)).map(({ x, y }) => [x - left, y - top]);
    const layers = new Uint8Array(width * height), own = new Int32Array(width * height).fill(-1);
    const cross = (a, b, x, y) => (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    surface.triangles.forEach((corners, f) => {
      const [a, b, c] = corners.map((corner) => places[corner]);
      if (cross(a, b, ...c) >= 0) return; // seen from behind
      const span = (axis, end) => [Math.floor(Math.min(a[axis], b[axis], c[axis])), Math.min(end - 1, Math.ceil(Math.max(a[axis], b[axis], c[axis])))];
      const [x0, x1] = span(0, width), [y0, y1] = span(1, height);
      for (let y = Math.max(0, y0); y <= y1; ++y) for (let x = Math.max(0, x0); x <= x1; ++x) {
        const inside = [[a, b], [b, c], [c, a]].map(([from, to]) => cross(from, to, x + 0.5, y + 0.5) / Math.hypot(to[0] - from[0], to[1] - from[1]));
        if (inside.some((distance) => distance > 1)) continue; // farther than a pixel outside
        layers[y * width + x] += 1;
        if (inside.every((distance) => distance < -1)) own[y * width + x] = f;
      }
    });
    // Hues go from blue, 0, to red, 1; light and shade leave them as they are.
    const heatOf = (bytes) => {
      const [r, g, b] = bytes.map((byte) => (byte / 255) ** 2.2), most = Math.max(r, g, b), range = most - Math.min(r, g, b);
      const sixth = most === r ? ((g - b) / range + 6) % 6 : most === g ? (b - r) / range + 2 : (r - g) / range + 4;
      return 1 - sixth / 6 / 0.62;
    };
    const pairs = [];
    for (let i = 0; i < own.length; ++i) {
      if (own[i] < 0 || layers[i] !== 1) continue;
      pairs.push([heatOf(Array.from(data.subarray(4 * i, 4 * i + 3))), heats[own[i]]]);
    }
    return pairs;
  }, { shot, surface, heats });
}

async function open(name, buffer) {
  await page.locator('#file').setInputFiles({ name, mimeType: 'model/gltf-binary', buffer });
  await page.waitForFunction((opened) => globalThis.limberStudio.state().name === opened, name);
  await settled(page);
}

const surfaces = {};
let atRest = null;
const cases = {
  async 'a deformer is chosen among the methods, and taken back'() {
    const bent = bentPerson();
    await open('rigged.glb', readFileSync(join(output, 'deform_rigged.glb')));
    atRest = await engineSurface();
    await open('bent.glb', bent);
    await page.locator('#methods summary').click();
    assert.equal(await page.locator('#deformer').inputValue(), 'linear-blend');
    assert.deepEqual(await page.$$eval('#deformer option', (options) => options.map(({ value }) => value)), deformers);
    await choose('direct-delta-mush');
    assert.equal((await sessionState(page)).deformer, 'direct-delta-mush');
    assert.equal((await sessionState(page)).undo, 'set_deformer');
    await page.locator('#undo').click();
    await settled(page);
    assert.equal((await sessionState(page)).deformer, 'linear-blend');
    assert.equal(await page.locator('#deformer').inputValue(), 'linear-blend');
  },
  async 'what is drawn is the surface that the engine bends'() {
    await page.locator('.pose [data-value=surface]').click();
    const figures = {};
    for (const name of deformers) {
      await choose(name);
      surfaces[name] = await engineSurface();
      const both = await pictures();
      const own = await misdrawn(both, surfaces[name]), linear = await misdrawn(both, surfaces['linear-blend']);
      figures[name] = [own.share, linear.share];
      await page.screenshot({ path: join(output, `deform_${name}.png`) });
      assert.ok(own.all > 20000, `the model covers ${own.all} pixels`);
      assert.ok(own.share < 0.002, `${name}: ${own.share}`);
      if (name !== 'linear-blend') assert.ok(linear.share > 5 * own.share + 0.002, `${name} is drawn as linear blend: ${JSON.stringify(figures[name])}`);
    }
    console.log(`misdrawn, by the engine's surface and by linear blend: ${JSON.stringify(figures)}`);
  },
  async 'stretch is drawn as the engine has it'() {
    await page.locator('.pose [data-value=stretch]').click();
    await page.locator('#bones').uncheck();
    const shares = [];
    for (const name of deformers) {
      await choose(name);
      const pairs = await drawnHeat(surfaces[name], stretches(atRest, surfaces[name]));
      await page.screenshot({ path: join(output, `deform_stretch_${name}.png`) });
      const alike = pairs.filter(([drawn, wanted]) => Math.abs(drawn - wanted) < 0.05).length / pairs.length;
      assert.ok(pairs.length > 1000 && pairs.some(([, wanted]) => wanted > 0.3), `${pairs.length} pixels`);
      assert.ok(alike > 0.95, `${name}: ${alike}`); // the others lie below a handle
      shares.push(alike);
    }
    await page.locator('#bones').check();
    console.log(`drawn as the engine has it: ${shares}`);
  },
  async 'a USDZ holds the surface as it is bent'() {
    for (const name of ['linear-blend', 'delta-mush', 'centers-of-rotation', 'direct-delta-mush']) {
      await choose(name);
      const apart = await usdzApart(surfaces[name]);
      assert.ok(apart < 5e-5, `${name}: ${apart} m`);
    }
  },
  async 'painted weights bend the surface anew'() {
    await choose('direct-delta-mush');
    await page.locator('#joints li').last().click();
    await page.locator('#paint').click();
    await page.locator('#brush-strength').fill('100');
    await settled(page);
    const place = await jointPlace(page, 'spine');
    await page.mouse.move(place.x - 8, place.y);
    await page.mouse.down();
    await page.mouse.move(place.x + 8, place.y + 10, { steps: 6 });
    await page.mouse.up();
    await page.waitForFunction(() => globalThis.limberStudio.state().undo === 'paint_weights');
    await settled(page);
    await page.locator('#paint').click();
    await settled(page);
    const painted = await engineSurface();
    assert.notDeepEqual(painted.vertices, surfaces['direct-delta-mush'].vertices);
    assert.ok(await usdzApart(painted) < 5e-5);
    await page.locator('.pose [data-value=surface]').click();
    assert.ok((await misdrawn(await pictures(), painted)).share < 0.002);
    await page.locator('#undo').click();
    await settled(page);
    assert.ok(await usdzApart(surfaces['direct-delta-mush']) < 5e-5);
  },
  async 'deformers are compared by what they do to the volume'() {
    const before = await sessionState(page);
    await page.locator('#compare-deformer').click();
    await page.waitForFunction(() => document.querySelectorAll('#comparison dl').length === 2);
    await page.getByLabel('The method beside it').selectOption('delta-mush');
    await settled(page);
    await page.waitForFunction(() => document.querySelectorAll('#comparison dl').length === 2 && globalThis.limberStudio.idle());
    const volumes = await page.$$eval('#comparison dl', (lists) => lists.map((list) =>
      [...list.querySelectorAll('dt')].find((name) => name.textContent === 'Volume').nextElementSibling.textContent));
    assert.notEqual(volumes[0], volumes[1]);
    await page.screenshot({ path: join(output, 'deform_compared.png') });
    assert.equal((await sessionState(page)).deformer, before.deformer);
    await page.locator('#end-comparison').click();
    await settled(page);
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
