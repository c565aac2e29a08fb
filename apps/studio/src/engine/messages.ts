// What the page and the worker that holds the engine say to each other.
import type {
  Command, Crowd, Deformation, ErrorKind, ExportFormat, LimberError, Measures, MethodKind, Methods, PickHit, Placement, Ray, RigCheck, SceneMember,
  SessionState, SurfaceHit, SurfaceModel, SurfaceParts, Tangent, WeightArrays,
} from '@engine/limber.mjs';

export type {
  Command, Crowd, Deformation, ErrorKind, ExportFormat, LimberError, Measures, MethodKind, Methods, PickHit, Placement, Ray, RigCheck, SceneMember,
  SessionState, SurfaceHit, SurfaceModel, SurfaceParts, Tangent, WeightArrays,
};
export type Vector = [number, number, number];

/** Weights, and how the surface bends by them; without that as it did before. */
export type PaintedWeights = WeightArrays & { deformation?: Deformation };

/** The joints as they stand: 16 numbers each to move the surface, and x, y, z, radius each to draw handles. */
export interface Stance {
  skin: Float32Array;
  /** The surface itself, positions, then normals, where the engine bends it; else empty. So are those below. */
  posed: Float32Array;
  handles: Float32Array;
  /** 7 numbers each: the turn from the rest pose in degrees about x, y and z, as set_turn takes it; the rotation in the
   *  world as x, y, z, w. */
  turns: Float32Array;
  /** How many times as large each is as in its rest pose, as set_scale takes it. */
  scales: Float32Array;
  /** Joints that hold on to a place: feet where they stand. */
  pinned: number[];
  /** x, y, z of each joint that the chosen clip's motion was made for; empty where it was made here. */
  source: Float32Array;
  /** What moves the model that the chosen clip's motion came with; empty where it came with none. */
  sourceSkin: Float32Array;
  /** The same moment by the methods that are compared. */
  variants: { skin: Float32Array; posed: Float32Array; handles: Float32Array }[];
  /** 16 numbers for each member of the scene: its own space in that of the scene; empty where there is one alone. */
  places: Float32Array;
  /** What moves the surfaces of the members that are not chosen, by their place in the scene, where they have moved. */
  others: { member: number; skin: Float32Array; posed: Float32Array }[];
}

/** The surface of a member that is not chosen, and what moves it. */
export interface OtherMember {
  member: number;
  model: SurfaceModel;
  joints: number;
}

/** The document as another method has it. */
export interface Variant {
  model: SurfaceModel;
  state: SessionState;
  measures: Measures;
}

/** How the document stands after a step; with the surface where the rig is another. */
export interface Step {
  /** null after a drag's update and a clip's moment, which change the stance alone. */
  state: SessionState | null;
  stance: Stance;
  model: SurfaceModel | null;
  /** Where they alone have changed. */
  weights: PaintedWeights | null;
  /** All members of the scene but the chosen one, where there are others than before. */
  others: OtherMember[] | null;
}

/** The joints of the chosen clip at even moments: x, y, z of each, moment after moment. */
export interface Paths {
  moments: number[];
  places: Float32Array;
}

/** One joint of the chosen clip at even moments and at its keys, from its rest pose: a turn about x, y and z in degrees,
 *  an offset in metres. */
export interface Curve {
  joint: number;
  moments: number[];
  values: Float32Array;
  /** What it changes by in a second at its keys, where they are cubic and can be edited. */
  tangents: Tangent[];
}

export type ModelFormat = 'glb' | 'gltf' | 'fbx' | 'vrm' | 'usdz' | 'usda' | 'usdc';

/** `clip`: of formats that hold one; empty: none. */
export interface SaveAs { format: ModelFormat; target: string; clip: string }

/** Formats of several files as a ZIP archive of them; the warnings say what is not in it. */
export interface SavedModel { bytes: Uint8Array; warnings: SessionState['warnings'] }

/** A motion on its way to the model: from a file, or one that the engine makes. */
export type MotionRequest =
  | { kind: 'motion'; bytes: Uint8Array; name: string; retarget?: boolean }
  | { kind: 'run'; command: { do: 'add_sample_motion'; name: string; retarget?: boolean } };

/** Whether a motion or a pose could be put on the model with a named skeleton's rig, tried beside the document. */
export interface Trial {
  /** Why it could not. */
  error: LimberError | null;
  /** Of the rig that it would be put on. */
  joints: number;
  warnings: SessionState['warnings'];
}

/** A motion that the engine makes itself; the seconds are those of one repetition. */
export interface SampleMotion {
  name: string;
  summary: string;
  seconds: number;
}

/** A pose that the engine makes itself; `pose` is the text of its file. */
export interface SamplePose {
  name: string;
  summary: string;
  pose: string;
}

/** How a motion would look on the model, or a pose, which is one frame; tried beside the document. */
export interface MotionPreview {
  /** Why it cannot be put on the model; there are no frames then. */
  error: LimberError | null;
  /** Whether it is shown with a named skeleton's rig (PreviewRig), as the document's own joints have no names. */
  named: boolean;
  /** Of all frames. */
  seconds: number;
  /** At even moments, from the first on: what moves the surface, 16 numbers for each joint, and the joints' middle. */
  frames: { skin: Float32Array; middle: Vector }[];
}

/** The model with the named skeleton that previews were made with. */
export interface PreviewRig {
  model: SurfaceModel;
  joints: number;
}

