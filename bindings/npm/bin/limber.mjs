#!/usr/bin/env node
// npx limber rig IN -o OUT: limber rig by the engine as WebAssembly. npx limber retarget: see retarget.mjs.
import { readFileSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { basename, extname, resolve } from 'node:path';
import { load } from '../dist/index.mjs';
import { retarget, retargetHelp } from './retarget.mjs';
import { engineOptions, given, optionsHelp, Refused } from './rig_options.mjs';

const version = () => JSON.parse(readFileSync(new URL('../package.json', import.meta.url), 'utf8')).version;

/** What was wrong with a file or in the engine; its words stand for themselves. */
class Failed extends Error {
  constructor(message, code = 1) {
    super(message);
    this.code = code;
  }
}

const outOfMemoryCode = 3, brokenPipeCode = 141; // the native program's

/** Of an error of Node's, without the code and the paths that it is told with: "ENOENT: no such file or directory, open 'x'". */
const reasonOf = ({ code, message }) => message.replace(`${code}: `, '').replace(/, \w+( '.*)?$/s, '');

function fail(problem, code = 1) {
  console.error(`limber: ${problem}`);
  process.exitCode = code;
}

async function help() {
  const limber = await load(), { rigger, skinning } = limber.methods(), { template, pieces, target } = limber.rigChoices();
  const list = (title, methods) => `${title}:\n${methods.map(({ name, summary }) => `  ${name.padEnd(20)}${summary}`).join('\n')}\n`;
  return `Give a model handles and skin weights (the engine as WebAssembly)
Usage: limber rig [OPTIONS] IN.glb -o OUT.glb     IN may be - for standard input
       limber retarget MODEL.glb MOTIONS... -o OUT.glb     limber retarget --help tells more

Options:
${optionsHelp}

${list('Riggers', rigger)}${list('Templates', template)}${list('Skinning methods', skinning)}${list('Pieces', pieces)}${list('Targets', target)}
Reads GLB, and glTF in one file. The native program reads other formats and has the other commands.

Example:
  npx limber rig scan.glb --template humanoid --pin leftHand=0.71,1.43,0.02 -o character.glb`;
}

function read(path) {
  try {
    return readFileSync(path === '-' ? 0 : path);
  } catch (error) {
    throw new Failed(`${path}: cannot be opened: ${reasonOf(error)}`);
  }
}

const isFolder = (path) => statSync(path, { throwIfNoEntry: false })?.isDirectory() ?? false;

/** All or nothing: the files stand in their places once all are whole. */
function write(files) {
  const parts = [];
  let at = '';
  try {
    for (const { path, content } of files) {
      at = path;
      if (isFolder(path)) throw new Error('is a folder, not a file');
      parts.push(`${path}.${process.pid}.part`);
      writeFileSync(parts.at(-1), content);
    }
    files.forEach(({ path }, i) => {
      at = path;
      renameSync(parts[i], path);
    });
  } catch (error) {
    throw new Failed(`${at}: ${error.code ? `cannot be written: ${reasonOf(error)}` : error.message}`);
  } finally {
    for (const part of parts) rmSync(part, { force: true });
  }
}

function checkFiles(input, others, { output, json, template = '' }) {
  if (!input || others.length > 0 || output === undefined) throw new Refused('rig takes one model and -o OUT.glb');
  if (output !== '-' && !/\.glb$/i.test(output)) throw new Refused(`${output}: a .glb is written, or - for standard output`);
  const isTaken = (path) => (json === '-' ? path === '-' : path !== '-' && resolve(path) === resolve(json));
  if (json !== undefined && (isTaken(output) || (json !== '-' && [input, template].some(isTaken)))) throw new Refused('--json needs a file of its own');
}

/** A template's name, or what is in the file of one. */
const templateOf = (name) => (extname(name) ? { name: basename(name), bytes: read(name) } : name);

function tellWarnings(warnings) {
  for (const { kind, message, where, count } of warnings) {
    const place = where ? `, ${count === 1 ? 'at' : 'first at'} ${where}` : '';
    console.error(`warning: ${message}${count > 1 ? ` (${count})` : ''} [${kind}]${place}`);
  }
}

async function rig(input, { output, json, strict, quiet }, options) {
  if (options.template) options.template = templateOf(options.template);
  const bytes = read(input);
  const limber = await load({ optionNames: 'program' });
  const result = limber.rig(bytes, basename(input), options);
  if (!result.ok) {
    const { code, where, message, remedy, kind } = result.error, line = `${where ? `${where}: ` : ''}${message}${remedy ? ` (${remedy})` : ''}`;
    throw code === 'bad-argument' && where.startsWith('--') ? new Refused(line) : new Failed(line, kind === 'out-of-memory' ? outOfMemoryCode : 1);
  }
  const { warnings } = result.report, format = bytes.subarray(0, 4).equals(Buffer.from('glTF')) ? 'glb' : 'gltf';
  if (strict && warnings.length > 0) throw new Failed(`${warnings[0].message} [${warnings[0].kind}] (--strict takes warnings as errors)`);
  const report = `${JSON.stringify({ limber: version(), command: 'rig', input: { file: input, format }, output, ...result.report }, null, 2)}\n`;
  const files = [{ path: output, content: result.glb }, { path: json, content: report }];
  write(files.filter(({ path }) => path !== undefined && path !== '-')); // before standard output: what cannot be written leaves nothing
  if (output === '-') process.stdout.write(result.glb);
  if (json === '-') process.stdout.write(report);
  if (quiet) return;
  tellWarnings(warnings);
  if (output !== '-' && json !== '-') console.log(`written: ${output}`);
}

async function main() {
  const { values, positionals: [command, input, ...others] } = given(process.argv.slice(2));
  if (values.version) return console.log(`limber ${version()}`);
  if (command === 'retarget') {
    if (values.help) return console.log(retargetHelp);
    return retarget(input === undefined ? [] : [input, ...others], values, { read, write, tellWarnings, failed: (line) => new Failed(line) });
  }
  if (values.help || !command) return console.log(await help());
  if (command !== 'rig') throw new Refused(`there is no command '${command}' here; there are: rig, retarget (the native program has the others)`);
  checkFiles(input, others, values);
  return rig(input, values, engineOptions(values));
}

process.stdout.on('error', (error) => { // who reads it has gone, or the disk is full
  if (error.code === 'EPIPE') process.exit(brokenPipeCode);
  fail(`standard output cannot be written: ${reasonOf(error)}`);
});

main().catch((error) => {
  if (error instanceof Refused) fail(`${error.message} (limber --help shows how to call it)`, 2);
  else fail(error.message, error instanceof Failed ? error.code : 1);
});
