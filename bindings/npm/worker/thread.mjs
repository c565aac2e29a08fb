// The thread of a page.
import { serve } from './serve.mjs';

const answer = serve((message, transfer) => postMessage(message, transfer));
addEventListener('message', ({ data }) => answer(data));
