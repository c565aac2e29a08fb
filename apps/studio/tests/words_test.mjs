// The words of the page: every text in English and in German, larger text, and what fingers do instead of keys.
//
//   node apps/studio/tests/words_test.mjs DIST OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, readdirSync, statSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import ts from 'typescript';
import { barriers, launch, openStudio, runCases, serve, sessionState, settled } from './page.mjs';

const [dist, output] = process.argv.slice(2).map((path) => resolve(path));
const sources = join(dirname(fileURLToPath(import.meta.url)), '../src'), repository = join(sources, '../../..');
mkdirSync(output, { recursive: true });
const server = await serve(dist), browser = await launch();
const errors = [];
let page;

const filesIn = (folder, ending) => readdirSync(folder, { recursive: true }).map((name) => join(folder, name))
  .filter((path) => path.endsWith(ending) && statSync(path).isFile());
const escaped = (text) => text.replace(/[\\^$.*+?()[\]{}|/]/g, '\\$&');
const { outputText } = ts.transpileModule(readFileSync(join(sources, 'words/german.ts'), 'utf8'), { compilerOptions: { module: ts.ModuleKind.ESNext } });
const { german } = await import(`data:text/javascript,${encodeURIComponent(outputText)}`);

async function open(options) {
  const opened = await openStudio(browser, server.address, { search: '?sample=biped', ...options });
  opened.page.on('close', () => errors.push(...opened.errors));
  page = opened.page;
  return opened;
}

