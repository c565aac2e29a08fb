// Films of the card for a browser's fake camera, each picture with its number in a bar code along its upper edge.
import { closeSync, openSync, writeSync } from 'node:fs';
import { drawn, height, opened, poseFrom, width } from './card_film.mjs';

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

/** At rest; a hand covers the card from picture `from` to `to`. */
export const covered = { count: 140, from: 114, to: 140, pose: poseFrom(0.4, 45, -10) };

export function writeWalk(file, code) {
  write(file, walk.count, (i) => drawn(opened(walk.path, i / rate), focal, code, { seed: i, light: walk.light(i / rate), perSide: 2 }));
}

export function writeCovered(file, code) {
  const pictures = [1, 2, 3, 4].map((seed) => drawn([covered.pose], focal, code, { seed }));
  write(file, covered.count, (i) => {
    const { data, ...size } = pictures[i % pictures.length], copy = data.slice();
    if (i >= covered.from && i < covered.to) {
      for (let y = 150; y < height; ++y) copy.fill(140, y * width + 250, y * width + 420);
    }
    return { ...size, data: copy };
  });
}

/** YUV4MPEG2 without colours, brightness from 16 to 235. */
function write(file, count, picture) {
  const out = openSync(file, 'w'), y = new Uint8Array(width * height), grey = new Uint8Array((width * height) / 2).fill(128);
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
