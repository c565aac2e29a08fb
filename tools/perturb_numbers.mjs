// Which named numbers of retargeting change nothing when they are 20 % less or more: dead ones, and bounds that nothing
// meets.
//
//   node tools/perturb_numbers.mjs [FOLDER...]        (limber/motion/limbs and limber/motion/retarget)
//
// Copies the checkout to build/perturbed, where each `constexpr double kName = ...` of the folders (and int, float and
// the like; not in tests) reads its factor from the environment, and builds the program there. Then the judge
// (limber evaluate retargeting --judge) runs for every number and factor over a sample of people and animals. Prints a
// line for each number with its largest effect on any measure: the mean change over all pairs of a motion and a
// character, in percent of the measure's mean. Numbers without effect are tried again on whole motions of a larger
// sample, bit by bit. Takes four minutes to build, later only what has changed, and thirteen to run, on two processors.
import { execFile, spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));
const folders = process.argv.length > 2 ? process.argv.slice(2) : ['limber/motion/limbs', 'limber/motion/retarget'];
const shared = process.env.LIMBER_SHARED_DATA ?? '../shared/data';
const copy = 'build/perturbed', program = resolve(copy, 'build/release/limber');

const kFactors = [0.8, 1.2], kAtOnce = 2, kMethods = ['limb-ik', 'spacetime'];
const sample = (...names) => names.map((list, i) => list.split(' ').map((name) => join(shared, ['motions', 'rigged'][i], name)));
const kJudged = [ // motions, characters
  sample('cmu_mb_12_01_walk.bvh cmu_daz_02_04_jump_balance.bvh cmu_daz_02_06_bend_scoop_up.bvh cmu1_jumping_jacks.bvh fair1_dab.bvh rokoko_dance.bvh',
    'cesium_man.glb makehuman_mixamo.glb quaternius_mech_george.glb robot_expressive.glb m2m_human_zombie.glb quaternius_trex.glb'),
  sample('m2m_fox_animations.glb', 'm2m_fox_dog.glb quaternius_wolf.glb'),
  sample('m2m_bird_animations.glb', 'm2m_bird_eagle.glb'),
], kFurther = [
  sample('boxing_toes.bvh cmu_mb_01_01_forward_jumps.bvh cmu_daz_05_02_dance_pirouette.bvh pab_run.fbx kaykit_general.glb',
    'kenney_human.glb m2m_human_female.glb quaternius_knightcharacter.glb kaykit_mannequin/manny_med_mod.gltf'),
  sample('m2m_kaiju_animations.glb', 'quaternius_velociraptor.glb makehuman_default.glb'),
  sample('m2m_horse_animations.glb m2m_dragon_animations.glb', 'm2m_fox_cat.glb quaternius_triceratops.glb'),
  sample('m2m_spider_animations.glb', 'quaternius_spider.glb'),
  sample('m2m_shark_animations.glb', 'quaternius_dolphin.glb'),
];

const kHeader = `#pragma once
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <type_traits>

namespace limber {

// Times FACTOR where LIMBER_PERTURBED is NAME=FACTOR; whole numbers are rounded away from what they were.
template <typename Number>
Number perturbed(std::string_view name, Number value) {
  const char* text = std::getenv("LIMBER_PERTURBED");
  const std::string_view asked = text ? text : "";
  if (!asked.starts_with(name) || asked.substr(name.size(), 1) != "=") return value;
  double change = static_cast<double>(value) * (std::atof(text + name.size() + 1) - 1);
  if (std::is_integral_v<Number>) change = change < 0 ? std::floor(change) : std::ceil(change);
  return static_cast<Number>(static_cast<double>(value) + change);
}

}  // namespace limber
`;

