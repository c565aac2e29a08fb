// Holds the engine and one scene, away from the page's own thread.
import { loadLimber, type Codecs } from '@engine/limber.mjs';
import firstUrl from '@engine/limber_engine_first.wasm.zst?url';
import restUrl from '@engine/limber_engine_rest.wasm.zst?url';
import shapesUrl from '@shapes/shapes.lrd?url';
import { decompress, Decompress } from 'fzstd';
import { Documents, EngineFailure } from './documents';
import { bringCodecs } from './codecs';
import type { Answers, FromWorker, Kind, Request, ToWorker } from './messages';

const say = (message: FromWorker) => postMessage(message);

function answer(documents: Documents, request: Request): Answers[Kind] {
  switch (request.kind) {
    case 'open': return documents.open(request.bytes, request.name, request.limbsFollow);
    case 'add': return documents.add(request);
    case 'crowd': return documents.crowd(request.bytes, request.name);
    case 'check-ply': return documents.checkPly(request.bytes, request.name);
    case 'motion': return documents.addMotion(request);
    case 'transfer': return documents.transfer(request);
    case 'run': return documents.run(request.command);
    case 'live-begin': return documents.liveBegin(request.skeleton);
    case 'live-frame': return documents.liveFrame(request.pose, request.seconds);
    case 'live-end': return documents.liveEnd();
    case 'live-recorded': return documents.liveRecorded();
    case 'pick': return documents.pick(request.ray, request.slope);
    case 'pick-member': return documents.pickMember(request.ray);
    case 'surface': return documents.surface(request.rays);
    case 'preview': return documents.preview(request.stroke);
    case 'parts': return documents.parts();
    case 'rig-check': return documents.rigCheck();
    case 'try-motion': return documents.tryMotion(request.motion);
    case 'sample-motions': return documents.sampleMotions();
    case 'preview-motion': return documents.previewMotion(request.motion, request.most, request.rate);
    case 'preview-moments': return documents.previewMoments(request.moments);
    case 'preview-rig': return documents.previewRig();
    case 'pose': return documents.pose(request.name);
    case 'poses-at': return documents.posesAt(request.moments);
    case 'sample-poses': return documents.samplePoses();
    case 'try-pose': return documents.tryPose(request.pose);
    case 'preview-pose': return documents.previewPose(request.pose);
    case 'restore': return documents.restore(request.requests);
    case 'source-model': return documents.sourceModel();
    case 'paths': return documents.paths();
    case 'curve': return documents.curve(request.joint);
    case 'methods': return documents.methods();
    case 'compare': return documents.compare(request.commands);
    case 'export': return documents.export(request.format);
    case 'targets': return documents.targets();
    case 'save': return documents.save(request.as);
    case 'record': return documents.record();
  }
}

const zstandard = [0x28, 0xb5, 0x2f, 0xfd]; // how a packed file begins (RFC 8878)

const isPacked = (bytes: Uint8Array) => zstandard.every((byte, i) => bytes[i] === byte);

/** Unpacks what is packed; a host that says how it is packed has it unpacked by the browser already. */
function unpacking(): TransformStream<Uint8Array, Uint8Array> {
  let unpack: Decompress | null = null, begun = false;
  return new TransformStream({
    transform(chunk, out) {
      if (!begun && isPacked(chunk)) unpack = new Decompress((part) => out.enqueue(part));
      begun = true;
      if (unpack) unpack.push(chunk);
      else out.enqueue(chunk);
    },
    flush() { unpack?.push(new Uint8Array(), true); },
  });
}

function unpacked(file: ArrayBuffer): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(file);
  return isPacked(bytes) ? decompress(bytes) as Uint8Array<ArrayBuffer> : bytes;
}

/** A part of the engine did not come: what the host answered, null where nobody did. */
class Missing extends Error {
  constructor(readonly status: number | null) { super(); }
}

