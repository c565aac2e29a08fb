// What comes from the engine as English, in the words of the page: stages, methods, motions, warnings and errors. What is
// not known here is shown as the engine says it.
import type { LimberError, SessionState } from '../engine/messages';
import { language, say, type Words } from './say';

type Named = Readonly<Record<string, Words>>;
const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
const spaced = (name: string) => capital(name).replaceAll('-', ' ');

const stages: Named = {
  'read': 'Reading the model', 'read geometry': 'Reading the surface', 'weld': 'Joining the surface',
  'rig': 'Finding handles', 'skin': 'Binding the surface', 'write rig': 'Finishing',
};
/** "rig: fit humanoid" is a step of the stage "rig". */
export function stageName(stage: string): string {
  const known = stages[stage.split(':')[0] ?? ''];
  return known ? say(known) : stage;
}

const methods: Readonly<Record<string, { name: Words; summary: Words }>> = {
  'sphere-mesh': { name: 'Handles in balls', summary: 'handles where the model is thick, any number of them' },
  'template': { name: 'Named skeleton', summary: 'a skeleton with names, fitted into the model' },
  'prop': { name: 'Prop', summary: 'one joint for all of it: a thing that does not bend' },
  'bone-heat': { name: 'Bone heat', summary: 'heat that flows from each bone over the surface' },
  'two-bone': { name: 'Two bones', summary: 'analytic, for limbs of two bones; bends to a pole' },
  'ccd': { name: 'CCD', summary: 'cyclic coordinate descent from the tip to the base' },
  'ccd-forward': { name: 'CCD, forward', summary: 'cyclic coordinate descent from the base to the tip' },
  'fabrik': { name: 'FABRIK', summary: 'forward and backward reaching, for chains and trees' },
  'jacobian-transpose': { name: 'Jacobian transpose', summary: 'steepest descent that goes on in the last step\u2019s direction too' },
  'pseudo-inverse': { name: 'Pseudo-inverse', summary: 'smallest step by singular values' },
  'dls': { name: 'DLS', summary: 'damped least squares, the damping scaled to what is left to go' },
  'sdls': { name: 'SDLS', summary: 'selectively damped least squares' },
  'whole-body': { name: 'Whole body', summary: 'damped least squares with priorities, for many effectors and a moving root' },
  'limb-ik': { name: 'Limbs by IK', summary: 'joints turn as the source\u2019s; feet stay planted, hands touch what they touched' },
  'online': { name: 'Hands and feet first', summary: 'hands and feet first, joint angles in the freedom that they leave' },
  'spacetime': { name: 'Whole motion', summary: 'the smallest smooth change over the whole motion that keeps feet planted and hands touching' },
  'aligned': { name: 'Aligned poses', summary: 'joints turn in the world as the source\u2019s, against a neutral pose that both share' },
  'copy': { name: 'Copied turns', summary: 'local rotations as they are; right for like skeletons only' },
};
export const methodName = (name: string) => {
  const known = methods[name];
  return known ? say(known.name) : spaced(name);
};
export const methodSummary = ({ name, summary }: { name: string; summary: string }) => {
  const known = methods[name];
  return known ? say(known.summary) : summary;
};

const motions: Readonly<Record<string, { name: Words; summary: Words }>> = {
  'walk': { name: 'Walk', summary: 'A person who walks' },
  'run': { name: 'Run', summary: 'A person who runs' },
  'sneak': { name: 'Sneak', summary: 'A person who sneaks, low and slow' },
  'jump': { name: 'Jump', summary: 'A person who jumps up' },
  'idle': { name: 'Idle', summary: 'A person who stands, breathes and looks round' },
  'wave': { name: 'Wave', summary: 'A person who waves a hand' },
  'sit-down': { name: 'Sit down', summary: 'A person who sits down and gets up again' },
  'turn': { name: 'Turn round', summary: 'A person who turns round on the spot' },
  'jumping-jack': { name: 'Jumping jack', summary: 'A person who does jumping jacks' },
  'quadruped-walk': { name: 'Walk on four legs', summary: 'An animal that walks on four legs' },
  'trot': { name: 'Trot', summary: 'An animal that trots' },
  'gallop': { name: 'Gallop', summary: 'An animal that gallops' },
};
export const motionName = (name: string) => {
  const known = motions[name];
  return known ? say(known.name) : spaced(name);
};
export const motionSummary = ({ name, summary }: { name: string; summary: string }) => {
  const known = motions[name];
  return known ? say(known.summary) : capital(summary);
};

