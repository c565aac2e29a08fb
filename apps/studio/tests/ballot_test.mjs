// The blind ballot on a study's page, opened from disk: what is seen, pressed, kept and saved.
//
//   node apps/studio/tests/ballot_test.mjs PROGRAM OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { barriers, download, launch, runCases } from './page.mjs';

const [program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), 'limber_ballot_')), browser = await launch();
const riggers = ['sphere-mesh', 'curve-skeleton', 'prop'], methods = riggers.map((rigger) => `${rigger} + bone-heat`);
writeFileSync(join(folder, 'plan.json'), JSON.stringify({ limber_study: 1, title: 'Stools', rig: { models: ['sample:stool'], riggers: [...riggers] } }));
const study = (...more) => execFileSync(program, ['study', 'plan.json', '-o', 'report', '--quiet', ...more], { cwd: folder });
study();

let page, errors = [];
async function open({ width = 1280, height = 900, prepare = async () => {}, ...more } = {}) {
  await page?.context().close();
  const context = await browser.newContext({ viewport: { width, height }, acceptDownloads: true, ...more });
  await prepare(context);
  page = await context.newPage();
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  await page.goto(pathToFileURL(join(folder, 'report/index.html')).href);
  await page.locator('a[href="#ballot"]').click();
}
const tally = () => page.locator('#tally').textContent();
const choose = (name) => page.locator(`[data-choice=${name}]`).click();
const saved = async () => (await download(page, () => page.locator('#save-votes').click())).toString();
const votesOf = (csv) => csv.trim().split('\r\n').slice(1).map((line) => line.split(','));
/** The pictures of a side, and the method whose they are. */
const shown = (side) => page.evaluate((id) => {
  const sources = [...document.querySelectorAll(`#${id} img`)].map(({ src }) => src);
  const figure = [...document.querySelectorAll('figure[data-method]')].find((one) => one.querySelector('img').src === sources[0]);
  return { method: figure?.dataset.method, count: sources.length, text: document.querySelector('#ballot').outerHTML };
}, side);

const cases = {
  async 'two results stand side by side, and nothing tells whose they are'() {
    await open();
    const left = await shown('left'), right = await shown('right');
    assert.ok(methods.includes(left.method) && methods.includes(right.method));
    assert.notEqual(left.method, right.method);
    assert.deepEqual([left.count, right.count], [2, 2]);
    for (const rigger of riggers) assert.ok(!left.text.replaceAll(/src="[^"]*"/g, '').includes(rigger), rigger);
    assert.equal(await tally(), '0 of 3 judged.');
    assert.deepEqual(await barriers(page), []);
    await page.locator('#ballot').screenshot({ path: join(output, 'ballot_desk.png') });
  },
  async 'votes are those for what was shown, by button and by key'() {
    await page.locator('#voter').fill('Anna, "A"');
    await page.locator('#voter').press('Tab');
    const seen = [];
    const look = async (choice) => seen.push([(await shown('left')).method, (await shown('right')).method, choice]);
    await look('second');
    await choose('second');
    await page.locator('#pair').focus();
    await look('alike');
    await page.keyboard.press(' ');
    await look('first');
    await page.keyboard.press('ArrowLeft');
    assert.equal(await tally(), '3 of 3 judged.');
    assert.equal(await page.locator('[data-choice=alike]').isDisabled(), true);
    const csv = await saved();
    assert.ok(csv.startsWith('voter,kind,subject,first,second,choice\r\n"Anna, ""A""",rig,stool,'));
    assert.deepEqual(votesOf(csv).map((fields) => fields.slice(-3)), seen);
    writeFileSync(join(folder, 'votes.csv'), csv);
    const { rankings: [ranking] } = JSON.parse(execFileSync(program, ['evaluate', 'votes', 'votes.csv', '--json'], { cwd: folder }));
    assert.deepEqual([ranking.votes, ranking.voters, ranking.methods.length], [3, 1, 3]);
  },
  async 'undo takes the last vote back, and the pair stands there again as it was'() {
    const before = await saved();
    await page.locator('#pair').focus();
    await page.keyboard.press('Backspace');
    assert.equal(await tally(), '2 of 3 judged.');
    await page.keyboard.press('ArrowLeft');
    assert.equal(await saved(), before);
  },
  async 'votes and name are there after the page was closed; another voter begins anew, in another order'() {
    await page.reload();
    assert.equal(await tally(), '3 of 3 judged.');
    const orders = new Set();
    for (const voter of ['b', 'c', 'd', 'e', 'f', 'g']) {
      await page.locator('#voter').fill(voter);
      await page.locator('#voter').press('Tab');
      assert.equal(await tally(), '0 of 3 judged.');
      orders.add(`${(await shown('left')).method} ${(await shown('right')).method}`);
    }
    assert.ok(orders.size > 1);
  },
  async 'the methods are told where that is asked for, and such a vote stays'() {
    await page.locator('#names').check();
    const left = (await shown('left')).method;
    await choose('first');
    assert.ok((await tally()).startsWith(`Left was ${left}, right was `));
    assert.equal(await page.locator('#undo').isDisabled(), true);
    assert.equal(votesOf(await saved()).length, 4);
  },
  async 'a browser that keeps nothing says so, and the ballot works'() {
    await open({ prepare: (context) => context.addInitScript(() => { Object.defineProperty(globalThis, 'localStorage', { get() { throw new DOMException('denied', 'SecurityError'); } }); }) });
    assert.equal(await page.locator('#unkept').isVisible(), true);
    await choose('first');
    assert.equal(votesOf(await saved()).length, 1);
  },
  async 'what was kept by others is not trusted'() {
    await open();
    await page.evaluate(() => localStorage.setItem(`limber ballot ${document.querySelector('#ballot').dataset.study}`,
      JSON.stringify({ voter: 'x', votes: [null, { voter: 'x', kind: 'rig', subject: 'stool', first: 'a', second: 'b', choice: 'first' }] })));
    await page.reload();
    assert.equal(await tally(), '0 of 3 judged.');
  },
  async 'on a phone the pair and its buttons fit'() {
    await open({ width: 390, height: 844, hasTouch: true, isMobile: true, colorScheme: 'dark' });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390);
    const { top } = await page.locator('#pair').evaluate((one) => one.getBoundingClientRect().toJSON());
    const { bottom } = await page.locator('.choices').evaluate((one) => one.getBoundingClientRect().toJSON());
    assert.ok(bottom - top < 844, `${bottom - top} pixels`);
    await page.locator('[data-choice=second]').tap();
    assert.equal(await tally(), '1 of 3 judged.');
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'ballot_phone.png') });
  },
  async 'the ranking by eye stands beside the measured ones'() {
    study('--votes', 'votes.csv');
    assert.match(readFileSync(join(folder, 'report/index.html'), 'utf8'), /Ranking by eye/);
    await open();
    assert.deepEqual(await barriers(page), []);
    await page.screenshot({ path: join(output, 'ballot_ranking.png') });
  },
  async 'nothing was thrown'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
rmSync(folder, { recursive: true });
process.exit(failed > 0 ? 1 : 0);
