// A document as one file: a ZIP archive of the files that were opened, and of what was done with them as the list of
// commands that `limber session replay` runs.
import { strFromU8, strToU8, zipSync, type Zippable } from 'three/examples/jsm/libs/fflate.module.js';
import { refusal } from '../engine/client';
import type { Command, Request } from '../engine/messages';
import { unpack } from './files';
import { say } from '../words/say';

const version = 2; // of the list of commands; the first knew no motions that are put on as they are added
const list = 'commands.json';
const namesFile = new Set(['open_file', 'add_file', 'add_motion', 'transfer_rig']);

/** `requests`: all that made the document. */
export function toLimberFile(requests: Request[]): Uint8Array {
  const files: Zippable = {};
  const commands = requests.map((request, number): Command => {
    if (request.kind === 'run') return request.command;
    if (request.kind !== 'open' && request.kind !== 'add' && request.kind !== 'motion' && request.kind !== 'transfer') throw new Error(`${request.kind} changes no document`);
    const file = `files/${number}/${request.name.replace(/[\\/]/g, '_')}`;
    files[file] = [request.bytes, { level: 6 }];
    if (request.kind === 'add') return { do: 'add_file', file, limbs_follow: request.limbsFollow, as_prop: request.asProp };
    if (request.kind === 'transfer') return { do: 'transfer_rig', file };
    return request.kind === 'open' ? { do: 'open_file', file, limbs_follow: request.limbsFollow ?? false } : { do: 'add_motion', file, retarget: request.retarget ?? false };
  });
  files[list] = strToU8(JSON.stringify({ limber_commands: version, commands }, null, 1));
  return zipSync(files);
}

export function fromLimberFile(archive: Uint8Array, name: string): Request[] {
  const refuse = (message: string) => refusal(message, name, say('is it a file that this page saved?'));
  const files = unpack(archive, name), text = files.get(list);
  if (!text) throw refuse(say('it holds no {file}', { file: list }));
  let read: { limber_commands?: unknown; commands?: unknown } | null;
  try {
    read = JSON.parse(strFromU8(text));
  } catch {
    throw refuse(say('its {file} is no JSON', { file: list }));
  }
  if (typeof read?.limber_commands !== 'number' || read.limber_commands < 1) throw refuse(say('its {file} holds no commands', { file: list }));
  if (read.limber_commands > version) throw refuse(say('it was made by a newer version of this page'));
  const commands = read.commands;
  if (!Array.isArray(commands)) throw refuse(say('its {file} holds no commands', { file: list }));
  return commands.map((command: Command): Request => {
    if (!namesFile.has(command?.do)) return { kind: 'run', command };
    const path = String(command.file), bytes = files.get(path);
    if (!bytes) throw refuse(say('it holds no {file}', { file: path }));
    const name = path.split('/').pop() ?? path;
    const limbsFollow = command.limbs_follow === true;
    if (command.do === 'add_file') return { kind: 'add', bytes, name, limbsFollow, asProp: command.as_prop === true };
    if (command.do === 'transfer_rig') return { kind: 'transfer', bytes, name };
    return command.do === 'open_file' ? { kind: 'open', bytes, name, limbsFollow } : { kind: 'motion', bytes, name, retarget: command.retarget === true };
  });
}
