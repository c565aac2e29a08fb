// The options of `npx limber rig`: the names and the words of the native program's, told once for parsing, reading and help.
// Those of the native program that are not here are named in tests/package_test.mjs, with the reason.

import { parseArgs } from 'node:util';

export class Refused extends Error {}

const number = (option, text) => {
  if (!/^\d+$/.test(text)) throw new Refused(`--${option} takes a whole number, not ${text}`);
  return Number(text);
};

/** JOINT=x,y,z, several times. */
function pins(option, texts) {
  const places = Object.create(null); // a joint may have any name
  for (const text of texts) {
    const at = text.lastIndexOf('='), joint = text.slice(0, at), place = text.slice(at + 1).split(',').map((part) => (part.trim() ? Number(part) : NaN));
    if (at < 1 || place.length !== 3 || !place.every(Number.isFinite)) throw new Refused(`--${option} takes JOINT=x,y,z, not ${text}`);
    if (joint in places) throw new Refused(`--${option}: ${joint} is pinned twice`);
    places[joint] = place;
  }
  return places;
}

const text = (option, given) => given, flag = () => true;

// value: what is shown behind the name; a flag has none. field, read: the engine's option (RigOptions) and how it is made of
// what was given; without them the option is the program's own.
export const rigOptions = [
  { name: 'output', short: 'o', value: 'FILE', help: 'the .glb to write; - is standard output' },
  { name: 'handles', value: 'N', field: 'handles', read: number, help: 'handles wanted (default: the best suggested count)' },
  { name: 'max-influences', value: 'K', field: 'maxInfluences', read: number, help: 'joints that may move one vertex, 1 to 8' },
  { name: 'rigger', value: 'NAME', field: 'rigger', read: text, help: 'how joints are found, see below (default: sphere-mesh, or template where one is named)' },
  { name: 'template', value: 'NAME', field: 'template', read: text, help: 'fit this named skeleton: auto, a name below, or a file with a skeleton (.glb, .bvh, .json, ...)' },
  { name: 'pin', value: 'PIN', multiple: true, field: 'pins', read: pins, help: "where a joint of the template must be, as JOINT=x,y,z in the file's space; others follow" },
  { name: 'up', value: 'AXIS', field: 'up', read: text, help: "the model's up, for a template, as +y (default: found)" },
  { name: 'front', value: 'AXIS', field: 'front', read: text, help: 'where the model looks, for a template, as +z (default: found)' },
  { name: 'upright', field: 'upright', read: flag, help: 'turn a model that surely stands along another axis to stand along +Y' },
  { name: 'chains', field: 'chains', read: flag, help: 'give capes, scarves, braids and tails joints that swing (VRMC_springBone)' },
  { name: 'target', value: 'NAME', field: 'target', read: text, help: "joints' names, root and axes as another program expects them, see below" },
  { name: 'skinning', value: 'NAME', field: 'skinning', read: text, help: 'how weights are made, see below' },
  { name: 'pieces', value: 'NAME', field: 'pieces', read: text, help: 'how pieces that are joined to no other are bound, see below' },
  { name: 'replace-rig', field: 'existingRig', read: () => 'replace', help: "take the model's own rig and its joint animation out first" },
  { name: 'keep-skeleton', field: 'existingRig', read: () => 'keep-skeleton', help: "keep the model's own skeleton, make its weights anew" },
  { name: 'json', value: 'FILE', help: 'write a report: stages, seconds, counts, suggestions, warnings; - is standard output' },
  { name: 'strict', help: 'take warnings as errors' },
  { name: 'quiet', short: 'q', help: 'print nothing but errors' },
  { name: 'help', short: 'h', help: 'Print this help message and exit' },
];

const takesValue = new Set(rigOptions.filter(({ value }) => value).flatMap(({ name, short }) => [`--${name}`, ...(short ? [`-${short}`] : [])]));

/** An option's value joined to it: the next word, also where it begins with a hyphen (--front -z). */
function joined(words) {
  const args = [];
  for (let i = 0; i < words.length; i += 1) {
    if (words[i] === '--') return [...args, ...words.slice(i)];
    const isJoined = takesValue.has(words[i]) && i + 1 < words.length;
    args.push(isJoined ? `${longName(words[i])}=${words[i + 1]}` : words[i]);
    if (isJoined) i += 1;
  }
  return args;
}

/** What was given: values by name, and the other words. */
export function given(words) {
  const { values, positionals, tokens } = parseWords(joined(words)), seen = new Set();
  for (const { kind, name, value } of tokens) {
    if (kind !== 'option' || value === undefined) continue;
    if (value === '') throw new Refused(`--${name}: is empty`);
    if (seen.has(name) && !parsed[name].multiple) throw new Refused(`--${name}: is given twice`);
    seen.add(name);
  }
  return { values, positionals };
}

function parseWords(args) {
  try {
    return parseArgs({ args, allowPositionals: true, options: parsed, tokens: true });
  } catch (error) {
    throw new Refused(error.message.replace(/\s*\n\s*/g, ' '));
  }
}

/** For util.parseArgs. */
const parsed = Object.fromEntries([...rigOptions, { name: 'version' }].map(({ name, short, value, multiple = false }) =>
  [name, { type: value ? 'string' : 'boolean', multiple, ...(short && { short }) }]));

const longName = (word) => (word.startsWith('--') ? word : `--${rigOptions.find(({ short }) => `-${short}` === word).name}`);

/** The engine's options out of what was given. */
export function engineOptions(given) {
  if (given['replace-rig'] && given['keep-skeleton']) throw new Refused('--keep-skeleton excludes --replace-rig');
  return Object.fromEntries(rigOptions.filter(({ name, field }) => field && given[name] !== undefined)
    .map(({ name, field, read }) => [field, read(name, given[name])]));
}

export const optionsHelp = rigOptions.map(({ name, short, value, help }) =>
  `  ${`${short ? `-${short},` : ''}--${name}${value ? ` ${value}` : ''}`.padEnd(28)}${help}`).join('\n');
