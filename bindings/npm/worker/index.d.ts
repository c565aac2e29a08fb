import type { Failure, Limber, LimberError, RigOptions, RigResult, Session } from '../limber.d.mts';

/** The same calls, answered later. */
type Later<Calls> = { [Name in keyof Calls]: Calls[Name] extends (...args: infer Args) => infer Answer ? (...args: Args) => Promise<Answer> : never };

/** A session in the worker. Once the worker was stopped, or the session freed, calls give a Failure (code 'cancelled' or
 *  'bad-argument'); record() and fork(), which have no such value, are rejected with a WorkerError, and free() does nothing. */
export interface WorkerSession extends Later<Omit<Session, 'handle'>> {
  /** Another session with the same document, to try something in; null during a drag. */
  fork(): Promise<WorkerSession | null>;
}

export interface RigCall {
  /** Stops the worker, as stop() does. */
  signal?: AbortSignal;
  /** How far it is: the fraction, 0 to 1, of the stage; at most 20 times a second. What it throws stops the worker, as stop()
   *  does, and the call is rejected with it. */
  onProgress?: (stage: string, fraction: number) => void;
}

/** The engine in a thread of its own. Files that it is given are copied. What cannot be done is a value, { ok: false, error }; calls
 *  that have no such value (methods, createSession, record, ...) are rejected with a WorkerError if the worker stops or breaks. */
export interface LimberWorker extends Later<Omit<Limber, 'rig' | 'createSession' | 'forkSession'>> {
  rig(file: Uint8Array, name: string, options?: RigOptions, call?: RigCall): Promise<RigResult>;
  createSession(): Promise<WorkerSession>;
  /** Ends the thread at once, whatever it does: calls that wait get a Failure, code 'cancelled', and its sessions are gone. The next
   *  call starts another. */
  stop(): void;
}

export class WorkerError extends Error {
  constructor(error: LimberError);
  readonly error: LimberError;
}

export type { Failure, LimberError, RigOptions, RigResult };

/** wasmBinary: as in load(). */
export function startWorker(options?: { wasmBinary?: BufferSource | WebAssembly.Module }): Promise<LimberWorker>;
