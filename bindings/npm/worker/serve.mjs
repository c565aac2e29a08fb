// The engine at the other end of client.mjs.
import { shapesReader } from '../engine_code.mjs';
import { loadLimber } from '../limber.mjs';

/** What can be handed over without a copy: answers are the engine's own no longer. */
function buffersIn(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) found.add(value.buffer);
  else if (value && typeof value === 'object') for (const part of Object.values(value)) buffersIn(part, found);
  return found;
}

const leastPause = 50; // milliseconds between two words of progress

/** A session that is no more was asked. */
class Freed extends Error {}

const errorOf = (error, method) => (error instanceof Freed
  ? { code: 'bad-argument', message: 'the session was freed', where: method, remedy: 'make another by createSession' }
  : { code: 'worker', message: String(error), where: method, remedy: '' });

/** Gives what is to be done with each message. */
export function serve(post) {
  const sessions = new Map();
  let limber = null, made = 0, asked = 0, told = 0;
  const onProgress = (stage, fraction) => {
    if (Date.now() - told < leastPause) return;
    told = Date.now();
    post({ id: asked, stage, fraction }, []);
  };
  const keep = (session) => {
    if (session) sessions.set(made += 1, session);
    return session ? made : null;
  };
  const answer = (session, method, args) => {
    if (method === 'createSession') return keep(limber.createSession());
    if (session === undefined) return limber[method](...args);
    const own = sessions.get(session);
    if (!own) throw new Freed();
    if (method === 'forkSession') return keep(limber.forkSession(own));
    if (method === 'free') sessions.delete(session);
    return own[method](...args);
  };
  return async ({ module, id, session, method, args }) => {
    if (module) {
      limber = shapesReader().then((shapeWeights) => loadLimber(module, { onProgress, shapeWeights }));
      return;
    }
    try {
      limber = await limber;
      asked = id;
      const value = answer(session, method, args);
      post({ id, value }, [...buffersIn(value)]);
    } catch (error) {
      post({ id, error: errorOf(error, method) }, []);
    }
  };
}
