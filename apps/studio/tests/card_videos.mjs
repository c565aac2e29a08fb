// Films of the card for a browser's fake camera, each picture with its number in a bar code along its upper edge.
import { closeSync, openSync, writeSync } from 'node:fs';
import { developed, exposed, height, opened, poseFrom, width } from './card_film.mjs';

export const rate = 20; // pictures a second
const cell = 32, rows = 16; // pixels of a bit; the number's bits, the lowest first, then their opposites
export const bits = 8;

/** Degrees from the lower to the upper edge: a focal length 15 % longer than the page guesses. */
export const degreesHigh = 45.2;
export const focal = height / 2 / Math.tan((degreesHigh * Math.PI) / 360);

/** At rest for 0.6 s, then round the card in a bow and back, the light going down to a third. */
export const walk = { count: 40, resting: 12, path: (seconds) => {
  const on = Math.max(0, (((seconds % 2) + 2) % 2) - 0.6) / 1.4, way = (1 - Math.cos(2 * Math.PI * on)) / 2;
  return poseFrom(0.4 + 0.06 * way, 45 + 12 * way, 30 * way - 10, 8 * way, [0.03 * way, 0.02 * way]);
}, light: (seconds) => 0.67 + 0.33 * Math.cos(Math.PI * seconds) };

export function writeWalk(file, code) {
  const sums = new Map(); // it comes back the way that it went
  write(file, 'w', walk.count, (i) => {
    const poses = opened(walk.path, i / rate), seen = poses.map(({ turn, move }) => [...turn, ...move].map((value) => value.toFixed(9)).join()).sort().join(' ');
    if (!sums.has(seen)) sums.set(seen, exposed(poses, focal, code, 2));
    return developed(sums.get(seen), { seed: i, light: walk.light(i / rate) });
  });
}

export const resting = poseFrom(0.4, 45, -10);

/** The camera at rest, four pictures over and over. `cover` lays a hand on the card, or takes it away, while the film is
 *  played: a browser reads each picture when it comes to it. */
export function writeRest(file, code) {
  const sums = exposed([resting], focal, code), bare = [1, 2, 3, 4].map((seed) => developed(sums, { seed }));
  const under = bare.map(({ data, ...size }) => {
    const copy = data.slice();
    for (let y = 150; y < height; ++y) copy.fill(140, y * width + 250, y * width + 420);
    return { ...size, data: copy };
  });
  write(file, 'w', bare.length, (i) => bare[i]);
  return { cover: (covered) => write(file, 'r+', bare.length, (i) => (covered ? under : bare)[i]) };
}

/** YUV4MPEG2 without colours, brightness from 16 to 235. */
function write(file, mode, count, picture) {
  const out = openSync(file, mode), y = new Uint8Array(width * height), grey = new Uint8Array((width * height) / 2).fill(128);
  writeSync(out, `YUV4MPEG2 W${width} H${height} F${rate}:1 Ip A1:1 C420\n`);
  for (let i = 0; i < count; ++i) {
    const { data } = picture(i);
    data.forEach((value, at) => { y[at] = 16 + (value * 219) / 255; });
    for (let bit = 0; bit < 2 * bits; ++bit) {
      const on = ((i >> (bit % bits)) & 1) ^ (bit < bits ? 0 : 1);
      for (let row = 0; row < rows; ++row) y.fill(on ? 200 : 40, row * width + bit * cell, row * width + (bit + 1) * cell);
    }
    writeSync(out, 'FRAME\n');
    writeSync(out, y);
    writeSync(out, grey);
  }
  closeSync(out);
}

/** In the page: notes for each picture that goes to the tracker its number (-1: not to be read) and what comes back, in
    `cardLog`, and the camera's tracks in `cardTracks`. */
export function logTracker([bits, cell, rows, width]) {
  globalThis.cardLog = [];
  globalThis.cardTracks = [];
  const ask = MediaDevices.prototype.getUserMedia;
  MediaDevices.prototype.getUserMedia = async function (...all) {
    const stream = await ask.apply(this, all);
    globalThis.cardTracks.push(...stream.getTracks());
    return stream;
  };
  const canvas = new OffscreenCanvas(1, 1), context = canvas.getContext('2d', { willReadFrequently: true }), post = Worker.prototype.postMessage;
  const numberOf = (picture) => {
    const scale = picture.width / width;
    canvas.width = picture.width;
    canvas.height = Math.ceil(rows * scale);
    context.drawImage(picture, 0, 0);
    const { data } = context.getImageData(0, Math.floor((rows / 2) * scale), picture.width, 1);
    const on = (bit) => data[4 * Math.floor((bit + 0.5) * cell * scale)] > 128;
    let number = 0;
    for (let bit = 0; bit < bits; ++bit) {
      if (on(bit) === on(bit + bits)) return -1;
      if (on(bit)) number |= 1 << bit;
    }
    return number;
  };
  Worker.prototype.postMessage = function (message, ...rest) {
    if (message?.picture instanceof ImageBitmap) {
      const entry = { number: numberOf(message.picture), sent: performance.now() };
      this.addEventListener('message', ({ data }) => globalThis.cardLog.push({ ...entry, camera: data.camera, fieldOfView: data.fieldOfView, took: performance.now() - entry.sent }), { once: true });
    }
    return post.call(this, message, ...rest);
  };
}
export const strip = [bits, cell, rows, width];