/** The source with its numbers perturbed, these numbers, and those left out, such as what the compiler has to know. */
function perturbedSource(file, source, toCompile) {
  const numbers = [], leftOut = [];
  const text = source.replace(/^( *(?:inline |static )*)constexpr ([\w:]+(?:<[^>]*>)?) (k[A-Z]\w* = [^;]*);/gm, (_, before, type, body) =>
    body.replace(/ *\/\/.*$/gm, '').split(/,\s+(?=k[A-Z]\w* = )/).map((one) => one.split(' = ')).map(([name, value]) => {
      const entries = /^\{([-\d.e]+(?:,\s+[-\d.e]+)*)\}$/.exec(value)?.[1].split(/,\s+/);
      const isNumber = entries || /^(double|float|int|Index|std::size_t)$/.test(type);
      const why = type.startsWith('std::array') ? 'a table' : toCompile.has(`${file}:${name}`) ? 'needed to compile'
        : (entries ?? [value]).some((entry) => Number(entry) === 0) && 'zero';
      if (isNumber && why) leftOut.push({ name: `${file}:${name}`, value, why });
      if (!isNumber || why) return `${before}constexpr ${type} ${name} = ${value};`;
      const perturbed = (id, number, of) => {
        numbers.push({ name: id, value: number });
        return `perturbed<${of}>("${id}", ${number})`;
      };
      const now = entries ? `{${entries.map((entry, i) => perturbed(`${file}:${name}[${i}]`, entry, 'double')).join(', ')}}`
        : perturbed(`${file}:${name}`, value, type);
      return `${before.includes('inline') ? before : 'static '}const ${type} ${name} = ${now};`;
    }).join(' '));
  return { file, numbers, leftOut, text: numbers.length > 0 ? `#include "limber/core/perturbed.h"\n${text}` : source };
}

const listed = (...given) => spawnSync('git', ['ls-files', '-z', '--cached', '--others', '--exclude-standard', ...given],
  { encoding: 'utf8' }).stdout.split('\0').filter((file) => file && existsSync(file));

/** Touches only files that differ, so that only these are compiled again. */
function writeCopy(contents) {
  for (const [file, content] of contents) {
    const path = join(copy, file);
    mkdirSync(dirname(path), { recursive: true });
    if (!existsSync(path) || !readFileSync(path).equals(Buffer.from(content))) writeFileSync(path, content);
  }
  const sources = readdirSync(join(copy, 'limber'), { recursive: true }).map((file) => join('limber', file)).filter((file) => /\.(h|cpp)$/.test(file));
  for (const gone of sources.filter((file) => !contents.has(file))) rmSync(join(copy, gone));
}

