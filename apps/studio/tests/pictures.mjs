// Draws the page's states for the documentation.
//
//   node apps/studio/tests/pictures.mjs DIST OUTPUT_FOLDER [NAME]
//
// With a name only the pictures whose names begin so.
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { walkBvh } from './walk_bvh.mjs';
import { answer, jointPlace, launch, motionPlayed, openStudio, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2, 4).map((path) => resolve(path)), only = process.argv[4] ?? '';
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

/** Steps can take pictures on their way, by names of their own; the last is that of the picture. */
async function picture(name, options, steps) {
  if (!name.startsWith(only)) return;
  const { page, context, errors } = await openStudio(browser, server.address, options);
  await steps(page, async (step) => {
    await page.waitForTimeout(300); // what was pressed has its colour again
    await page.screenshot({ path: join(output, `${step}.png`) });
  });
  await page.screenshot({ path: join(output, `${name}.png`) });
  if (errors.length > 0) throw new Error(`${name}: ${errors.join('; ')}`);
  await context.close();
}

const desk = { width: 1200, height: 760 };
await picture('studio_handles', { ...desk, search: '?sample=winged' }, async () => {});
await picture('studio_posed', { ...desk, search: '?sample=biped' }, async (page) => {
  await drag(page, [0.6, 0.5], [30, -230]);
  await drag(page, [0.25, 0.5], [-20, -120]);
});
await picture('studio_weights', { ...desk, search: '?sample=quadruped' }, async (page) => {
  await page.getByRole('button', { name: 'Areas', exact: true }).click();
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
await picture('walk_cycle_ghosts', { ...desk, search: '?sample=biped' }, async (page, shoot) => {
  const press = async (selector) => {
    await page.locator(selector).click();
    await settled(page);
  };
  const at = async (seconds) => {
    await page.locator('#scrub').fill(String(seconds));
    await settled(page);
  };
  await motionPlayed(page, () => page.locator('#motion-file').setInputFiles({ name: 'walk.bvh', mimeType: 'text/plain', buffer: Buffer.from(walkBvh()) }));
  await at(0.4); // it played
  await press('#open-keys');
  const { match } = await sessionState(page), [hand] = match.find(({ part }) => part === 'leftHand').target;
  await page.getByRole('button', { name: 'Handles', exact: true }).click();
  await settled(page);
  const place = await jointPlace(page, hand);
  await page.mouse.move(place.x, place.y);
  await page.mouse.down();
  for (let i = 1; i <= 4; ++i) await page.mouse.move(place.x + 12 * i, place.y - 22 * i);
  await page.mouse.up();
  await settled(page);
  await page.mouse.move(600, 700);
  await shoot('walk_cycle_layer');
  await at(0.6);
  await press('#add-key');
  await press('#choose-keys');
  await press('#scale-up');
  await shoot('walk_cycle_keys');
  await page.locator('.lane .label').nth(1).click();
  await page.getByRole('button', { name: 'Curves', exact: true }).click();
  await page.locator('#curves circle').first().waitFor();
  await settled(page);
  await shoot('walk_cycle_curves');
  await page.getByRole('button', { name: 'Sheet', exact: true }).click();
  await page.getByRole('button', { name: 'Surface', exact: true }).click();
  const { joints } = await sessionState(page);
  await press(`#joint-${joints.findIndex(({ name }) => name === hand)}`);
  await at(0.6);
  await press('#ghosts');
  await page.waitForTimeout(300);
});
await picture('studio_shelf', { ...desk, search: '?sample=biped' }, async (page) => {
  await page.locator('#open-shelf').click();
  await page.waitForFunction(() => document.querySelectorAll('#shelf [aria-busy]').length === 0);
  await page.locator('#shelf [data-motion=sneak]').hover();
  await page.waitForTimeout(600);
});
await picture('studio_poses', { ...desk, search: '?sample=biped' }, async (page) => {
  await page.locator('#open-poses').click();
  await page.waitForFunction(() => document.querySelectorAll('#pose-samples .motion-card:not([aria-busy])').length >= 12);
  await page.waitForTimeout(300);
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
await picture('studio_scene', { ...desk, search: '?sample=biped' }, async (page) => {
  const state = () => sessionState(page);
  const add = async (sample, prop) => {
    const count = (await state()).members.length + 1;
    await page.locator('#open-add').click();
    await page.locator('#as-prop').setChecked(prop);
    await page.locator(`#add-member [data-sample=${sample}]`).click();
    await page.waitForFunction((wanted) => globalThis.limberStudio.state().members.length === wanted, count);
    await settled(page);
  };
  const choose = async (member) => {
    await page.locator(`#members [data-member="${member}"] button`).first().click();
    await settled(page);
  };
  await add('stool', true);
  await add('biped', false);
  const pull = async (member, part, way) => {
    await choose(member);
    const { x, y } = await jointPlace(page, (await state()).joints.find((joint) => joint.part === part).name);
    await drag(page, [x / desk.width, y / desk.height], way);
  };
  await choose(1);
  await page.locator('#attach-member').click();
  await page.locator('#holder').selectOption({ index: 0 });
  await page.locator('#hold-yes').click();
  await settled(page);
  await pull(0, 'left hand', [20, -60]);
  await pull(2, 'right hand', [-20, -120]);
});
await picture('studio_phone', { width: 390, height: 844, touch: true, search: '?sample=quadruped' }, async () => {});
await browser.close();
server.close();