/** A part of the engine, unpacked and compiled while it comes. */
async function enginePart(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url).catch(() => null);
  if (!response?.ok || !response.body) throw new Missing(response?.status ?? null);
  const unpacked = response.body.pipeThrough<Uint8Array>(unpacking() as ReadableWritablePair<Uint8Array, Uint8Array<ArrayBuffer>>);
  return WebAssembly.compileStreaming(new Response(unpacked as ReadableStream<Uint8Array<ArrayBuffer>>, { headers: { 'content-type': 'application/wasm' } }));
}

/** Does not return before it is there: the engine cannot wait in the middle of a call. */
function fetchNow(url: string): Uint8Array<ArrayBuffer> {
  const request = new XMLHttpRequest();
  request.open('GET', url, false);
  request.responseType = 'arraybuffer';
  try {
    request.send();
  } catch {
    throw new Missing(null);
  }
  if (request.status !== 200) throw new Missing(request.status);
  return unpacked(request.response as ArrayBuffer);
}

/** What the first pose needs nothing of: it comes when the first request has been answered, or at once where one needs it. */
class RestOfEngine {
  private module: WebAssembly.Module | null = null;
  private asked = false;

  fetch(): void {
    if (this.asked) return;
    this.asked = true;
    enginePart(restUrl).then((module) => { this.module ??= module; }, () => { /* asked for again when it is needed */ });
  }

  needed(): WebAssembly.Module {
    return this.module ??= new WebAssembly.Module(fetchNow(restUrl));
  }
}

/** The networks that read shapes: they come when a call needs them, or beside other work where it can wait for them. */
class Shapes {
  private bytes: Uint8Array | null = null;
  private given = false;

  async fetch(): Promise<void> {
    if (this.bytes || this.given) return;
    const response = await fetch(shapesUrl).catch(() => null), file = response?.ok ? await response.arrayBuffer().catch(() => null) : null;
    if (!file) throw new Missing(response?.ok ? null : response?.status ?? null);
    this.bytes = unpacked(file);
  }

  needed(): Uint8Array {
    const bytes = this.bytes ?? fetchNow(shapesUrl);
    [this.bytes, this.given] = [null, true];
    return bytes;
  }
}
const shapes = new Shapes();

/** The files that a request brings. */
function filesIn(request: Request): Uint8Array[] {
  switch (request.kind) {
    case 'open': case 'add': case 'motion': case 'transfer': case 'crowd': return [request.bytes];
    case 'try-motion': case 'preview-motion': return request.motion.kind === 'motion' ? [request.motion.bytes] : [];
    case 'restore': return request.requests.flatMap(filesIn);
    default: return [];
  }
}

async function start() {
  const codecs: Codecs = {}, rest = new RestOfEngine();
  const limber = await loadLimber(await enginePart(firstUrl), {
    codecs, rest: () => rest.needed(), shapeWeights: () => shapes.needed(), onProgress: (stage, fraction) => say({ kind: 'progress', stage, fraction }),
  });
  const documents = new Documents(limber);
  say({ kind: 'ready' });
  return async ({ id, request }: ToWorker) => {
    try {
      for (const file of filesIn(request)) await bringCodecs(codecs, file);
      say({ kind: 'done', id, answer: answer(documents, request) });
      rest.fetch();
    } catch (error) {
      if (error instanceof Missing) return say({ kind: 'cut-short', id, status: error.status });
      const failure = error instanceof EngineFailure
        ? error.failure.error
        : { code: 'engine', message: String(error instanceof Error ? error.message : error), where: '', remedy: 'reload the page' };
      say({ kind: 'failed', id, error: failure });
    }
  };
}

const started = start();
// One after the other, also where the engine or a decoder is on its way.
let before: Promise<unknown> = started.catch((error: unknown) =>
  say({ kind: 'broken', ...error instanceof Missing ? { missing: true, status: error.status } : { missing: false, why: String(error) } }));
const enqueue = (message: ToWorker) => {
  before = before.then(async () => (await started)(message)).catch(() => { /* there is no engine, which was told */ });
};
onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.request.kind !== 'rig-check') return enqueue(data);
  // Whatever is asked meanwhile goes first.
  shapes.fetch().then(() => enqueue(data), (error: unknown) =>
    say({ kind: 'cut-short', id: data.id, status: error instanceof Missing ? error.status : null }));
};
