// The words of the page: every text in English and in German, larger text, and what fingers do instead of keys.
//
//   node apps/studio/tests/words_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, readdirSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import ts from 'typescript';
import { jointPlace, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
const sources = join(dirname(fileURLToPath(import.meta.url)), '../src'), repository = join(sources, '../../..');
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const errors = [];
let page;

const filesIn = (folder, ending) => readdirSync(folder, { recursive: true }).map((name) => join(folder, name))
  .filter((path) => path.endsWith(ending) && statSync(path).isFile());
const { outputText } = ts.transpileModule(readFileSync(join(sources, 'words/german.ts'), 'utf8'), { compilerOptions: { module: ts.ModuleKind.ESNext } });
const { german } = await import(`data:text/javascript,${encodeURIComponent(outputText)}`);

async function open(options) {
  const opened = await openStudio(browser, server.address, { search: '?sample=biped', ...options });
  opened.page.on('close', () => errors.push(...opened.errors));
  page = opened.page;
  page.setDefaultTimeout(20_000);
  return opened;
}

/** What a person can see or hear of the page, hidden parts too. */
const texts = (of) => of.evaluate(() => {
  const found = new Set();
  const add = (text) => { if (/\p{L}{2}/u.test(text ?? '')) found.add(text.trim()); };
  const walker = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    if (node.nodeType === Node.TEXT_NODE) {
      if (!node.parentElement.closest('script, style, [lang=en] :not(html), .detail[lang=en]')) add(node.data);
      continue;
    }
    for (const name of ['title', 'aria-label', 'placeholder', 'alt', 'aria-valuetext', 'content']) if (!node.matches('meta:not([name=description])')) add(node.getAttribute(name));
    for (const pseudo of ['::before', '::after']) {
      const { content } = getComputedStyle(node, pseudo);
      if (content.startsWith('"')) add(content.replaceAll('"', ''));
    }
  }
  return [...found];
});

/** Goes everywhere, and gives each text with where it was met first. */
async function walk(locale) {
  const { page: at, context } = await open({ locale });
  const met = new Map(), names = new Set();
  const note = async (where, asked = false) => {
    if (!asked) await settled(at);
    for (const text of await texts(at)) if (!met.has(text)) met.set(text, where);
    const { name, joints, clips, motions } = await sessionState(at);
    [name, ...[...joints, ...clips, ...motions].map((one) => one.name), ...motions.flatMap((one) => one.joints.map((joint) => joint.name))].forEach((one) => names.add(one));
  };
  const click = async (selector) => {
    await at.locator(selector).first().click();
    await settled(at);
  };
  const close = (dialog) => at.locator(`#${dialog} button`).last().click();
  const bring = async (name, bytes) => {
    await at.locator('#file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });
    await at.locator('#notice').waitFor();
    await note(`error of ${name}`);
    await click('#close-notice');
  };
  await note('start');
  await click('#help-button');
  await note('help');
  await close('help');
  await click('#open-recent');
  await note('recent');
  await click('#close-recent');
  await click('#joints li:nth-child(9)');
  await click('#pin');
  await click('#lock-joint');
  await note('pinned joint');
  await click('#add-joint');
  await note('placing a joint');
  await click('#add-joint');
  await click('#hang-joint');
  await note('hanging a joint elsewhere');
  await click('#choose-no');
  await click('#rename-joint');
  await note('renaming');
  await at.locator('#rename').press('Escape');
  await click('#gizmo');
  await click('#exact summary');
  await click('#select-several');
  await note('exact values');
  await click('#select-several');
  await click('#limits');
  await click('#paint');
  await note('painting');
  await click('#paint');
  await click('#methods summary');
  await click('#compare-solver');
  await note('comparison');
  await click('#end-comparison');
  await click('#add-clip');
  await click('#add-key');
  await click('#open-keys');
  await note('sheet of keys');
  await click('#choose-keys');
  await note('chosen keys');
  await click('.key-editor [data-value=curves]');
  await note('curves');
  await at.locator('#scrub').fill('1');
  await settled(at);
  await click('#mirror');
  await note('curves of two keys');
  await click('#open-keys');
  await click('#open-sheet');
  await note('contact sheet');
  await close('contact-sheet');
  await click('#open-shelf');
  await at.locator('#shelf-samples [data-motion=gallop]:not([aria-busy])').waitFor();
  await at.locator('[data-motion=gallop]').hover();
  await note('shelf');
  await click('#shelf-samples [data-motion=walk]');
  await click('#play[aria-pressed=true]');
  await note('motion');
  await at.locator('#samples').selectOption('robot');
  await at.waitForFunction(() => globalThis.limberStudio.state().name === 'robot');
  await at.locator('#handles').evaluate((slider) => { slider.value = '250'; slider.dispatchEvent(new Event('input')); });
  await note('few handles');
  await click('#open-shelf');
  await at.locator('#shelf-samples [data-motion=walk]').click();
  await at.locator('#ask').waitFor();
  await note('question for a skeleton', true);
  await at.locator('#ask-no').click();
  await at.locator('#rigger').selectOption('template');
  await click('#correct');
  await note('correcting');
  await click('#correct');
  await bring('broken.glb', 'nonsense');
  await bring('notes.txt', 'nonsense');
  await bring('work.limber', 'nonsense');
  await bring('empty.zip', [0x50, 0x4b, 5, 6, ...new Array(18).fill(0)]);
  await bring('limits.json', '{}');
  await bring('walk.bvh', 'nonsense');
  const language = await at.evaluate(() => document.documentElement.lang);
  await context.close();
  return { met, names, language };
}

const cases = {
  async 'every text is in German, and nothing is left in English'() {
    const [english, other] = [await walk('en-US'), await walk('de-DE')];
    assert.deepEqual([english.language, other.language], ['en', 'de']);
    const same = Object.entries(german).filter(([key, value]) => value === key).map(([key]) => key);
    // Names of files, joints and methods, addresses; units; the program's own name.
    const plain = (text) => [...other.names, ...english.names, ...same, 'limber', 'limber studio', 'Deutsch', 'English']
      .sort((a, b) => b.length - a.length).reduce((left, name) => left.replaceAll(name, ''), text);
    const left = [...other.met].filter(([text]) => english.met.has(text) && /\p{L}{2}/u.test(plain(text).replace(/\b(mm|cm\/s|s|BVH|GLB|PNG|WebM|OBJ|STL|JSON)\b|\S+\.\w+/g, '')));
    assert.deepEqual(left, [], 'the same in both languages');
  },
  'every entry of the table is used'() {
    const written = filesIn(sources, '.ts').filter((path) => !/words.(german|english)\.ts$/.test(path)).map((path) => readFileSync(path, 'utf8')).join('\n');
    const used = (key) => {
      const noun = /^\{count\} (\w+)s$/.exec(key)?.[1];
      return written.includes(`'${key.replaceAll('\u2026', '\\u2026').replaceAll('\u2019', '\\u2019')}'`) || (noun && new RegExp(`counted\\([^;]*'${noun}'\\)`).test(written));
    };
    assert.deepEqual(Object.keys(german).filter((key) => !used(key)), []);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
