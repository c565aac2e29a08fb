// The page's side of the worker: promises, progress, and a way to stop what takes too long.
import { opensModel, type Answer, type Command, type FromWorker, type Kind, type LimberError, type Place, type Request, type ToWorker } from './messages';
import { earlyId, takeWorker } from './start';
import { say } from '../words/say';

export class EngineError extends Error {
  constructor(readonly error: LimberError) {
    super(error.message);
  }
  get cancelled() { return this.error.code === 'cancelled'; }
}

/** What the page itself refuses, in its own language. */
export const refusal = (message: string, where = '', remedy = '') => new EngineError({ code: 'page', message, where, remedy });

/** What a reader of other formats says, which speaks English. */
export const unreadable = (name: string, why: unknown) => new EngineError({
  code: 'file', message: why instanceof Error ? why.message : String(why), where: name, remedy: '',
});

const cancelled: LimberError = { code: 'cancelled', message: 'stopped', where: '', remedy: '' };

/** What was left in the middle of a drag stays as far as it went. */
function withDragEnded(requests: Request[]): Request[] {
  const ends = requests.findLastIndex((r) => r.kind === 'run' && (r.command.do === 'end_drag' || r.command.do === 'cancel_drag'));
  const begins = requests.findLastIndex((r) => r.kind === 'run' && r.command.do === 'begin_drag');
  return begins > ends ? [...requests, { kind: 'run', command: { do: 'end_drag' } }] : [...requests];
}

/** Why there is no engine, and what to do about it. */
function withoutEngine(broken: Extract<FromWorker, { kind: 'broken' }>): EngineError {
  if (!broken.missing) return refusal(say('this browser cannot run the studio'), broken.why, say('bring the browser up to date, or use another one'));
  return partMissing(broken.status);
}

/** A file of the page did not come: the server's answer, or null where there was none. */
export function partMissing(status: number | null): EngineError {
  const title = say('a part of the studio did not arrive'), kept = say('what you made before is kept');
  if (status === null) return refusal(title, say('look at your connection, and load the page again'), kept);
  return refusal(title, say('load the page again; if that does not help, tell whoever runs this site that a file is missing (answer {status})', { status: String(status) }), kept);
}

interface Waiting {
  request: Request;
  resolve(answer: unknown): void;
  reject(error: EngineError): void;
}

type Answered = Extract<FromWorker, { id: number }>;

const sameCommand = (a: Request, b: Request) => a.kind === 'run' && b.kind === 'run' && JSON.stringify(a.command) === JSON.stringify(b.command);

const changesDocument = ({ kind }: Request) => ['open', 'add', 'motion', 'transfer', 'run'].includes(kind);
/** What the next of its kind replaces. */
const frameOf = (request: Request) =>
  (request.kind === 'run' && ['update_drag', 'turn_drag', 'scale_drag', 'move_drag', 'set_time', 'set_clock', 'choose_member'].includes(request.command.do) ? request.command.do : null);
/** What is tried for a picture, what comes live and what is asked of a model that nobody waits for holds nobody up. */
const quiet = ({ kind }: Request) => kind.startsWith('preview') || kind.startsWith('live') || kind === 'rig-check';
const opens = (request: Request) => request.kind === 'open' || (request.kind === 'run' && opensModel(request.command));

export class EngineClient {
  onProgress: (stage: string, fraction: number) => void = () => {};
  onBusy: (busy: boolean) => void = () => {};
  /** The document has changed. */
  onChange: (request: Request, place: Place) => void = () => {};

  private worker: Worker;
  private ready: Promise<void>;
  private waiting = new Map<number, Waiting>();
  private nextId = 0;
  /** What the engine was asked before the page was there, until somebody asks for anything; its answer once that came. */
  private early: { request: Request; answer: Answered | null } | null = null;
  /** What was done since a model was opened, so that a new worker can be brought to the same state. */
  private history: Request[] = [];

  constructor() {
    [this.worker, this.ready] = this.startWorker();
  }

