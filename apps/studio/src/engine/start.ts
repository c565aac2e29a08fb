// The worker that holds the engine is started, and asked for what the page will most likely want first, before the page's own
// code is there: all of it comes at once.
import type { FromWorker, Request, ToWorker } from './messages';

export const newWorker = () => new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });

export const earlyId = -1; // of what is asked before there is anybody to number it

export interface StartedWorker {
  worker: Worker;
  /** What it was asked already, by earlyId. */
  asked: Request | null;
}

let early: StartedWorker | null = null;
let heard: MessageEvent<FromWorker>[] = [];
let failure: ErrorEvent | null = null;

export function startEarly(first: Request | null) {
  const { worker } = early = { worker: newWorker(), asked: first };
  worker.onmessage = (event: MessageEvent<FromWorker>) => { heard.push(event); };
  worker.onerror = (event) => { failure = event; };
  if (first) worker.postMessage({ id: earlyId, request: first } satisfies ToWorker);
}

/** The one that was started early, the first time; what it has said is said again to whoever listens then. */
export function takeWorker(listen: (started: StartedWorker) => void): Worker {
  const started = early ?? { worker: newWorker(), asked: null }, said = heard, failed = failure;
  early = failure = null;
  heard = [];
  listen(started);
  said.forEach((event) => started.worker.onmessage?.(event));
  if (failed) started.worker.onerror?.(failed);
  return started.worker;
}
