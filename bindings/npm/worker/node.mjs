// limber/worker in Node. The process may end while the worker has nothing to do.
import { Worker } from 'node:worker_threads';
import { engineCode } from '../engine_code.mjs';
import { compiled } from './compiled.mjs';
import { connect } from './client.mjs';

export { WorkerError } from './client.mjs';

function start(tell, broken) {
  const thread = new Worker(new URL('./thread_node.mjs', import.meta.url));
  thread.on('message', tell);
  thread.on('messageerror', ({ message }) => broken(message));
  thread.on('error', ({ message }) => broken(message));
  thread.on('exit', (code) => broken(`it ended with code ${code}`));
  return { post: (message) => thread.postMessage(message), stop: () => void thread.terminate(), hold: (busy) => (busy ? thread.ref() : thread.unref()) };
}

export async function startWorker({ wasmBinary } = {}) {
  return connect(start, await compiled(wasmBinary ?? await engineCode()));
}
