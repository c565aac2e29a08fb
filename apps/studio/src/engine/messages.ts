// What the page and the worker that holds the engine say to each other.
import type {
  Command, ExportFormat, LimberError, Measures, MethodKind, Methods, PickHit, Ray, SessionState, SurfaceModel,
} from '@engine/limber.mjs';

export type {
  Command, ExportFormat, LimberError, Measures, MethodKind, Methods, PickHit, Ray, SessionState, SurfaceModel,
};
export type Vector = [number, number, number];

/** The joints as they stand: 16 numbers each to move the surface, and x, y, z, radius each to draw handles. */
export interface Stance {
  skin: Float32Array;
  handles: Float32Array;
  /** x, y, z of each joint that the chosen clip's motion was made for; empty where it was made here. */
  source: Float32Array;
  /** What moves the model that the chosen clip's motion came with; empty where it came with none. */
  sourceSkin: Float32Array;
  /** The same moment by the methods that are compared. */
  variants: { skin: Float32Array; handles: Float32Array }[];
}

/** The document as another method has it. */
export interface Variant {
  model: SurfaceModel;
  state: SessionState;
  measures: Measures;
}

export type Request =
  | { kind: 'open'; bytes: Uint8Array; name: string }
  /** Fails where the file is cut off. */
  | { kind: 'check-ply'; bytes: Uint8Array; name: string }
  | { kind: 'motion'; bytes: Uint8Array; name: string }
  | { kind: 'run'; command: Command }
  | { kind: 'pick'; ray: Ray; slope: number }
  | { kind: 'model' }
  /** The model that the chosen clip's motion came with. */
  | { kind: 'source-model' }
  | { kind: 'methods' }
  /** Beside the document one more for each command, carried out on it; none: the document alone. */
  | { kind: 'compare'; commands: Command[] }
  | { kind: 'export'; format: ExportFormat }
  | { kind: 'record' };

/** The answer to each kind of request. */
export interface Answers {
  open: { state: SessionState; stance: Stance };
  'check-ply': void;
  motion: { state: SessionState; stance: Stance };
  /** state is null after a drag's update and a clip's moment, which change the stance alone. */
  run: { state: SessionState | null; stance: Stance };
  pick: PickHit | null;
  model: SurfaceModel;
  'source-model': { motion: string; model: SurfaceModel; joints: number } | null;
  methods: Methods;
  /** What the document itself measures, each variant or why there is none, and how all stand. */
  compare: { measures: Measures; variants: (Variant | LimberError)[]; stance: Stance };
  export: Uint8Array;
  record: string;
}

export type Kind = Request['kind'];
export type Answer<K extends Kind> = Answers[K];

export type ToWorker = { id: number; request: Request };
export type FromWorker =
  | { kind: 'ready' }
  | { kind: 'broken'; message: string }
  | { kind: 'progress'; stage: string; fraction: number }
  | { kind: 'done'; id: number; answer: Answers[Kind] }
  | { kind: 'failed'; id: number; error: LimberError };