/** Writes and builds the copy, as often as the compiler names further numbers that it has to know. */
function buildCopy() {
  const toCompile = new Set(), contents = new Map(listed().map((file) => [file, readFileSync(file)])).set('limber/core/perturbed.h', kHeader);
  const files = listed(...folders).filter((file) => /\.(h|cpp)$/.test(file) && !/_test\.cpp$|\/testing\//.test(file));
  for (;;) {
    const sources = files.map((file) => perturbedSource(file, readFileSync(file, 'utf8'), toCompile));
    for (const { file, text } of sources) contents.set(file, text);
    writeCopy(contents);
    // OMP_NUM_THREADS is the most that nproc says, by which ./dev tells how much to compile at once.
    const { status, stderr } = spawnSync('nice', ['-n', '10', 'bash', 'dev', 'build'],
      { cwd: copy, encoding: 'utf8', stdio: ['ignore', 'inherit', 'pipe'], env: { ...process.env, OMP_NUM_THREADS: `${kAtOnce}` } });
    if (status === 0) return { numbers: sources.flatMap(({ numbers }) => numbers), leftOut: sources.flatMap(({ leftOut }) => leftOut) };
    const errors = (stderr.match(/^.* error: .*\n.*/gm) ?? []).join('\n'); // each with the line that it is about
    const named = sources.flatMap(({ numbers }) => numbers).map(({ name }) => name.replace(/\[.*/, ''))
      .filter((name) => new RegExp(`\\b${name.split(':')[1]}\\b`).test(errors) && !toCompile.has(name));
    if (named.length === 0) throw new Error(stderr);
    named.forEach((name) => toCompile.add(name));
  }
}

let timeout = 0; // milliseconds; 0: none
const run = (given, perturbed) => promisify(execFile)('nice', ['-n', '10', program, ...given, '--threads', '1', '--quiet'],
  { env: { ...process.env, LIMBER_PERTURBED: perturbed }, encoding: 'buffer', maxBuffer: 2 ** 30, timeout, killSignal: 'SIGKILL' });

/** What the judge measures: for each method and measure the values of all pairs. */
async function judged(perturbed = '') {
  const each = join(copy, 'build', `each_${perturbed.replace(/\W+/g, '_')}.tsv`), values = {};
  const add = (name, value) => (values[name] ??= []).push(Number(value));
  const { stdout } = await run(['evaluate', 'retargeting', '--judge', '--motion', ...kJudged.flatMap(([motions]) => motions),
    '--character', ...kJudged.flatMap(([, characters]) => characters), ...kMethods.flatMap((method) => ['--method', method]),
    '--most-frames', '200', '--inside-frames', '0', '--each', each], perturbed);
  let heading = [];
  for (const cells of readFileSync(each, 'utf8').trimEnd().split('\n').map((line) => line.split('\t'))) {
    if (cells[0] === 'motion') heading = cells;
    const { method, motion, character, change, held_out, frames_per_second, ...measures } = Object.fromEntries(heading.map((name, i) => [name, cells[i]]));
    if (cells !== heading) for (const [name, value] of Object.entries(measures)) if (value !== '') add(`${method} ${name}`, value);
  }
  rmSync(each);
  const contacts = stdout.toString().split('| contact of the body with itself |')[1].split('\n').slice(2, -1);
  for (const [, , ...cells] of contacts.map((line) => line.split(/ *\| */))) {
    kMethods.forEach((method, i) => cells[i].match(/[\d.]+|nan|inf/g).forEach((value) => add(`${method} body contacts`, value)));
  }
  return values;
}

/** Of any measure, in percent of its mean; infinite where a value is no number or a pair is lost. */
function largestChange(before, after) {
  const sum = (values, of) => values.reduce((all, value, i) => all + Math.abs(of(value, i)), 0);
  return Object.entries(before).map(([measure, values]) => {
    const change = sum(values, (value, i) => after[measure]?.[i] - value), all = sum(values, (value) => value) || change || 1;
    return { measure, percent: Number.isNaN(change) ? Infinity : (100 * change) / all };
  }).reduce((most, one) => (one.percent > most.percent ? one : most));
}

/** `act` for each number and factor, some at once. */
async function forEachFactor(what, numbers, act) {
  const tasks = numbers.flatMap((number) => kFactors.map((factor, i) => [number, i, `${number.name}=${factor}`])), waiting = tasks.entries();
  await Promise.all(Array.from({ length: kAtOnce }, async () => {
    for (const [done, task] of waiting) {
      if (process.stderr.isTTY) process.stderr.write(`\r${what}: ${done + 1} of ${tasks.length} `);
      await act(...task);
    }
  }));
}

const { numbers, leftOut } = buildCopy(), started = Date.now(), seconds = () => ((Date.now() - started) / 1000).toFixed(0);
const measures = await judged();
console.log(`${numbers.length} numbers, ${Object.keys(measures).length} measures; the judge takes ${seconds()} s`);
timeout = 30000 + 10 * (Date.now() - started);
await forEachFactor('judge', numbers, async (number, i, perturbed) => {
  (number.changes ??= [])[i] = await judged(perturbed).then((after) => largestChange(measures, after), () => ({ measure: 'fails', percent: Infinity }));
});
for (const number of numbers) number.most = Math.max(...number.changes.map(({ percent }) => percent));

const unseen = numbers.filter(({ most }) => most === 0), expected = [];
const retargetings = [...kJudged, ...kFurther].flatMap(([motions, characters]) => characters.flatMap((character) =>
  kMethods.map((method) => ['retarget', character, ...motions, '--method', method, '-o', '-'])));
const hashOf = async (given, perturbed = '') => createHash('sha256').update((await run(given, perturbed)).stdout).digest('hex');
for (const given of retargetings) expected.push(await hashOf(given));
await forEachFactor('motions', unseen, async (number, _, perturbed) => {
  for (let i = 0; i < expected.length && !number.changesMotions; ++i) {
    if (await hashOf(retargetings[i], perturbed).catch(() => 'fails') !== expected[i]) number.changesMotions = true;
  }
});

const rows = numbers.filter(({ most }) => most > 0).sort((a, b) => b.most - a.most).map(({ name, value, changes }) =>
  [name, value, ...changes.flatMap(({ measure, percent }) => percent > 0 ? [percent < Infinity ? `${Number(percent.toPrecision(2))} %` : 'broken', measure] : ['none', ''])]);
const table = [['number', 'value', ...kFactors.flatMap((factor) => [`times ${factor}`, 'most of all'])], ...rows];
const widths = table[0].map((_, i) => Math.max(...table.map((row) => row[i].length)));
for (const row of table) console.log(row.map((cell, i) => cell.padEnd(widths[i])).join('  ').trimEnd());
const list = (title, some) => console.log([`\n${title}: ${some.length}`, ...some.map(({ name, value, why }) => `  ${name} = ${value}${why ? `, ${why}` : ''}`)].join('\n'));
list('Change motions of the larger sample, but no digit of a measure', unseen.filter((number) => number.changesMotions));
list('Change nothing at all', unseen.filter((number) => !number.changesMotions));
list('Not perturbed', leftOut);
console.log(`\n${seconds()} s without the build`);
