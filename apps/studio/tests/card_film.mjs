// Draws the card on a patterned table, as a camera without lens distortion sees it.
export const side = 0.08; // metres, of the black square
export const width = 640, height = 480;

/** The same numbers in each run. */
export function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// Knots of a value noise, for a table that is not of one colour.
const kind = random(1), knots = Float32Array.from({ length: 256 * 256 }, kind);
const knot = (i, j) => knots[((i & 255) << 8) | (j & 255)];
// Of a camera's sensor: normally distributed, drawn once for all pictures.
const grain = Float32Array.from({ length: 262_139 }, () => Math.sqrt(-2 * Math.log(kind() + 1e-12)) * Math.cos(2 * Math.PI * kind()));
function table(x, z) {
  const u = x * 60, v = z * 60, i = Math.floor(u), j = Math.floor(v), a = u - i, b = v - j;
  const value = (knot(i, j) * (1 - a) + knot(i + 1, j) * a) * (1 - b) + (knot(i, j + 1) * (1 - a) + knot(i + 1, j + 1) * a) * b;
  return 60 + 110 * value;
}
const cell = side / 6;
function paper(x, z, code) {
  const column = Math.floor((x + side / 2) / cell), row = Math.floor((z + side / 2) / cell);
  if (column < -1 || row < -1 || column > 6 || row > 6) return table(x, z);
  if (column < 0 || row < 0 || column > 5 || row > 5) return 225;
  if (column < 1 || row < 1 || column > 4 || row > 4) return 25;
  return (code >> (15 - (4 * (row - 1) + column - 1))) & 1 ? 225 : 25;
}

/** Brightness of the picture from a pose of the card before the camera: `turn` its rotation by rows, `move` in metres. Each
    pixel is the mean over its area (of `perSide` squared rays) and over the poses, which are those while the shutter is open. */
export function exposed(poses, focal, code, perSide = 3) {
  const sums = new Float32Array(width * height);
  // Within its part of the pixel each pose's rays lie elsewhere: edges of few rays would be off by a twentieth of a pixel.
  for (const [i, { turn: r, move: t }] of poses.entries()) {
    const right = (i + 0.5) / poses.length, down = (((2 * i) % poses.length) + 0.5) / poses.length;
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        let sum = 0;
        for (let s = 0; s < perSide * perSide; ++s) {
          const u = (x + ((s % perSide) + right) / perSide - width / 2) / focal, v = (y + (Math.floor(s / perSide) + down) / perSide - height / 2) / focal;
          // The ray in the card's space, and where it meets y = 0.
          const up = r[1] * u + r[4] * v + r[7], from = -(r[1] * t[0] + r[4] * t[1] + r[7] * t[2]), far = -from / up;
          if (!(far > 0)) { sum += 150; continue; }
          const px = u * far - t[0], py = v * far - t[1], pz = far - t[2];
          sum += paper(r[0] * px + r[3] * py + r[6] * pz, r[2] * px + r[5] * py + r[8] * pz, code);
        }
        sums[y * width + x] += sum / (perSide * perSide * poses.length);
      }
    }
  }
  return sums;
}

/** What a sensor makes of it. `light` scales, `noise` is in grey levels. */
export function developed(sums, { light = 1, noise = 2, seed = 1 } = {}) {
  const data = new Uint8ClampedArray(width * height);
  for (let i = 0, at = Math.floor(random(seed)() * grain.length); i < data.length; ++i) data[i] = sums[i] * light + noise * grain[at++ % grain.length];
  return { width, height, data };
}

export const drawn = (poses, focal, code, { perSide, ...sensor } = {}) => developed(exposed(poses, focal, code, perSide), sensor);

/** The card seen from `distance` metres, `elevation` and `turn` in degrees, `roll` about the line of sight; the card's middle
    `aside` radians off the picture's. */
export function poseFrom(distance, elevation, turn, roll = 0, aside = [0, 0]) {
  const e = (elevation * Math.PI) / 180, a = (turn * Math.PI) / 180, k = (roll * Math.PI) / 180;
  const back = [Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)]; // to the camera
  const right = [Math.cos(a), 0, -Math.sin(a)], down = [Math.sin(e) * Math.sin(a), -Math.cos(e), Math.sin(e) * Math.cos(a)];
  const x = right.map((value, i) => Math.cos(k) * value + Math.sin(k) * down[i]), y = right.map((value, i) => -Math.sin(k) * value + Math.cos(k) * down[i]);
  return { turn: [...x, ...y, ...back.map((value) => -value)], move: [distance * Math.tan(aside[0]), distance * Math.tan(aside[1]), distance] };
}

/** The poses that `path` (of seconds) gives while the shutter is open, about that moment. */
export const opened = (path, seconds, shutter = 1 / 60) => [-0.5, 0, 0.5].map((part) => path(seconds + part * shutter));