/** What a person can see or hear of the page, hidden parts too. */
const texts = (of) => of.evaluate(() => {
  const found = new Set();
  const add = (text) => { if (/\p{L}{2}/u.test(text ?? '')) found.add(text.trim()); };
  const walker = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    if (node.nodeType === Node.TEXT_NODE) {
      if (!node.parentElement.closest('script, style, .detail[lang=en]')) add(node.data);
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
  const met = new Map(), names = new Set(), inEnglish = [];
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
    await refused(`error of ${name}`);
  };
  const refused = async (what) => {
    await at.locator('#notice').waitFor();
    await note(what);
    if (await at.locator('#notice .detail[lang=en]').count() > 0) inEnglish.push(what);
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
  await at.locator('#rename').fill((await sessionState(at)).joints[0].name);
  await at.locator('#rename').press('Enter');
  await refused('a name that is taken');
  await click('#gizmo');
  await click('#exact summary');
  await click('#select-several');
  await note('exact values');
  await click('#select-several');
  await click('#limits');
  await click('#tasks summary');
  await at.locator('#task-ground').waitFor();
  await click('#task-ground');
  await note('a task that is met');
  await click('#undo');
  await note('a task that was taken back');
  await click('#tasks summary');
  await click('.pose [data-value=parts]');
  await at.locator('#legend li').first().waitFor();
  await note('limbs');
  await click('.pose [data-value=handles]');
  await click('#paint');
  await note('painting');
  await click('#paint');
  await click('#methods summary');
  await click('#check-rig');
  await note('whether it can be rigged');
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
  await at.locator('#handles').evaluate((slider) => { slider.value = '250'; slider.dispatchEvent(new Event('input')); });
  await note('few handles');
  await click('#open-shelf');
  await at.locator('#shelf-samples [data-motion=gallop]:not([aria-busy])').waitFor();
  await at.locator('[data-motion=gallop]').hover();
  await note('shelf');
  await at.locator('#shelf-samples [data-motion=walk]').click();
  await at.locator('#ask').waitFor();
  await note('question for a skeleton', true);
  await at.locator('#ask-yes').click();
  await click('#play[aria-pressed=true]');
  await note('motion');
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
  return { met, names, language, inEnglish };
}

/** Texts wider than what they stand in, panels that lie on each other or stick out of the page. */
const cutOff = (of) => of.evaluate(() => {
  const shown = [...document.querySelectorAll('button, label, summary, h2, h3, dt, th')].filter((one) => one.checkVisibility() && one.clientWidth > 0);
  const cut = shown.filter((one) => one.scrollWidth > one.clientWidth + 1).map(({ id, textContent, scrollWidth, clientWidth }) => `${id} ${textContent}: ${scrollWidth} > ${clientWidth}`);
  const panels = ['.bar', '.stage', '.side', '.timeline'].flatMap((selector) => {
    const one = document.querySelector(selector);
    return one.checkVisibility() ? [{ selector, box: one.getBoundingClientRect() }] : [];
  });
  const out = panels.filter(({ box }) => box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1).map(({ selector }) => `${selector} is off the page`);
  const over = panels.flatMap((a, i) => panels.slice(i + 1).filter(({ box }) => a.box.left < box.right - 1 && box.left < a.box.right - 1 && a.box.top < box.bottom - 1 && box.top < a.box.bottom - 1)
    .map((b) => `${a.selector} lies on ${b.selector}`));
  return [...cut, ...out, ...over];
});

const cases = {
  async 'every text is in German, and nothing is left in English'() {
    const [english, other] = await Promise.all([walk('en-US'), walk('de-DE')]);
    assert.deepEqual([english.language, other.language], ['en', 'de']);
    assert.deepEqual(other.inEnglish, ['error of work.limber', 'error of walk.bvh'], 'what readers say of damaged files is English');
    const same = Object.entries(german).filter(([key, value]) => value === key).map(([key]) => key);
    // Names of files, joints and methods, addresses; units; the program's own name.
    const plain = (text) => [...other.names, ...english.names, ...same, 'limber', 'limber studio', 'Deutsch', 'English']
      .filter((name) => name !== '').sort((a, b) => b.length - a.length).reduce((left, name) => left.replaceAll(new RegExp(`(?<![\\p{L}\\d])${escaped(name)}(?![\\p{L}\\d])`, 'gu'), ''), text);
    const left = [...other.met].filter(([text]) => english.met.has(text) && /\p{L}{2}/u.test(plain(text).replace(/\b(mm|cm\/s|s|BVH|GLB|PNG|WebM|OBJ|STL|JSON|Alt)\b|\S+\.\w+/g, '')));
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
  'warnings, errors and methods that have words are still the engine\u2019s'() {
    const engine = filesIn(join(repository, 'limber'), '.cpp').map((path) => readFileSync(path, 'utf8')).join('\n');
    const table = readFileSync(join(sources, 'words/engine.ts'), 'utf8'), part = (from, to) => table.slice(table.indexOf(from), table.indexOf(to));
    const errorKinds = [...part('const kinds', 'const leads').matchAll(/^ {2}'([a-z-]+)': \{/gm)].map(([, kind]) => kind);
    const thrown = [...readFileSync(join(repository, 'limber/core/known_error.cpp'), 'utf8').matchAll(/return "([a-z]+-[a-z-]+)";/g)].map(([, kind]) => kind);
    assert.ok(thrown.length > 30);
    assert.deepEqual(errorKinds, thrown);
    const kinds = [...part('const warnings', 'type Warning').matchAll(/'([a-z-]+)':/g)].map(([, kind]) => kind);
    const methods = [...part('const methods', 'export const methodName').matchAll(/'([a-z-]+)': \{/g)].map(([, name]) => name);
    assert.ok(kinds.length > 10 && methods.length > 10);
    const check = readFileSync(join(sources, 'words/rig_check.ts'), 'utf8');
    const advice = [...check.slice(check.indexOf('const advice')).matchAll(/^ {2}'([a-z-]+)': \(/gm)].map(([, kind]) => kind);
    const bodies = [...check.slice(0, check.indexOf('const poses')).matchAll(/'([a-z-]+)': '/g)].map(([, name]) => name);
    assert.ok(advice.length > 5 && bodies.length > 5);
    assert.deepEqual([...kinds, ...methods, ...advice, ...bodies].filter((text) => !engine.includes(`"${text}"`)), []);
  },
  async 'a language and a size of the text that are chosen are kept'() {
    const { page: at, context } = await open();
    const said = () => at.evaluate(() => [document.documentElement.lang, document.querySelector('#open').textContent, getComputedStyle(document.documentElement).fontSize]);
    const choose = async (value, reloaded) => {
      await Promise.all([reloaded ? at.waitForEvent('load') : null, at.locator('#export-as').selectOption(value)]);
      await settled(at);
    };
    await choose('largest', false);
    await choose('de', true);
    assert.deepEqual(await said(), ['de', '\u00d6ffnen', '24px']);
    assert.equal((await sessionState(at)).name, 'biped');
    await choose('normal', false);
    await choose('system', true);
    assert.deepEqual(await said(), ['en', 'Open', '16px']);
    await context.close();
  },
  async 'text of twice the size is nowhere cut off, and no panel lies on another'() {
    for (const [width, height, large] of [[1280, 800, 32], [390, 844, 24]]) {
      const { page: at, context } = await open({ locale: 'de-DE', width, height, touch: width < 500 });
      const inBothSizes = async (where) => {
        for (const size of [16, large]) {
          await at.evaluate((pixels) => { document.documentElement.style.fontSize = `${pixels}px`; }, size);
          await settled(at);
          assert.deepEqual(await cutOff(at), [], `${width} x ${height}, ${size} px, ${where}`);
          await at.screenshot({ path: join(output, `words_${width}_${size}_${where}.png`) });
        }
      };
      for (const selector of ['#joints li:nth-child(9)', '#pin', '#limits', '#paint', '#methods summary']) await at.locator(selector).click();
      await inBothSizes('panels');
      await at.locator('#paint').click();
      await at.locator('#add-clip').click();
      await settled(at);
      await at.locator('#open-keys').click();
      await inBothSizes('keys');
      await context.close();
    }
  },
  async 'what keys do, fingers can do'() {
    const { page: at, context } = await open({ locale: 'de-DE', width: 390, height: 844, touch: true, isMobile: true });
    const written = readFileSync(join(sources, 'app/shortcuts.ts'), 'utf8');
    const keys = [...written.slice(written.indexOf('const plain'), written.indexOf('addEventListener')).matchAll(/^ {4}'(.+?)':|^ {4}.*, '(.)': /gm)].map(([, key, other]) => key ?? other);
    assert.ok(keys.length > 20);
    // Two fingers zoom.
    const fingers = { '+': 'main canvas', '-': 'main canvas', '[': '#brush-size', ']': '#brush-size' };
    const buttons = {
      g: '.pose [data-value=move]', r: '.pose [data-value=turn]', S: '.pose [data-value=scale]', i: '#follow [data-value=alone]', s: '#both-sides', m: '#mirror', p: '#pin', h: '[data-value=surface]', f: '#whole-model', Home: '#whole-model',
      Delete: '#reset-joint', 1: '#view-front', 3: '#view-right', 7: '#view-top', 5: '#view-flat', ' ': '#play', k: '#add-key', b: '#paint', l: '#lock-joint', x: '#gizmo', '?': '#export-as',
      n: '#magnet', v: '#select-several', c: '#copy-pose', z: '#undo', Z: '#redo', y: '#redo', o: '#open',
    };
    await at.locator('#joints li:nth-child(9)').tap();
    await at.locator('#paint').tap();
    await at.locator('#add-clip').tap();
    await settled(at);
    for (const key of keys) {
      const control = at.locator(fingers[key] ?? buttons[key] ?? `#no-equivalent-of-${key}`).first();
      assert.ok(await control.isVisible(), `nothing does what ${key} does`);
      const box = await (await control.evaluate((one) => one.matches('[type=checkbox]')) ? control.locator('..') : control).boundingBox();
      assert.ok(box.height >= 43.5, `${key}: ${box.height} pixels high`);
    }
    const before = (await sessionState(at)).joints.length;
    await at.locator('#fewer-handles').tap();
    await settled(at);
    assert.ok((await sessionState(at)).joints.length < before);
    await at.locator('#export-as').selectOption('help');
    const help = await at.locator('#help').textContent();
    assert.match(help, /Was Finger tun/);
    assert.doesNotMatch(help, /Strg|Umschalt\+|Entf/);
    assert.deepEqual(await barriers(at), []);
    await context.close();
  },
  async 'nothing keeps people out in German, and nothing moves where that is not wanted'() {
    const { page: at, context } = await open({ locale: 'de-DE', reducedMotion: 'reduce', colorScheme: 'dark' });
    await at.locator('#joints li:nth-child(9)').click();
    await at.locator('#methods summary').click();
    await at.locator('#add-clip').click();
    await settled(at);
    assert.deepEqual(await barriers(at), []);
    assert.deepEqual(await at.evaluate(() => [...document.querySelectorAll('*')].filter((one) => parseFloat(getComputedStyle(one).transitionDuration) > 0).map(({ id }) => id)), []);
    await context.close();
  },
  'the console stayed without errors'() {
    assert.deepEqual(errors, []);
  },
};

const failed = await runCases(cases, () => page, output);
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
