// Clips that follow each other as one: joined, overlapping more and less, taken out, in rows below the timeline.
//
//   node apps/studio/tests/sequence_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { barriers, chooseMotion, launch, motionPlayed, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const { page, errors } = await openStudio(browser, server.address, { width: 1100, height: 700, search: '?sample=biped' });
const all = [errors];

const clipOf = async (of = page) => {
  const { clips, clip } = await sessionState(of);
  return clips[clip];
};
const bar = (place, of = page) => of.locator(`#sequence .lane[data-place="${place}"] .stand`);
async function then(name, of = page) {
  await of.locator('#then').selectOption(name);
  await settled(of);
}
async function opened(of) {
  await motionPlayed(of, () => chooseMotion(of, 'walk'));
  await of.locator('#play').click();
  await settled(of);
  await of.locator('#open-sequence').click();
  await of.locator('#sequence').waitFor();
}

const cases = {
  async 'a clip is a row, and another one follows it, overlapping'() {
    await opened(page);
    assert.equal(await page.locator('#sequence .lane[data-place]').count(), 1);
    const { duration } = await clipOf();
    await then('walk');
    const clip = await clipOf();
    assert.equal(clip.name, 'walk_walk');
    assert.ok(clip.duration > duration && clip.duration < 2 * duration, `${clip.duration} s of twice ${duration}`);
    assert.equal(await page.locator('#clips').inputValue(), 'walk_walk');
    const [first, second] = [await bar(0).boundingBox(), await bar(1).boundingBox()];
    assert.ok(second.x < first.x + first.width && second.x > first.x, 'the bars do not overlap');
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'sequence.png') });
  },
  async 'dragged to the left it overlaps longer, by keyboard less, and that is undone'() {
    const { clips } = await sessionState(page), before = await clipOf(), box = await bar(1).boundingBox();
    const x = box.x + box.width / 2, y = box.y + box.height / 2, row = await page.locator('#sequence .beat').first().boundingBox();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x - (0.3 / before.duration) * row.width, y, { steps: 3 });
    await page.mouse.up();
    await settled(page);
    const after = await clipOf();
    assert.equal(after.name, 'walk_walk');
    assert.equal((await sessionState(page)).clips.length, clips.length);
    assert.ok(Math.abs(after.sequence.seconds - 0.6) < 0.05, `${after.sequence.seconds} s`);
    const [one, two] = after.sequence.clips;
    assert.ok(Math.abs(one.to - two.from - after.sequence.seconds) < 0.05);
    await bar(1).focus();
    await page.keyboard.press('ArrowRight');
    await settled(page);
    assert.ok(Math.abs((await clipOf()).sequence.seconds - (after.sequence.seconds - 0.1)) < 1e-9);
    for (let i = 0; i < 2; ++i) await page.locator('#undo').click();
    await settled(page);
    assert.equal((await clipOf()).sequence.seconds, before.sequence.seconds);
  },
  async 'a third one follows, and one of three is taken out'() {
    const { duration } = await clipOf();
    await then('walk');
    assert.equal(await page.locator('#sequence .lane[data-place]').count(), 3);
    assert.ok((await clipOf()).duration > duration);
    await page.getByRole('button', { name: 'walk no longer follows' }).nth(1).click();
    await settled(page);
    assert.equal((await clipOf()).sequence.clips.length, 2);
    assert.ok(await page.getByRole('button', { name: 'walk no longer follows' }).first().isHidden());
  },
  async 'by touch on a small screen, in the dark'() {
    const hand = await openStudio(browser, server.address, { width: 390, height: 844, touch: true, isMobile: true, colorScheme: 'dark', search: '?sample=biped' });
    all.push(hand.errors);
    await opened(hand.page);
    await then('walk', hand.page);
    assert.equal((await clipOf(hand.page)).sequence.clips.length, 2);
    assert.deepEqual(await barriers(hand.page), []);
    await hand.page.screenshot({ path: join(output, 'sequence_narrow.png') });
    await hand.context.close();
  },
  async 'nothing was thrown'() { assert.deepEqual(all.flat(), []); },
};

const failed = await runCases(cases, page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