export type Request =
  | { kind: 'open'; bytes: Uint8Array; name: string; limbsFollow?: boolean }
  /** Another model beside those that are there; as a prop without joints of its own. */
  | { kind: 'add'; bytes: Uint8Array; name: string; limbsFollow: boolean; asProp: boolean }
  /** Fails where the file is cut off. */
  | { kind: 'check-ply'; bytes: Uint8Array; name: string }
  | { kind: 'crowd'; bytes: Uint8Array; name: string }
  /** Put on the model as well, or not added, where `retarget` says so. */
  | { kind: 'motion'; bytes: Uint8Array; name: string; retarget?: boolean }
  /** The rig of the model in the file, on the model. */
  | { kind: 'transfer'; bytes: Uint8Array; name: string }
  /** A motion that comes live: its skeleton as text, then seven numbers for each of its joints, frame by frame. */
  | { kind: 'live-begin'; skeleton: string }
  | { kind: 'live-frame'; pose: Float32Array; seconds: number }
  | { kind: 'live-end' }
  /** What has come of it, as a BVH. */
  | { kind: 'live-recorded' }
  | { kind: 'run'; command: Command }
  | { kind: 'try-motion'; motion: MotionRequest }
  | { kind: 'sample-motions' }
  /** As much of the motion as that, in as many frames a second; changes nothing. */
  | { kind: 'preview-motion'; motion: MotionRequest; most: number; rate: number }
  | { kind: 'preview-rig' }
  /** What moves the surface at other moments of the chosen clip, in seconds; not while a joint is dragged. */
  | { kind: 'preview-moments'; moments: number[] }
  /** The pose that is shown, as the text of a file; poses of the chosen clip at other moments. */
  | { kind: 'pose'; name: string }
  | { kind: 'poses-at'; moments: number[] }
  | { kind: 'sample-poses' }
  /** As try-motion and preview-motion. */
  | { kind: 'try-pose'; pose: string }
  | { kind: 'preview-pose'; pose: string }
  /** A new document, by all that was asked for to make it. */
  | { kind: 'restore'; requests: Request[] }
  | { kind: 'pick'; ray: Ray; slope: number }
  /** The member whose surface is met first. */
  | { kind: 'pick-member'; ray: Ray }
  /** Where each of them meets the surface. */
  | { kind: 'surface'; rays: Ray[] }
  /** What the weights would be after a stroke of the brush; null: what they are. */
  | { kind: 'preview'; stroke: Command | null }
  /** The limbs as the weights have them. */
  | { kind: 'parts' }
  /** Whether the model can be rigged with a named skeleton. */
  | { kind: 'rig-check' }
  /** The model that the chosen clip's motion came with. */
  | { kind: 'source-model' }
  | { kind: 'paths' }
  | { kind: 'curve'; joint: number }
  | { kind: 'methods' }
  /** Beside the document one more for each command, carried out on it; none: the document alone. */
  /** For each of the others what makes it, in order. */
  | { kind: 'compare'; commands: Command[][] }
  | { kind: 'export'; format: ExportFormat }
  /** The names of the programs that models are saved for; the model for one of them, with the named clip where the format
   *  holds one. */
  | { kind: 'targets' }
  | { kind: 'save'; as: SaveAs }
  | { kind: 'record' };

/** The answer to each kind of request. */
export interface Answers {
  'live-begin': null;
  'live-frame': Stance;
  'live-end': Stance;
  'live-recorded': Uint8Array;
  open: Step;
  add: Step;
  'check-ply': void;
  crowd: Crowd;
  motion: Step;
  transfer: Step;
  run: Step;
  'try-motion': Trial;
  'sample-motions': SampleMotion[];
  'preview-motion': MotionPreview;
  'preview-rig': PreviewRig | null;
  'preview-moments': Float32Array[];
  pose: string;
  'poses-at': string[];
  'sample-poses': SamplePose[];
  'try-pose': Trial;
  'preview-pose': MotionPreview;
  /** null where nothing could be opened; how many of the requests failed, and the first error. */
  restore: { step: Step | null; failed: number; error: LimberError | null };
  pick: PickHit | null;
  'pick-member': { member: number; joint: number } | null;
  surface: (SurfaceHit | null)[];
  preview: WeightArrays;
  parts: SurfaceParts;
  'rig-check': RigCheck;
  'source-model': { motion: string; model: SurfaceModel; joints: number } | null;
  paths: Paths;
  curve: Curve;
  methods: Methods;
  /** What the document itself measures, each variant or why there is none, and how all stand. */
  compare: { measures: Measures; variants: (Variant | LimberError)[]; stance: Stance };
  export: Uint8Array;
  targets: string[];
  save: SavedModel;
  record: string;
}

/** How a request goes with those before it: a document begins, one more, or a newer frame in place of the last. */
export type Place = 'begins' | 'follows' | 'replaces';

/** Whether a command begins another document. */
export const opensModel = (command: Command) => command.do.startsWith('open_');

/** Whether a motion or a pose was refused for want of names, which a skeleton would bring. */
export const canBeNamed = (error: LimberError | null, state: SessionState | null) =>
  error?.code === 'unsupported' && state !== null && !state.own_rig && state.rigger !== 'template';

export type Kind = Request['kind'];
export type Answer<K extends Kind> = Answers[K];

export type ToWorker = { id: number; request: Request };
export type FromWorker =
  | { kind: 'ready' }
  /** The engine did not come: what the host answered, null where nobody did; or it came and does not run here. */
  | { kind: 'broken'; missing: true; status: number | null }
  | { kind: 'broken'; missing: false; why: string }
  | { kind: 'progress'; stage: string; fraction: number }
  | { kind: 'done'; id: number; answer: Answers[Kind] }
  | { kind: 'failed'; id: number; error: LimberError }
  /** A part of the engine that it needed did not come; status: what the host answered. */
  | { kind: 'cut-short'; id: number; status: number | null };
