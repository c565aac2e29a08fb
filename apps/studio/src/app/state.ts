// What the page shows, in one place.
import type { ReportRow } from './report_rows';
import type {
  Curve, LimberError, Measures, MethodKind, Methods, OtherMember, Paths, SampleMotion, SamplePose, SessionState, SurfaceModel, SurfaceParts,
  Variant,
} from '../engine/messages';
import { told } from '../words/engine';
import type { KeptPose } from './pose_store';
import { Store } from './store';

export type DragMode = 'move' | 'turn' | 'scale';
/** Whose axes arrows and rings have. */
export type GizmoSpace = 'world' | 'parent' | 'local' | 'view';
export type Display = 'handles' | 'surface' | 'weights' | 'joint-weights' | 'parts' | 'stretch';
/** There are handles to drag. */
export const hasHandles = (display: Display) => display === 'handles' || display === 'stretch';

export type PaintMode = 'add' | 'subtract' | 'smooth';

export interface BrushSettings {
  mode: PaintMode;
  /** Its radius, of the model's longest side. */
  size: number;
  /** 0 to 1. */
  strength: number;
}

export interface Notice {
  kind: 'error' | 'note';
  title: string;
  detail: string;
  /** The detail is the engine's own, whatever the page's language is. */
  inEnglish?: boolean;
  /** Brings back what it tells of. */
  undo?: () => Promise<void>;
}

/** The document beside what other methods make of it. */
export interface Comparison {
  /** "report": with rows of a study's report. */
  kind: MethodKind | 'report';
  /** Of the others, in their order; of rows, what PageState.report calls them. */
  names: string[];
  /** What came of each; empty while they are being made. */
  variants: (Variant | LimberError)[];
  measures: Measures | null;
}

/** A key of a joint of the chosen clip. */
export interface KeyPlace {
  joint: number;
  seconds: number;
}

/** The character at another moment: -1 is the one before the moment that is shown, 1 the one after it. */
export interface Ghost {
  order: number;
  /** What moves the surface, 16 numbers for each joint. */
  skin: Float32Array;
}

/** What opens below the timeline. */
export type KeyEditor = 'sheet' | 'curves';

/** The models of a scene, in a real place. */
export interface ArState {
  /** WebXR; a printed card before the camera; the camera with the device's turns alone. */
  sight: 'webxr' | 'card' | 'camera';
  /** Where the chosen model goes is being looked for, or it has its place. */
  step: 'placing' | 'placed';
  /** Whether a surface is met, where the chosen model may stand. */
  surface: boolean;
  /** What keeps it from going on. */
  trouble: 'no-surface' | 'lost' | 'hidden' | 'hand' | null;
  /** The chosen model has its real size. */
  realSize: boolean;
  /** It was placed larger than what is looked through, and has been since. */
  large: boolean;
}

export interface PageState {
  session: SessionState | null;
  model: SurfaceModel | null;
  /** The other members of the scene. */
  others: readonly OtherMember[];
  /** A model that is pressed goes over the floor with the pointer. */
  arranging: boolean;
  mode: DragMode;
  display: Display;
  /** Of the model and the weights that are shown; null until they are asked for. */
  parts: SurfaceParts | null;
  bones: boolean;
  wireframe: boolean;
  selected: number | null;
  /** Joints that are selected besides, and dragged along. */
  also: ReadonlySet<number>;
  /** What is dragged or painted on one side is done on the other as well. */
  bothSides: boolean;
  hovered: number | null;
  /** Joints that hold on to a place: those that the user pinned, and feet while they stand. */
  pinned: readonly number[];
  /** The view was turned since the page was opened. */
  looked: boolean;
  /** A stage with how far it is; null when nothing takes long. */
  work: { stage: string; fraction: number } | null;
  notice: Notice | null;
  help: boolean;
  /** The moment of the chosen clip that is shown, in seconds. */
  seconds: number;
  playing: boolean;
  speed: number;
  loop: boolean;
  /** What is posed while a clip is shown becomes a key of it at once. */
  autoKey: boolean;
  /** Seconds over which a correction of recorded motion comes and goes. */
  span: number;
  keyEditor: KeyEditor | null;
  /** Whether the rows of feet that stand are shown. */
  feet: boolean;
  /** Whether the rows of clips that follow each other are shown. */
  sequence: boolean;
  chosenKeys: readonly KeyPlace[];
  /** The character before and after the moment that is shown, and the selected joint's path. */
  ghosts: boolean;
  ghostsShown: readonly Ghost[];
  /** Of the chosen clip, for the selected joint's path; of the selected joint, for the curves. */
  paths: Paths | null;
  curve: Curve | null;
  gizmo: boolean;
  gizmoSpace: GizmoSpace;
  /** Places and turns go to round values, without Ctrl; with it, the other way round. */
  snapping: boolean;
  /** Taps add joints to those selected, drags draw a box round more. */
  selecting: boolean;
  limits: boolean;
  /** Moving a joint of a template corrects the rig; so does touching the model for the selected one. */
  correcting: boolean;
  /** The pointer paints weights of the selected joint. */
  painting: boolean;
  brush: BrushSettings;
  /** The next click on the model puts a new joint there, below the selected one. */
  placing: boolean;
  methods: Methods | null;
  sampleMotions: readonly SampleMotion[];
  /** Motions that the user brought several of at once. */
  ownMotions: readonly File[];
  /** Whether the shelf of motions is open. */
  shelf: boolean;
  samplePoses: readonly SamplePose[];
  /** The user's own, the newest first. */
  ownPoses: readonly KeptPose[];
  /** Whether the library of poses is open. */
  poseLibrary: boolean;
  /** The text of the pose that was copied. */
  copiedPose: string | null;
  comparison: Comparison | null;
  /** Rows of a study's report that the user opened, which the page can do as well or says why not. */
  report: readonly ReportRow[];
  /** Parts of the model that are not drawn, by their place in it. */
  hiddenParts: ReadonlySet<number>;
  /** The model that the chosen clip's motion came with. */
  sourceModel: { motion: string; model: SurfaceModel; joints: number } | null;
  sourceShown: boolean;
  /** null at the desk. */
  ar: ArState | null;
}

export type PageStore = Store<PageState>;

export const createPageStore = (): PageStore => new Store<PageState>({
  session: null, model: null, others: [], arranging: false, mode: 'move', display: 'handles', parts: null, bones: true, wireframe: false,
  selected: null, also: new Set(), bothSides: false, hovered: null, pinned: [], looked: false, work: null, notice: null, help: false,
  seconds: 0, playing: false, speed: 1, loop: true, autoKey: true, gizmo: false, gizmoSpace: 'world', snapping: false, selecting: false, limits: false, correcting: false,
  span: 0.3, keyEditor: null, feet: false, sequence: false, chosenKeys: [], ghosts: false, ghostsShown: [], paths: null, curve: null,
  painting: false, brush: { mode: 'add', size: 0.05, strength: 0.5 }, placing: false,
  methods: null, sampleMotions: [], ownMotions: [], shelf: false, samplePoses: [], ownPoses: [], poseLibrary: false, copiedPose: null, comparison: null, report: [], hiddenParts: new Set(), sourceModel: null, sourceShown: true, ar: null,
});

export const noticeOf = (error: LimberError): Notice => ({ kind: 'error', ...told(error) });