const poses: Named = {
  'stand': 'Stand', 'walk': 'Walk', 'run': 'Run', 'jump': 'Jump', 'sit': 'Sit', 'crouch': 'Crouch', 'kneel': 'Kneel', 'bow': 'Bow',
  'reach': 'Reach', 'point': 'Point', 'wave': 'Wave', 'cheer': 'Cheer',
  'animal-stand': 'Stand', 'animal-walk': 'Walk', 'animal-sit': 'Sit', 'animal-lie': 'Lie down', 'animal-stretch': 'Stretch', 'animal-howl': 'Howl',
};
/** Whether of a person or an animal its picture tells. */
export const poseName = (name: string) => {
  const known = poses[name];
  return known ? say(known) : spaced(name);
};

const warnings: Named = {
  'no-place': 'limbs of the skeleton have no place in the model', 'low-confidence': 'the model hardly looks like the skeleton',
  'rigid-pieces': 'pieces follow one joint each, as hard parts', 'stray-pieces': 'pieces that float about the model are left out of account',
  'far-vertices': 'loose points far from the model count as nearer than they are',
  'degenerate-triangles': 'triangles without area are left out of the computation', 'no-bone-in-sight': 'no bone is in sight of any point of the surface',
  'morph-targets': 'morph targets are left out', 'lights': 'lights are left out', 'cameras': 'cameras are left out',
  'missing-images': 'pictures that cannot be found are left out', 'unsupported-images': 'pictures that are neither PNG nor JPEG are left out',
  'converted-units': 'the unit is converted to metres', 'converted-axes': 'the model is turned to Y up', 'invalid-keys': 'keys that make no sense are left out',
  'invalid-normals': 'normals without a direction are made anew', 'decompressed': 'what was compressed is saved uncompressed',
  'trailing-bytes': 'bytes behind the end of the file are left out', 'unknown-extensions': 'extensions of the file that are not known are left as they are',
  'no-motion': 'the file has a skeleton only, and no motion', 'cut-frame': 'the last frame is cut off, and left out',
  'decimal-commas': 'numbers have a comma for the point', 'turned-upright': 'the model lay down, and was turned upright',
};
type Warning = SessionState['warnings'][number];
/** In English the engine's own sentence, which knows the figures. */
export function warningText({ kind, message }: Pick<Warning, 'kind' | 'message'>): string {
  const known = warnings[kind];
  return known && language !== 'en' ? say(known) : message;
}

/** Sentences of the engine that a user of the page meets. */
const sentences: readonly Words[] = [
  'the model is not its own mirror image', 'neither the model nor its skeleton is its own mirror image', 'a joint needs a name', 'no clip is chosen',
  'the mesh has no triangle', 'is no GLB: it does not start with "glTF"',
];
/** All others: by what kind of error it is. */
const errors: Named = {
  'bad-argument': 'This is not possible here', 'file': 'The file cannot be read', 'bad-data': 'The file is damaged, or of another kind than its name says',
  'unsupported': 'This cannot be done with this model', 'limit': 'That is too large', 'engine': 'Something went wrong in the engine',
};

export interface ToldError {
  title: string;
  detail: string;
  /** The detail is the engine's own, which speaks English. */
  inEnglish: boolean;
}

const joined = (...texts: string[]) => texts.filter((text) => text !== '').join(' \u2014 ');

/** An error for people. Those of the page itself (code "page") are in their language already. */
export function told({ code, message, where, remedy }: LimberError): ToldError {
  if (code === 'page' || language === 'en') return { title: capital(message), detail: joined(where, remedy), inEnglish: false };
  const sentence = sentences.find((known) => known === message);
  if (sentence) return { title: capital(say(sentence)), detail: where, inEnglish: false };
  return { title: say(errors[code] ?? 'Something went wrong in the engine'), detail: joined(message, where, remedy), inEnglish: true };
}
