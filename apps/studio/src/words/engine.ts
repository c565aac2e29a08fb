// What comes from the engine as English, in the words of the page: stages, methods, motions, warnings and errors. What is
// not known here is shown as the engine says it.
import type { ErrorKind, LimberError, SessionState } from '../engine/messages';
import { partName } from './parts';
import { language, say, type Values, type Words } from './say';

type Named = Readonly<Record<string, Words>>;
const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
const spaced = (name: string) => capital(name).replaceAll('-', ' ');

const stages: Named = {
  'read': 'Reading the model', 'read geometry': 'Reading the surface', 'weld': 'Joining the surface',
  'rig': 'Finding handles', 'skin': 'Binding the surface', 'write rig': 'Finishing',
  'fit target': 'Finding the limbs', 'fit source': 'Finding the limbs', 'transfer': 'Laying one model on the other',
  'find bones': 'Finding bones', 'find joints': 'Finding joints',
};
/** "rig: read shape" is a step of the stage "rig". */
export function stageName(stage: string): string {
  const known = stages[stage.split(':')[0] ?? ''];
  return known ? say(known) : stage;
}

const methods: Readonly<Record<string, { name: Words; summary: Words }>> = {
  'sphere-mesh': { name: 'Handles in balls', summary: 'handles where the model is thick, any number of them' },
  'curve-skeleton': { name: 'Handles on curves', summary: 'joints along curves through the middle of limbs, any number of them' },
  'template': { name: 'Named skeleton', summary: 'a skeleton with names, fitted into the model' },
  'prop': { name: 'Prop', summary: 'one joint for all of it: a thing that does not bend' },
  'bone-heat': { name: 'Bone heat', summary: 'heat that flows from each bone over the surface' },
  'geodesic-voxel': { name: 'Ways inside', summary: 'the ways to bones through the inside, on a grid' },
  'bounded-biharmonic': { name: 'Smoothest inside', summary: 'the smoothest weights through the inside that stay between 0 and 1' },
  'envelopes': { name: 'Envelopes', summary: 'bones hold what is near them, whatever lies between' },
  'nearest-bone': { name: 'Nearest bone', summary: 'each vertex follows the nearest bone alone' },
  'linear-blend': { name: 'Linear blend', summary: 'weighted mean of what each joint alone would do; what saved models play with' },
  'dual-quaternion': { name: 'Dual quaternions', summary: 'weighted mean of the joints\u2019 motions; keeps volume where joints twist' },
  'centers-of-rotation': { name: 'Centres of rotation', summary: 'each vertex turns about the middle of what is bound like it; no bulge where joints bend' },
  'delta-mush': { name: 'Delta mush', summary: 'smooths the bent surface and puts its detail back; soft joints whatever the weights' },
  'direct-delta-mush': { name: 'Direct delta mush', summary: 'delta mush with its smoothing done once, on the graphics card' },
  'two-bone': { name: 'Two bones', summary: 'analytic, for limbs of two bones; bends to a pole' },
  'ccd': { name: 'CCD', summary: 'cyclic coordinate descent from the tip to the base' },
  'ccd-forward': { name: 'CCD, forward', summary: 'cyclic coordinate descent from the base to the tip' },
  'fabrik': { name: 'FABRIK', summary: 'forward and backward reaching, for chains and trees' },
  'particle': { name: 'Particles', summary: 'joints as particles at fixed distances, the spine first, then the limbs' },
  'jacobian-transpose': { name: 'Jacobian transpose', summary: 'steepest descent that goes on in the last step\u2019s direction too' },
  'pseudo-inverse': { name: 'Pseudo-inverse', summary: 'smallest step by singular values' },
  'dls': { name: 'DLS', summary: 'damped least squares, the damping scaled to what is left to go' },
  'sdls': { name: 'SDLS', summary: 'selectively damped least squares' },
  'mass-spring': { name: 'Masses and springs', summary: 'springs to the targets pull at bones with masses: light tips go first' },
  'whole-body': { name: 'Whole body', summary: 'damped least squares with priorities, for many effectors and a moving root' },
  'limb-ik': { name: 'Limbs by IK', summary: 'joints turn as the source\u2019s; feet stay planted, hands touch what they touched' },
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
  'insect-walk': { name: 'Walk on six legs', summary: 'An insect that walks on six legs' },
  'spider-walk': { name: 'Walk on eight legs', summary: 'A spider that walks on eight legs' },
  'swim': { name: 'Swim', summary: 'A fish that swims' },
  'slither': { name: 'Slither', summary: 'A snake that slithers' },
  'flap': { name: 'Beat wings', summary: 'A bird that beats its wings' },
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
  'far-vertices': 'points far away from the rest of the model do not count for its size',
  'repeated-faces': 'faces that are there twice count once', 'reversed-faces': 'faces that lie the wrong way round are taken the other way round',
  'inner-shell': 'a copy of the surface within it follows the outer one', 'surroundings': 'floors, walls and boxes round the figure follow its root joint',
  'joined-binds': 'parts that were bound in another pose are brought to that of the joints', 'vrm-turned': 'clips are turned with the model, which faces +Z',
  'moving-parents': 'the movement of nodes above the joints is part of the clips', 'still-parents': 'what hangs on nodes above the joints stands still',
  'negative-times': 'clips with keys before 0 s begin there now', 'missing-targets': 'movements of nodes that are not there are left out',
  'degenerate-triangles': 'triangles without area are left out of the computation', 'no-bone-in-sight': 'no bone is in sight of any point of the surface',
  'morph-targets': 'morph targets are left out', 'lights': 'lights are left out', 'cameras': 'cameras are left out',
  'invalid-rotations': 'nodes with a rotation of length 0 are not rotated', 'many-influences': 'of more than eight joints of a vertex only the strongest move it',
  'missing-materials': 'the file of the materials cannot be found', 'invalid-corners': 'corners that name vertices that are not there get the last one',
  'missing-images': 'pictures that cannot be found are left out', 'unsupported-images': 'pictures that are neither PNG nor JPEG are left out',
  'converted-units': 'the unit is converted to metres', 'converted-axes': 'the model is turned to Y up', 'invalid-keys': 'keys that make no sense are left out',
  'invalid-normals': 'normals without a direction are made anew', 'decompressed': 'what was compressed is saved uncompressed',
  'trailing-bytes': 'bytes behind the end of the file are left out', 'unknown-extensions': 'extensions of the file that are not known are left as they are',
  'no-motion': 'the file has a skeleton only, and no motion', 'cut-frame': 'the last frame is cut off, and left out',
  'other-textures': 'textures of what is neither colour nor normals nor emission are left out', 'vrm-pose': 'a VRM rests in T-pose, and the pose of the model\u2019s joints is not kept',
  'vrm-meta': 'authors and permissions are to be filled in', 'lost-textures': 'pictures of metalness, roughness and occlusion are left out',
  'colored-textures': 'a colour that a picture is multiplied by is lost in most programs', 'renamed-nodes': 'nodes of a name that was taken have a number behind it',
  'kept-axes': 'joints keep axes that meshes, extensions or uneven scales depend on', 'material-extensions': 'what some extensions say of materials is left out',
  'no-skeleton': 'there is no skeleton, so no joint gets the target\u2019s name, root or axes',
  'no-root-joint': 'the skeleton gets no root joint: nodes that its roots hang below move',
  'extrapolated-curves': 'curves that go on beyond their keys (cycles, slopes) stand still there',
  'removed-clips': 'clips that were removed are left out of the sequence',
  'second-root': 'the skeleton gets a root joint above its own',
  'pins-outside': 'joints were given positions far outside the surface',
  'unlikely-size': 'the body is hardly as small or as large as it is here: its unit of length may be another',
  'root-weights': 'vertices follow the root joint in part',
  'bad-weights': 'weights that are no numbers, or negative, count as none',
  'unweighted-vertices': 'vertices follow no joint',
  'vrma-lengths': 'bones that grow or move along are not kept',
  'decimal-commas': 'numbers have a comma for the point', 'turned-upright': 'the model lay down, and was turned upright',
  'short-transitions': 'a motion is too short for its transition, which takes less time', 'unlike-rates': 'motions that are blended differ much in speed, and the slower one is played too fast',
};
type Warning = SessionState['warnings'][number];
/** In English the engine's own sentence, which knows the figures. */
export function warningText({ kind, message }: Pick<Warning, 'kind' | 'message'>): string {
  const known = warnings[kind];
  return known && language !== 'en' ? say(known) : message;
}

