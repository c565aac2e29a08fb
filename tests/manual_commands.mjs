// Runs every command of README.md, docs/*.md, docs/algorithms/*.md and the examples of each command's --help as they are written.
//
//   node tests/manual_commands.mjs PROGRAM OUTPUT_FOLDER [--only PAGE] [--verbose]
//
// Each page runs from top to bottom in an empty folder that holds nothing but the samples that README.md makes; the help texts
// have those that `limber sample --help` makes, too. A command has to end with 0, or with the exit code that its comment
// names ("# exit code 1"). A block of code without a command has to be something that is known (JSON, C++, ...), so that no
// command is overlooked. What cannot be run here is listed in `leftOut` with the reason; OUTPUT_FOLDER/not_run.txt
// counts it. Ends with "N passed, N failed".
import { spawn, spawnSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { cpus } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const words = process.argv.slice(2);
const only = words.includes('--only') ? words.splice(words.indexOf('--only'), 2)[1] : '';
const verbose = words.includes('--verbose') && words.splice(words.indexOf('--verbose'), 1).length > 0;
const program = resolve(words[0]), output = resolve(words[1]);
const root = dirname(dirname(fileURLToPath(import.meta.url)));
const kSamples = ['person.glb', 'hero.glb', 'walk.bvh', 'rigged.glb'];
const kSecondsOfACommand = 170;

// What is not run, and why.
const kData = 'needs data that is not in this repository', kLong = 'takes many minutes';
const leftOut = [
  [/^(sudo )?(apt|pip|npm) /, 'installs a package'],
  [/^(git clone|cd limber|\.\/dev|export PATH=|tar )/, 'builds limber'],
  [/^(build\/release\/)?limber studio/, 'serves until it is stopped'],
  [/^xdg-open /, 'opens a browser'],
  [/^blender /, 'needs Blender'],
  [/^integrations\//, 'needs a cluster'],
  [/^limber_fit_anatomy /, kData],
  [/^limber evaluate (anatomy|decomposition|skinning|transfer) /, kData],
  [/^limber evaluate templates (--labels|rigged)/, kData],
  [/^limber study docs\/data\//, kData],
  [/^limber study plan\.json -o report( +#.*)?$/, kLong],
  [/^limber evaluate measures report\//, kLong], // of a study's results
  [/^limber evaluate ik --plot /, kLong],
  [/amass_walk\.npz|old\.vrm/, 'needs a recording of AMASS, or a VRM 0.x'],
  [/\b(unirig|skintokens|my-retargeting)\b/, 'needs a program of the user'],
  [/votes? .*anna\.csv ben\.csv/, 'needs the votes of people'],
];

// Blocks that hold no command.
const kOtherText = [/^[{[]/, /^#include </, /^#include "/, /^import /, /^find_package/, /^voter,/, /^'position:/];
const kCommandWords = /^(\.\/dev|integrations\/|(limber|sudo|apt|pip|npm|npx|export|git|cd|echo|mkdir|cp|xdg-open|blender|tar|build\/release\/limber|limber_fit_anatomy) )/;

let passed = 0, failed = 0;
const fail = (what) => { ++failed; console.log(`FAILED: ${what}`); };

// The blocks of code of a page: its lines and the number of the first.
function blocksOf(text) {
  const lines = text.split('\n'), blocks = [];
  let block = null, fence = '';
  lines.forEach((line, i) => {
    const mark = line.match(/^(```+)/)?.[1];
    if (fence) {
      if (mark === fence) { fence = ''; block = null; } else block.lines.push(line);
    } else if (mark) {
      fence = mark;
      blocks.push(block = { at: i + 2, lines: [] });
    } else if (/^ {4}/.test(line) && (block || lines[i - 1]?.trim() === '')) {
      if (!block) blocks.push(block = { at: i + 1, lines: [] });
      block.lines.push(line.slice(4));
    } else if (line.trim() !== '' || (block && !/^ {4}/.test(lines[i + 1] ?? ''))) {
      block = null;
    } else if (block) {
      block.lines.push('');
    }
  });
  return blocks.filter(({ lines: inside }) => inside.some((line) => line.trim()));
}

// The commands of a block: continued lines are one command, comments alone are none.
function commandsOf({ at, lines }) {
  const commands = [];
  let open = null;
  lines.forEach((line, i) => {
    if (open) open.text += `\n${line}`;
    else if (line.trim() && !line.trim().startsWith('#')) commands.push(open = { at: at + i, text: line.trim() });
    if (!line.endsWith('\\')) open = null;
  });
  return commands.map(({ at: line, text }) => ({ at: line, text, code: Number(text.match(/#.*\bexit code (\d+)/)?.[1] ?? 0) }));
}

function pageOf(file) {
  const page = { name: file, commands: [] };
  for (const block of blocksOf(readFileSync(join(root, file), 'utf8'))) {
    const first = block.lines.find((line) => line.trim());
    if (kOtherText.some((kind) => kind.test(first))) continue;
    if (block.lines.some((line) => kCommandWords.test(line))) page.commands.push(...commandsOf(block));
    else fail(`${file}:${block.at}: neither commands nor a text that is known: ${first}`);
  }
  return page;
}

// The examples of --help, the lines behind "Example:" or "Examples:", and those of the commands below it, in one folder.
function helpOf(words) {
  const help = spawnSync(program, [...words, '--help'], { encoding: 'utf8' }).stdout, lines = help.split('\n');
  const at = lines.findIndex((line) => /^Examples?:/.test(line)), page = { name: ['limber', ...words, '--help'].join(' '), commands: [], below: [] };
  if (at >= 0) {
    const end = lines.findIndex((line, i) => i > at && !line.startsWith('  '));
    page.commands = commandsOf({ at: at + 2, lines: lines.slice(at + 1, end < 0 ? lines.length : end).map((line) => line.slice(2)) });
  }
  const list = lines.indexOf('Subcommands:');
  for (let i = list + 1; list >= 0 && lines[i]?.startsWith('  '); ++i) {
    const name = lines[i].match(/^ {2}(\S+)/)?.[1];
    if (name) page.below.push(name);
  }
  for (const command of page.commands) command.page = page.name;
  if (words.length > 0) page.commands.push(...page.below.flatMap((name) => helpOf([...words, name]).commands));
  return page;
}


const results = new Map(leftOut.map(([, reason]) => [reason, []]));
const kBin = join(output, 'bin');

function runOne(text, folder) {
  return new Promise((done) => {
    const started = Date.now();
    const child = spawn('bash', ['-c', text], {
      cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], detached: true,
      env: { ...process.env, PATH: `${kBin}:${process.env.PATH}`, HOME: folder, XDG_CONFIG_HOME: join(folder, '.config') },
    });
    let said = '';
    const hear = (data) => { said = (said + data).slice(-2000); };
    child.stdout.on('data', hear);
    child.stderr.on('data', hear);
    const timer = setTimeout(() => process.kill(-child.pid, 'SIGKILL'), kSecondsOfACommand * 1000);
    child.on('close', (code, signal) => {
      clearTimeout(timer);
      done({ code: code ?? signal, said, seconds: (Date.now() - started) / 1000 });
    });
  });
}

const slowest = [];
async function runPage(page, files) {
  const folder = join(output, page.name.replace(/\W+/g, '_'));
  mkdirSync(folder, { recursive: true });
  for (const file of files) copyFileSync(file, join(folder, basename(file)));
  for (const { at, text, code, page: of = page.name } of page.commands) {
    const reason = leftOut.find(([kind]) => kind.test(text))?.[1];
    if (reason) {
      results.get(reason).push(`${of}: ${text}`);
      continue;
    }
    const run = await runOne(text, folder);
    slowest.push([run.seconds, `${of}: ${text.split('\n')[0]}`]);
    if (run.code === code) ++passed;
    else fail(`${of}:${at}: ends with ${run.code}, not ${code}: ${text}\n  ${run.said.trim().split('\n').slice(-3).join('\n  ')}`);
  }
  return folder;
}

// As many pages at a time as there are processors, the longest first; pictures take longer than most commands.
async function runAll(pages) {
  const lengthOf = ({ commands }) => commands.reduce((sum, { text }) => sum + (text.startsWith('limber preview') ? 5 : 1), 0);
  const left = pages.filter(({ page }) => page.commands.length > 0).sort((a, b) => lengthOf(b.page) - lengthOf(a.page));
  await Promise.all(cpus().map(async () => {
    for (let next = left.shift(); next; next = left.shift()) {
      const { page, files } = next, folder = await runPage(page, files);
      if (page.name !== 'README.md') rmSync(folder, { recursive: true, force: true });
    }
  }));
}

rmSync(output, { recursive: true, force: true });
mkdirSync(kBin, { recursive: true });
symlinkSync(program, join(kBin, 'limber'));

const wanted = ({ name }) => !only || name.includes(only);
const readme = pageOf('README.md');
const made = await runPage(readme, []);
const samples = kSamples.map((name) => join(made, name));
for (const file of samples) if (!existsSync(file)) fail(`README.md does not make ${basename(file)}`);
if (failed === 0 || only) {
  const pages = ['docs', 'docs/algorithms'].flatMap((folder) => readdirSync(join(root, folder))
    .filter((name) => name.endsWith('.md')).map((name) => pageOf(`${folder}/${name}`)));
  const first = helpOf(['sample']), others = helpOf([]).below.filter((name) => name !== 'sample').map((name) => helpOf([name]));
  const folder = await runPage(first, samples);
  const models = readdirSync(folder).filter((name) => /\.(glb|bvh)$/.test(name)).map((name) => join(folder, name));
  await runAll([
    ...pages.filter(wanted).map((page) => ({ page, files: samples })),
    ...others.filter(wanted).map((page) => ({ page, files: models })),
  ]);
}

let notRun = '';
for (const [reason, commands] of results) {
  if (commands.length === 0 && !only) fail(`nothing is left out for the reason "${reason}" any more: take it off the list`);
  else notRun += `${commands.length} ${commands.length === 1 ? 'command' : 'commands'}: ${reason}\n`;
  if (verbose) for (const command of commands) notRun += `  ${command}\n`;
}
writeFileSync(join(output, 'not_run.txt'), notRun);
console.log(`Not run:\n${notRun}`);
console.log(`The slowest of ${slowest.length}:`);
for (const [seconds, command] of slowest.sort((a, b) => b[0] - a[0]).slice(0, verbose ? 20 : 5)) console.log(`  ${seconds.toFixed(1)} s ${command}`);
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
