// What the engine finds before a model is rigged, in the words of the page: kinds of bodies, poses, and what to do about what
// stands in the way. Its own sentences name options of the program.
import type { RigCheck } from '../engine/messages';
import { partName } from './parts';
import { say, type Words } from './say';

type Named = Readonly<Record<string, Words>>;
const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);

const kinds: Named = {
  'humanoid': 'Person', 'humanoid-fingers': 'Person with fingers', 'quadruped': 'Animal on four legs', 'bird': 'Bird', 'dinosaur': 'Dinosaur',
  'crawler': 'Low animal on four legs', 'dragon': 'Winged animal on four legs', 'insect': 'Animal on six legs', 'spider': 'Animal on eight legs',
  'fish': 'Fish', 'serpent': 'Snake',
};
const poses: Readonly<Record<NonNullable<RigCheck['pose']>, Words>> = {
  'T': 'T pose', 'A': 'A pose', 'hanging': 'Arms at the sides', 'other': 'Another pose',
};

/** "leftUpperArm to leftHand". */
const limbName = (limb: string) => {
  const [from, to] = limb.split(' to ');
  return to === undefined ? partName(limb) : say('{from} to {to}', { from: partName(from!), to: partName(to) });
};
const listed = (names: string[]) => names.join(', ');

type Told = (check: RigCheck) => string[];
/** Lines for each kind of the engine's advice. */
const advice: Readonly<Record<string, Told>> = {
  'no-template': () => [say('Handles suit it better. The named skeleton under Joints can be fitted all the same.')],
  'unsure-template': () => [say('It may be another kind of body. Look at the skeleton afterwards.')],
  'grown-together': ({ grown_together: contacts }) => contacts.map(({ parts: [one, other] }) =>
    capital(say('{one} and {other} are grown together and will move together, unless you cut them apart in the model.', {
      one: partName(one), other: partName(other),
    }))),
  'no-place': ({ missing }) => [say('These limbs are not seen, and their joints will move nothing, unless you correct them: {limbs}.', {
    limbs: listed(missing.map(limbName)),
  })],
  'not-upright': () => [say('It is not upright: another axis than +Y is up. It can be rigged as it is, or turned first in the program that it comes from.')],
  'maybe-not-upright': () => [say('It may not be upright: another axis than +Y may be up. If so, turn it first in the program that it comes from.')],
  'posed': () => [say('It is posed: where limbs touch, look at their areas afterwards.')],
  'doubtful-joints': ({ doubts }) => [say('In doubt: {joints}. The page asks for their positions afterwards.', { joints: listed(doubts.map(partName)) })],
  'has-rig': () => [say('It has a rig already, which the new one replaces.')],
};

/** Whether it is like no kind of body that is known. */
export const isNoBody = (check: RigCheck) => check.advice.some(({ kind }) => kind === 'no-template');

/** What it is, and how sure that is. */
export function bodyText(check: RigCheck): string {
  const [likeliest] = check.kinds;
  if (!likeliest) return say('It is like no body that is known');
  const known = kinds[likeliest.name], kind = known ? say(known) : capital(likeliest.name).replaceAll('-', ' ');
  const sure = say('{kind}, {share} % sure', { kind, share: Math.round(100 * likeliest.confidence) });
  return isNoBody(check) ? say('It is like no body that is known (likeliest: {kind})', { kind: sure }) : sure;
}

/** null where a pose has no name, as of animals. */
export const bodyPoseText = ({ pose }: RigCheck): string | null => pose && say(poses[pose]);

export interface Advice {
  text: string;
  /** It is the engine's own, which speaks English. */
  inEnglish: boolean;
}

export function adviceLines(check: RigCheck): Advice[] {
  const lines = check.advice.flatMap(({ kind, message }): Advice[] =>
    advice[kind]?.(check).map((text) => ({ text, inEnglish: false })) ?? [{ text: message, inEnglish: true }]);
  if (check.inner_shell_vertices === 0) return lines;
  return [...lines, { text: say('A copy of the surface lies within it, and will follow the outer one.'), inEnglish: false }];
}
