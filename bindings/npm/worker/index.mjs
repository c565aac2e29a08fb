// limber/worker in a page.
import { engineCode } from '../engine_code.mjs';
import { compiled } from './compiled.mjs';
import { connect } from './client.mjs';

export { WorkerError } from './client.mjs';

function start(tell, broken) {
  const thread = new Worker(new URL('./thread.mjs', import.meta.url), { type: 'module' });
  thread.addEventListener('message', ({ data }) => tell(data));
  thread.addEventListener('messageerror', () => broken('its answer cannot be read'));
  thread.addEventListener('error', ({ message }) => broken(message ?? 'its file cannot be loaded'));
  return { post: (message) => thread.postMessage(message), stop: () => thread.terminate(), hold: () => {} };
}

export async function startWorker({ wasmBinary } = {}) {
  return connect(start, await compiled(wasmBinary ?? await engineCode()));
}
