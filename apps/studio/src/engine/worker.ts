// Holds the engine and one session, away from the page's own thread.
import { loadLimber } from '@engine/limber.mjs';
import wasmUrl from '@engine/limber_engine.wasm?url';
import { Documents, EngineFailure } from './documents';
import type { Answers, FromWorker, Kind, Request, ToWorker } from './messages';

const say = (message: FromWorker) => postMessage(message);

function answer(documents: Documents, request: Request): Answers[Kind] {
  switch (request.kind) {
    case 'open': return documents.open(request.bytes, request.name);
    case 'check-ply': return documents.checkPly(request.bytes, request.name);
    case 'motion': return documents.addMotion(request.bytes, request.name);
    case 'run': return documents.run(request.command);
    case 'pick': return documents.pick(request.ray, request.slope);
    case 'model': return documents.model();
    case 'source-model': return documents.sourceModel();
    case 'methods': return documents.methods();
    case 'compare': return documents.compare(request.commands);
    case 'export': return documents.export(request.format);
    case 'record': return documents.record();
  }
}

async function start() {
  const response = await fetch(wasmUrl);
  if (!response.ok) throw new Error(`the engine cannot be loaded (${response.status})`);
  const limber = await loadLimber(await response.arrayBuffer(), {
    onProgress: (stage, fraction) => say({ kind: 'progress', stage, fraction }),
  });
  const documents = new Documents(limber);
  onmessage = ({ data: { id, request } }: MessageEvent<ToWorker>) => {
    try {
      say({ kind: 'done', id, answer: answer(documents, request) });
    } catch (error) {
      const failure = error instanceof EngineFailure
        ? error.failure.error
        : { code: 'engine', message: String(error instanceof Error ? error.message : error), where: '', remedy: 'reload the page' };
      say({ kind: 'failed', id, error: failure });
    }
  };
  say({ kind: 'ready' });
}

start().catch((error: unknown) => say({ kind: 'broken', message: String(error) }));
