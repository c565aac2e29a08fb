// Calls of the engine in a thread of its own, as promises. What a thread is, a page and Node say each for itself: start(tell,
// broken) gives { post, stop, hold }, and hands over what the thread says and that it broke.

/** Calls whose answers have no room for an error: they are rejected with one. */
const plainCalls = new Set(['methods', 'rigChoices', 'sampleMotions', 'samplePoses', 'createSession', 'forkSession', 'record', 'free']);
const limberCalls = ['rig', 'setShapeWeights', 'methods', 'rigChoices', 'sampleMotions', 'samplePoses', 'checkPly', 'crowd'];
const sessionCalls = ['open', 'add', 'places', 'memberModel', 'memberPosed', 'memberSkin', 'pickMember', 'addMotion', 'transferRig', 'sourceJoints', 'paths',
  'curve', 'run', 'pick', 'surface', 'weights', 'preview', 'parts', 'skin', 'handles', 'turns', 'scales', 'model', 'deformation', 'posed', 'export', 'pose', 'record',
  'measures', 'rigCheck', 'saveModel', 'liveBegin', 'liveFrame', 'liveEnd', 'liveRecorded', 'free'];

export class WorkerError extends Error {
  constructor(error) {
    super(error.message);
    this.error = error;
  }
}

const stopped = { code: 'cancelled', message: 'the worker was stopped, and its sessions with it', where: '', remedy: 'ask again; make sessions anew' };

export function connect(start, module) {
  const waiting = new Map();
  let thread = null, threads = 0, calls = 0;

  const broke = (message) => ({ code: 'worker', message: `the worker broke: ${message}`, where: '', remedy: '' });
  const settle = (id, answer) => {
    const call = waiting.get(id);
    if (!call) return;
    waiting.delete(id);
    if (waiting.size === 0) thread?.hold(false);
    call.done(answer);
  };
  const end = (error) => {
    thread?.stop();
    thread = null;
    for (const id of [...waiting.keys()]) settle(id, { error });
  };
  const open = () => {
    const number = (threads += 1);
    const isCurrent = () => thread !== null && number === threads;
    const tell = ({ id, stage, fraction, ...answer }) => {
      if (!isCurrent()) return;
      if (stage === undefined) return settle(id, answer);
      try {
        waiting.get(id)?.onProgress?.(stage, fraction);
      } catch (thrown) {
        settle(id, { thrown });
        end(stopped);
      }
    };
    thread = start(tell, (message) => {
      if (isCurrent()) end(broke(message));
    });
    thread.post({ module });
  };

  function call(target, method, args, { signal, onProgress } = {}) {
    const isPlain = plainCalls.has(method);
    return new Promise((resolve, reject) => {
      const done = ({ value, error, ...listener }) => {
        signal?.removeEventListener('abort', abort);
        if ('thrown' in listener) reject(listener.thrown);
        else if (!error || method === 'free') resolve(value);
        else if (isPlain) reject(new WorkerError(error));
        else resolve({ ok: false, error });
      };
      const abort = () => end(stopped);
      if (signal?.aborted || (target && (target.thread !== threads || !thread))) return done({ error: stopped });
      try {
        if (!thread) open();
      } catch (error) {
        end(broke(error.message));
        return done({ error: broke(error.message) });
      }
      if (waiting.size === 0) thread.hold(true);
      const id = (calls += 1);
      waiting.set(id, { done, onProgress });
      signal?.addEventListener('abort', abort);
      try {
        thread.post({ id, session: target?.session, method, args });
      } catch (error) { // what cannot be copied
        settle(id, { error: { code: 'bad-argument', message: error.message.split('\n')[0], where: method, remedy: '' } });
      }
    });
  }

  const sessionOf = (session) => {
    const target = { session, thread: threads };
    const made = Object.fromEntries(sessionCalls.map((method) => [method, (...args) => call(target, method, args)]));
    return { ...made, fork: async () => {
      const forked = await call(target, 'forkSession', []);
      return forked === null ? null : sessionOf(forked);
    } };
  };
  return {
    ...Object.fromEntries(limberCalls.map((method) => [method, (...args) => call(null, method, args)])),
    rig: (file, name, options = {}, { signal, onProgress } = {}) => call(null, 'rig', [file, name, options], { signal, onProgress }),
    createSession: async () => sessionOf(await call(null, 'createSession', [])),
    stop: () => end(stopped),
  };
}
