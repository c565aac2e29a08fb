// The thread of Node.
import { parentPort } from 'node:worker_threads';
import { serve } from './serve.mjs';

parentPort.on('message', serve((message, transfer) => parentPort.postMessage(message, transfer)));
