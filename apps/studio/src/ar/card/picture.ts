// What is done to the camera's picture before the card is looked for in it.
import type { Corner, Grey } from './card';

/** From red, green, blue, opacity (ITU-R BT.601). */
export function greyOf(width: number, height: number, rgba: Uint8ClampedArray): Grey {
  const data = new Uint8ClampedArray(width * height);
  for (let i = 0, from = 0; i < data.length; ++i, from += 4) data[i] = 0.299 * rgba[from]! + 0.587 * rgba[from + 1]! + 0.114 * rgba[from + 2]!;
  return { width, height, data };
}

/** The darkest and the brightest fiftieth become black and white: the detector's threshold is a fixed number of grey levels. */
export function stretched({ width, height, data }: Grey): Grey {
  const counts = new Uint32Array(256), cut = data.length / 50, levels = new Uint8ClampedArray(256), out = new Uint8ClampedArray(data.length);
  for (let i = 0; i < data.length; ++i) ++counts[data[i]!]!;
  let low = 0, high = 255;
  for (let sum = counts[0]!; sum < cut && low < 255;) sum += counts[++low]!;
  for (let sum = counts[255]!; sum < cut && high > 0;) sum += counts[--high]!;
  for (let level = 0; level < 256; ++level) levels[level] = ((level - low) * 255) / Math.max(1, high - low);
  for (let i = 0; i < out.length; ++i) out[i] = levels[data[i]!]!;
  return { width, height, data: out };
}

export function halved({ width, height, data }: Grey): Grey {
  const w = width >> 1, h = height >> 1, out = new Uint8ClampedArray(w * h);
  for (let y = 0; y < h; ++y) {
    for (let x = 0; x < w; ++x) {
      const at = 2 * y * width + 2 * x;
      out[y * w + x] = (data[at]! + data[at + 1]! + data[at + width]! + data[at + width + 1]!) / 4;
    }
  }
  return { width: w, height: h, data: out };
}

/** The pixels within a box, and the place of the first; none where the box lies beside the picture. */
export function cutOut({ width, height, data }: Grey, box: { left: number; top: number; right: number; bottom: number }): { part: Grey | null; at: Corner } {
  const left = Math.max(0, Math.floor(box.left)), top = Math.max(0, Math.floor(box.top));
  const w = Math.min(width, Math.ceil(box.right)) - left, h = Math.min(height, Math.ceil(box.bottom)) - top, at = { x: left, y: top };
  if (w <= 0 || h <= 0) return { part: null, at };
  const out = new Uint8ClampedArray(w * h);
  for (let y = 0; y < h; ++y) out.set(data.subarray((top + y) * width + left, (top + y) * width + left + w), y * w);
  return { part: { width: w, height: h, data: out }, at };
}
