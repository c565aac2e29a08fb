// While which foot stands in a motion: shown in rows below the timeline, let go, held, and kept.
//
//   node apps/studio/tests/feet_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, chooseMotion, jointPosition, lastJointOf, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 1100, height: 700, search: '?sample=biped' });
const all = [errors];

const clipOf = async (of) => {
  const { clips, clip } = await sessionState(of);
  return clips[clip];
};
const footOf = async (of, part = 'leftFoot') => (await clipOf(of)).feet.find((foot) => foot.part === part);
const standsAt = ({ planted }, seconds) => planted.some(([from, to]) => from <= seconds && seconds <= to);
const row = (of, part = 'leftFoot') => of.locator(`#feet .lane[data-part="${part}"]`);
const scrub = async (of, seconds) => {
  await of.locator('#scrub').fill(String(seconds));
  await settled(of);
};
/** Metres along the ground that the foot goes between two moments. */
async function slide(of, from, to) {
  const foot = await lastJointOf(of, 'left foot'), places = [];
  for (const seconds of [from, to]) {
    await scrub(of, seconds);
    places.push(await jointPosition(of, foot));
  }
  return Math.hypot(places[1][0] - places[0][0], places[1][2] - places[0][2]);
}
async function walking(of) {
  await motionPlayed(of, () => chooseMotion(of, 'walk'));
  await of.locator('#play').click();
  await settled(of);
  await of.locator('#open-feet').click();
  await of.locator('#feet').waitFor();
}

let span = [0, 0];

const cases = {
  async 'rows of a motion\'s feet, and none for a clip of one\'s own'() {
    assert.ok(await page.locator('#open-feet').isHidden());
    await walking(page);
    assert.equal(await page.locator('#feet .lane').count(), 2);
    const foot = await footOf(page);
    span = foot.planted.find(([from, to]) => to - from > 0.3);
    assert.ok(span, JSON.stringify(foot.planted));
    assert.equal(await row(page).locator('.stand').count(), foot.planted.length);
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'feet.png') });
  },
  async 'pressed, a foot that stands goes free'() {
    const [from, to] = span, middle = (from + to) / 2, held = await slide(page, middle, to);
    const { planted } = await footOf(page);
    await row(page).locator('.stand').nth(planted.indexOf(planted.find(([begin]) => begin === from))).click();
    await settled(page);
    assert.ok(!standsAt(await footOf(page), middle));
    const free = await slide(page, middle, to);
    assert.ok(free > held + 0.005, `${held} m while it stood, ${free} m after`);
  },
  async 'it is kept over another method and a reload, and undone'() {
    await page.locator('#method').selectOption('spacetime');
    await settled(page);
    assert.ok(!standsAt(await footOf(page), (span[0] + span[1]) / 2));
    await page.waitForFunction(() => globalThis.limberStudio.kept());
    await page.reload();
    await settled(page);
    assert.ok((await footOf(page)).edited);
    await page.locator('#undo').click();
    await settled(page);
    await page.locator('#open-feet').click();
    await page.locator('#feet').waitFor();
    await page.getByRole('button', { name: 'left foot: as it was found' }).click();
    await settled(page);
    const foot = await footOf(page);
    assert.ok(standsAt(foot, (span[0] + span[1]) / 2) && !foot.edited);
  },
  async 'dragged along its row it is held, and by keyboard at the playhead'() {
    const { planted } = await footOf(page), { duration } = await clipOf(page), swing = planted.find(([, to]) => to + 0.3 < duration)[1] + 0.1;
    const beat = await row(page).locator('.beat').boundingBox(), x = (seconds) => beat.x + (seconds / duration) * beat.width;
    const swung = await slide(page, swing, swing + 0.1);
    await page.mouse.move(x(swing - 0.05), beat.y + beat.height / 2);
    await page.mouse.down();
    await page.mouse.move(x(swing + 0.15), beat.y + beat.height / 2, { steps: 4 });
    await page.mouse.up();
    await settled(page);
    assert.ok(standsAt(await footOf(page), swing + 0.05));
    const held = await slide(page, swing, swing + 0.1);
    assert.ok(held < 0.5 * swung, `${swung} m while it swung, ${held} m held`);
    await scrub(page, swing + 0.05);
    await row(page).locator('.label .button').first().focus();
    await page.keyboard.press('Enter');
    await settled(page);
    assert.ok(!standsAt(await footOf(page), swing + 0.05));
    await page.keyboard.press('Enter');
    await settled(page);
    assert.ok(standsAt(await footOf(page), swing + 0.05));
  },
  async 'by touch on a small screen, in the dark'() {
    const hand = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, isMobile: true, colorScheme: 'dark', search: '?sample=biped' });
    all.push(hand.errors);
    await walking(hand.page);
    const { planted } = await footOf(hand.page);
    await row(hand.page).locator('.stand').first().tap();
    await settled(hand.page);
    assert.equal((await footOf(hand.page)).planted.length, planted.length - 1);
    assert.deepEqual(await barriers(hand.page), []);
    await hand.page.screenshot({ path: join(output, 'feet_narrow.png') });
    await hand.context.close();
  },
  async 'nothing was thrown'() { assert.deepEqual(all.flat(), []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
