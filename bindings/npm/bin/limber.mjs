#!/usr/bin/env node
// npx limber rig IN -o OUT: the options of limber rig that the engine takes by itself.
import { readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { basename, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { load } from '../dist/index.mjs';

const usage = `limber rig IN.glb -o OUT.glb [options]     (limber.mjs, the engine as WebAssembly)

  --handles N           how many joints (default: as many as suit the model)
  --rigger NAME         sphere-mesh, curve-skeleton, template, prop
  --skinning NAME       bone-heat, geodesic-voxel, bounded-biharmonic, envelopes, nearest-bone
  --pieces NAME         auto, rigid, soft
  --max-influences N    joints that a vertex may follow, 1 to 8
  --chains              what hangs gets joints that swing
  --replace-rig         take the model's own rig out first
  --keep-skeleton       keep the model's own skeleton, make its weights anew
  --json FILE           write the report; - is standard output
  -q, --quiet           print nothing but errors

The other commands are the native program's.`;

class Refused extends Error {}

function fail(problem, code = 1) {
  console.error(`limber: ${problem}`);
  process.exitCode = code;
}

function options(args) {
  try {
    return parseArgs({
      args, allowPositionals: true, options: {
        output: { type: 'string', short: 'o' }, handles: { type: 'string' }, rigger: { type: 'string' }, skinning: { type: 'string' },
        pieces: { type: 'string' }, 'max-influences': { type: 'string' }, chains: { type: 'boolean' }, 'replace-rig': { type: 'boolean' },
        'keep-skeleton': { type: 'boolean' }, json: { type: 'string' }, quiet: { type: 'boolean', short: 'q' }, help: { type: 'boolean', short: 'h' },
        version: { type: 'boolean' },
      },
    });
  } catch (error) {
    throw new Refused(`${error.message} (limber --help shows how to call it)`);
  }
}

function number(text, name) {
  if (text === undefined) return undefined;
  if (!/^\d+$/.test(text) || Number(text) < 1) throw new Refused(`--${name} takes a number from 1 on, not ${text}`);
  return Number(text);
}

/** All or nothing: the file stands in its place once it is whole. */
function write(path, content) {
  const unfinished = `${path}.${process.pid}.part`;
  try {
    writeFileSync(unfinished, content);
    renameSync(unfinished, path);
  } finally {
    rmSync(unfinished, { force: true });
  }
}

async function main() {
  const { values, positionals: [command, input, ...others] } = options(process.argv.slice(2));
  if (values.version) return console.log(`limber ${JSON.parse(readFileSync(new URL('../package.json', import.meta.url))).version}`);
  if (values.help || !command) return console.log(usage);
  if (command !== 'rig') throw new Refused(`there is no command '${command}' here; there is: rig (the native program has the others)`);
  if (!input || others.length > 0 || !values.output) throw new Refused('rig takes one model and -o OUT.glb');
  const { output, json } = values;
  if (output !== '-' && !/\.glb$/i.test(output)) throw new Refused(`${output}: a .glb is written, or - for standard output`);
  if (json !== undefined && (json === output || (json !== '-' && [input, output].some((path) => resolve(path) === resolve(json))))) {
    throw new Refused('--json needs a file of its own');
  }
  if (values['replace-rig'] && values['keep-skeleton']) throw new Refused('--replace-rig and --keep-skeleton exclude each other');
  const rig = {
    handles: number(values.handles, 'handles'), maxInfluences: number(values['max-influences'], 'max-influences'), rigger: values.rigger, skinning: values.skinning,
    pieces: values.pieces, chains: values.chains,
    existingRig: values['replace-rig'] ? 'replace' : values['keep-skeleton'] ? 'keep-skeleton' : undefined,
  };
  let bytes;
  try {
    bytes = readFileSync(input);
  } catch (error) {
    return fail(`${input}: cannot be opened: ${error.message}`);
  }
  const limber = await load();
  const result = limber.rig(bytes, basename(input), Object.fromEntries(Object.entries(rig).filter(([, value]) => value !== undefined)));
  if (!result.ok) {
    const { where, message, remedy } = result.error;
    return fail(`${where ? `${where}: ` : ''}${message}${remedy ? ` (${remedy})` : ''}`);
  }
  const report = `${JSON.stringify(result.report, null, 2)}\n`;
  if (json !== undefined && json !== '-') write(json, report); // before the model: what cannot be written leaves none
  if (output === '-') process.stdout.write(result.glb);
  else write(output, result.glb);
  if (json === '-') process.stdout.write(report);
  else if (!values.quiet && output !== '-') console.log(`written: ${output}`);
}

main().catch((error) => fail(error.message, error instanceof Refused ? 2 : 1));
