// Holds the engine and one session, away from the page's own thread.
import { loadLimber, type Failure, type Session } from '@engine/limber.mjs';
import wasmUrl from '@engine/limber_engine.wasm?url';
import type { Answers, FromWorker, Kind, Request, Stance, ToWorker } from './messages';

const say = (message: FromWorker) => postMessage(message);

/** An engine's error on its way to the page. */
class EngineFailure extends Error {
  constructor(readonly failure: Failure) {
    super(failure.error.message);
  }
}

function orThrow<T extends { ok: true }>(result: T | Failure): T {
  if (!result.ok) throw new EngineFailure(result);
  return result;
}

function stance(session: Session, skin: Float32Array): Stance {
  return { skin, handles: orThrow(session.handles()).handles, source: orThrow(session.sourceJoints()).places };
}

function answer(session: Session, request: Request): Answers[Kind] {
  switch (request.kind) {
    case 'open': {
      const { state, skin } = orThrow(session.open(request.bytes, request.name));
      return { state, stance: stance(session, skin) };
    }
    case 'motion': {
      const { state, skin } = orThrow(session.addMotion(request.bytes, request.name));
      return { state, stance: stance(session, skin) };
    }
    case 'run': {
      const { state, skin } = orThrow(session.run(request.command));
      return { state, stance: stance(session, skin) };
    }
    case 'pick': return orThrow(session.pick(request.ray, request.slope)).hit;
    case 'model': return orThrow(session.model()).model;
    case 'export': return orThrow(session.export(request.format)).bytes;
    case 'record': return JSON.stringify(session.record(), null, 1);
  }
}

async function start() {
  const response = await fetch(wasmUrl);
  if (!response.ok) throw new Error(`the engine cannot be loaded (${response.status})`);
  const limber = await loadLimber(await response.arrayBuffer(), {
    onProgress: (stage, fraction) => say({ kind: 'progress', stage, fraction }),
  });
  const session = limber.createSession();
  onmessage = ({ data: { id, request } }: MessageEvent<ToWorker>) => {
    try {
      say({ kind: 'done', id, answer: answer(session, request) });
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