/** What a user of the page meets in ordinary work: what went wrong, and what to do; of a file also in which. */
const kinds: Readonly<Record<ErrorKind, { title: Words; remedy?: Words; ofFile?: true }>> = {
  'nothing-to-undo': { title: 'there is nothing to undo' },
  'nothing-to-redo': { title: 'there is nothing to do again' },
  'joint-dragged': { title: 'a joint is being dragged', remedy: 'let go of it first' },
  'no-model': { title: 'no model is open', remedy: 'open a model first' },
  'no-clip': { title: 'no clip is chosen', remedy: 'choose or make a clip first' },
  'name-missing': { title: 'a name is missing' },
  'name-taken': { title: 'something else is called {name} already', remedy: 'choose another name' },
  'only-root': { title: '{joint} is the root of the rig, which cannot be deleted' },
  'joint-below-itself': { title: '{joint} cannot hang on {parent}, which hangs on it' },
  'last-member': { title: 'the last model of a scene cannot be taken out' },
  'holds-itself': { title: '{name} would hold itself', remedy: 'attach it to another model' },
  'model-not-mirrored': { title: 'the model is not its own mirror image' },
  'nothing-mirrored': { title: 'neither the model nor its skeleton is its own mirror image' },
  'joint-locked': { title: 'the weights of {joint} are locked', remedy: 'unlock the joint first' },
  'pin-outside': { title: '{joint} cannot go so far outside the model' },
  'handle-count': { title: '{count} handles are asked for', remedy: 'this model can have 1 to {most}' },
  'too-many-joints': { title: 'a rig of {count} joints is too large', remedy: 'a model can have at most {most}' },
  'key-before-clip': { title: 'the key at {seconds} s would come before the clip begins' },
  'no-motion': { title: 'nothing moves in {name}', remedy: 'choose a file with a motion' },
  'motion-too-long': { title: 'the motion {name} is too long', remedy: 'cut it into shorter ones' },
  'unlike-bodies': {
    title: 'the motion\u2019s skeleton of {source} joints and the model\u2019s of {target} have too little in common',
    remedy: 'choose a motion of a body that is built like this one',
  },
  'nothing-matched': { title: 'no joint of the motion moves a joint of the model', remedy: 'match some joints' },
  'match-without-joint': { title: '{part} has no joint on one side' },
  'matched-twice': { title: '{part} is matched twice' },
  'joint-matched-twice': { title: '{joint} cannot be the {part}: another part has it', remedy: 'give the other part another joint first' },
  'too-few-matched': {
    title: 'the matched joints do not tell how large the bodies are',
    remedy: 'match parts that lie farther apart, such as hips, head and feet',
  },
  'unlike-pose': { title: 'the pose {name} was made for another kind of body', remedy: 'choose one of a body that is built like this one' },
  'unfit-pose': { title: 'the pose {name} does not fit this skeleton' },
  'no-pose-file': { title: 'this is no pose that limber knows', ofFile: true, remedy: 'poses are saved in the library of poses' },
  'no-limits-file': { title: 'these are no limits of joints that limber knows' },
  'limits-of-other': {
    title: 'the model has no joint {joint}, for which there is a limit',
    remedy: 'choose limits that were made for this skeleton',
  },
  'empty-file': { title: 'the file is empty', ofFile: true },
  'cut-file': { title: 'the file is cut off', ofFile: true, remedy: 'copy or download it again' },
  'no-glb': { title: 'this is no GLB', ofFile: true, remedy: 'export the model again' },
  'unknown-format': { title: 'limber cannot read this format', ofFile: true, remedy: 'convert it to GLB or glTF' },
  'no-surface': { title: 'there is nothing to rig: the model has no surface', ofFile: true, remedy: 'limber needs triangles, not points or lines' },
  'out-of-memory': { title: 'not enough memory', ofFile: true, remedy: 'try a smaller model' },
  'no-bvh-name': { title: 'the name of {joint} cannot stand in a BVH file', remedy: 'give the joint another name' },
  'no-rig': { title: 'the model has no rig that could be taken', ofFile: true, remedy: 'choose one that has joints and weights' },
  'no-limbs': { title: 'no limbs can be told in this model', remedy: 'give it a rig first, whose joints then tell where they are' },
  'unlike-rigs': {
    title: 'the rig of {source} joints is for another kind of body',
    remedy: 'choose a model that is built like this one',
  },
  'no-animation': { title: 'nothing moves in the file of this model' },
};
/** What went wrong with all others, whose own sentence is English. */
const leads: Named = {
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

/** The engine names parts of bodies by their names. */
const sayValues = (values: Values): Values =>
  Object.fromEntries(Object.entries(values).map(([name, value]) => [name, name === 'part' ? partName(String(value)) : value]));

/** An error for people. Those of the page itself (code "page") are in their language already. */
export function told({ code, kind, values = {}, message, where, remedy }: LimberError): ToldError {
  if (kind) {
    const { title, remedy: help, ofFile } = kinds[kind], said = sayValues(values);
    return { title: capital(say(title, said)), detail: joined(ofFile ? where : '', help ? say(help, said) : ''), inEnglish: false };
  }
  if (code === 'page') return { title: capital(message), detail: joined(where, remedy), inEnglish: false };
  if (code === 'file') return { title: say('The file cannot be read'), detail: joined(where, message, remedy), inEnglish: language !== 'en' };
  if (language === 'en') return { title: capital(message), detail: joined(where, remedy), inEnglish: false };
  return { title: say(leads[code] ?? 'Something went wrong in the engine'), detail: joined(where, message, remedy), inEnglish: true };
}
