// Parts of bodies as the engine labels them ("left hind upper leg", "left wing 2") or names them ("leftIndexProximal"),
// in the words of the page.
import { say, type Words } from './say';

const parts: readonly Words[] = [
  'trunk', 'hips', 'spine', 'chest', 'upper chest', 'neck', 'head', 'tail', 'leg', 'hip', 'upper leg', 'thigh', 'lower leg', 'shin', 'hock', 'foot', 'toes',
  'arm', 'shoulder', 'upper arm', 'lower arm', 'forearm', 'arm hock', 'hand', 'arm toes', 'wing', 'fin', 'finger', 'ear', 'jaw', 'eye', 'hair', 'prop', 'other',
  'upper front leg', 'lower front leg', 'upper hind leg', 'lower hind leg',
  'thumb metacarpal', 'thumb proximal', 'thumb distal', 'index proximal', 'index intermediate', 'index distal',
  'middle proximal', 'middle intermediate', 'middle distal', 'ring proximal', 'ring intermediate', 'ring distal',
  'little proximal', 'little intermediate', 'little distal',
];
const places = { left: 'left {part}', right: 'right {part}', front: 'front {part}', hind: 'hind {part}' } as const satisfies Record<string, Words>;

/** A label that names no part that is known stays as it is. */
export function partName(label: string): string {
  return named(label.replace(/([a-z\d])([A-Z])|([a-z])(\d)/g, '$1$3 $2$4').toLowerCase().split(' ')) ?? label;
}

/** null where no part is called so. */
function named(words: string[]): string | null {
  const first = words[0] ?? '', last = words.at(-1) ?? '';
  if (/^\d+$/.test(last)) {
    const isPiece = words.at(-2) === 'piece', part = named(words.slice(0, isPiece ? -2 : -1));
    return part && say(isPiece ? '{part}, piece {number}' : '{part} {number}', { part, number: last });
  }
  if (first in places) {
    const part = named(words.slice(1));
    return part && say(places[first as keyof typeof places], { part });
  }
  const known = parts.find((part) => part === words.join(' '));
  return known ? say(known) : null;
}

/** What a joint is called by a person: its part of the body where that is known. */
export const jointTitle = (joint: { name: string; part: string | null } | undefined) => (joint?.part ? partName(joint.part) : joint?.name ?? '');