  async ask<K extends Kind>(request: Extract<Request, { kind: K }>): Promise<Answer<K>> {
    await this.ready;
    return this.send(request);
  }

  run(command: Command) { return this.ask({ kind: 'run', command }); }

  /** Something is being done to the document that is not a frame. */
  get changing() { return [...this.waiting.values()].some(({ request }) => changesDocument(request) && frameOf(request) === null); }

  /** All that made the document. */
  get requests(): Request[] { return [...this.history]; }

  /** A document that was made by these requests; what comes next follows them. */
  async restore(requests: Request[]): Promise<Answer<'restore'>> {
    const whole = withDragEnded(requests);
    const answer = await this.ask({ kind: 'restore', requests: whole });
    if (answer.step) this.history = whole;
    return answer;
  }

  /** Ends everything under way, and goes back to how the document was before it. */
  async cancel() {
    this.worker.terminate();
    const stopped = [...this.waiting.values()];
    this.waiting.clear();
    let brought: () => void = () => {};
    [this.worker, this.ready] = this.startWorker();
    const fresh = this.ready;
    // Whoever asks meanwhile waits until the document is back.
    this.ready = new Promise((resolve) => { brought = resolve; });
    await fresh;
    const whole = withDragEnded(this.history);
    await this.send<'restore'>({ kind: 'restore', requests: whole }).catch(() => {});
    whole.slice(this.history.length).forEach((request) => this.onChange(request, 'follows'));
    this.history = whole;
    brought();
    stopped.forEach(({ reject }) => reject(new EngineError(cancelled)));
    this.onBusy(false);
  }

  private send<K extends Kind>(request: Extract<Request, { kind: K }>): Promise<Answer<K>> {
    return new Promise((resolve, reject) => {
      const early = this.early && sameCommand(this.early.request, request) ? this.early : null, id = early ? earlyId : this.nextId++;
      this.early = null;
      this.waiting.set(id, { request, resolve: resolve as (answer: unknown) => void, reject });
      if (!quiet(request)) this.onBusy(true);
      if (!early) this.worker.postMessage({ id, request } satisfies ToWorker);
      else if (early.answer) this.receive(early.answer);
    });
  }

  private startWorker(): [Worker, Promise<void>] {
    let ready: () => void, broken: (why: EngineError) => void;
    const begun = new Promise<void>((resolve, reject) => { [ready, broken] = [resolve, reject]; });
    const worker = takeWorker(({ worker: started, asked }) => {
      this.early = asked && { request: asked, answer: null };
      started.onmessage = ({ data }: MessageEvent<FromWorker>) => {
        if (data.kind === 'ready') ready();
        else if (data.kind === 'broken') broken(withoutEngine(data));
        else this.receive(data);
      };
      // Without a message the worker's own code did not come.
      started.onerror = ({ message }) => broken(withoutEngine({ kind: 'broken', ...message ? { missing: false, why: message } : { missing: true, status: null } }));
    });
    return [worker, begun];
  }

  private receive(data: Exclude<FromWorker, { kind: 'ready' } | { kind: 'broken' }>) {
    if (data.kind === 'progress') return this.onProgress(data.stage, data.fraction);
    if (data.id === earlyId && this.early) this.early.answer = data;
    const waiting = this.waiting.get(data.id);
    if (!waiting) return;
    this.waiting.delete(data.id);
    if (![...this.waiting.values()].some(({ request }) => !quiet(request))) this.onBusy(false);
    if (data.kind === 'cut-short') return waiting.reject(partMissing(data.status));
    if (data.kind === 'failed') return waiting.reject(new EngineError(data.error));
    this.remember(waiting.request);
    waiting.resolve(data.answer);
  }

  private remember(request: Request) {
    if (!changesDocument(request)) return;
    if (opens(request)) this.history = [];
    const last = this.history.at(-1), replaces = last !== undefined && frameOf(request) !== null && frameOf(request) === frameOf(last);
    if (replaces) this.history.pop();
    this.history.push(request);
    this.onChange(request, opens(request) ? 'begins' : replaces ? 'replaces' : 'follows');
  }
}
