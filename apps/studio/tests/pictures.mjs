// Draws the page's states for the documentation.
//
//   node apps/studio/tests/pictures.mjs DIST OUTPUT_FOLDER
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { walkBvh } from './walk_bvh.mjs';
import { answer, jointPlace, launch, openStudio, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch({ smooth: true });

/** Drags the joint nearest to a place in the picture, given as shares of the canvas. */
async function drag(page, from, way) {
  const names = (await sessionState(page)).joints.map((joint) => joint.name);
  const { width, height } = page.viewportSize();
  const places = await Promise.all(names.map((name) => jointPlace(page, name)));
  const far = ({ x, y }) => Math.hypot(x - from[0] * width, y - from[1] * height);
  const place = places.reduce((best, one) => (far(one) < far(best) ? one : best));
  await page.mouse.move(place.x, place.y);
  await page.mouse.down();
  for (let i = 1; i <= 4; ++i) await page.mouse.move(place.x + (way[0] * i) / 4, place.y + (way[1] * i) / 4);
  await page.mouse.up();
  await settled(page);
}

async function picture(name, options, steps) {
  const { page, context, errors } = await openStudio(browser, server.address, options);
  await steps(page);
  await page.screenshot({ path: join(output, `${name}.png`) });
  if (errors.length > 0) throw new Error(`${name}: ${errors.join('; ')}`);
  await context.close();
}

const desk = { width: 1200, height: 760 };
await picture('studio_handles', { ...desk, search: '?sample=winged' }, async () => {});
await picture('studio_posed', { ...desk, search: '?sample=biped' }, async (page) => {
  await page.locator('#ik').click();
  await settled(page);
  await drag(page, [0.6, 0.5], [30, -230]);
  await drag(page, [0.25, 0.5], [-20, -120]);
});
await picture('studio_weights', { ...desk, search: '?sample=quadruped' }, async (page) => {
  await page.getByRole('button', { name: 'Weights' }).click();
  await settled(page);
});
await picture('studio_motion', { ...desk, search: '?sample=biped' }, async (page) => {
  await page.locator('#motion-file').setInputFiles({ name: 'walk.bvh', mimeType: 'text/plain', buffer: Buffer.from(walkBvh()) });
  await page.waitForFunction(() => globalThis.limberStudio.state().clips.length > 0 || document.querySelector('#ask'));
  if (await page.locator('#ask').isVisible()) await answer(page, true);
  await page.locator('#play').click();
  await settled(page);
  await page.locator('#scrub').fill('0.2');
  await page.locator('#retarget summary').click();
  await settled(page);
  await page.waitForTimeout(300); // what was pressed has its colour again
});
await picture('studio_gizmo', { ...desk, search: '?sample=winged' }, async (page) => {
  await page.locator('#gizmo').check();
  await page.locator('#joints li').nth(5).click();
  await settled(page);
});
await picture('studio_compare', { ...desk, search: '?sample=biped' }, async (page) => {
  await page.locator('#methods summary').click();
  await page.locator('#compare-rigger').click();
  await page.waitForFunction(() => document.querySelectorAll('#comparison dl').length === 2);
  await settled(page);
});
await picture('studio_phone', { width: 390, height: 844, touch: true, search: '?sample=quadruped' }, async () => {});
await browser.close();
server.close();
