// The worker that holds the engine is started before the page's own code is there: both are loaded at once.
export const newWorker = () => new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });

let early: Worker | null = null;
let heard: MessageEvent[] = [];
let failure: ErrorEvent | null = null;

export function startEarly() {
  early = newWorker();
  early.onmessage = (event: MessageEvent) => { heard.push(event); };
  early.onerror = (event) => { failure = event; };
}

/** The one that was started early, the first time; what it has said is said again to whoever listens then. */
export function takeWorker(listen: (worker: Worker) => void): Worker {
  const worker = early ?? newWorker(), said = heard, failed = failure;
  early = failure = null;
  heard = [];
  listen(worker);
  said.forEach((event) => worker.onmessage?.(event));
  if (failed) worker.onerror?.(failed);
  return worker;
}
