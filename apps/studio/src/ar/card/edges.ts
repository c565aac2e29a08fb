// Corners to a fraction of a pixel: a line is fitted through the edges that are seen along each side of the black square,
// and neighbouring lines meet in the corners.
import { cellsAcross, type Corner, type Corners, type Grey } from './card';

const linesPerSide = 15;
const reach = 0.7; // cells to either side: what lies beyond may be a bit of the code, or the table
const step = 0.5; // pixels

interface Line { at: Corner; along: Corner }

/** Null where a side is not seen well enough. */
export function refinedCorners(picture: Grey, rough: Corners): Corners | null {
  let corners: Corners | null = rough;
  for (let pass = 0; pass < 2 && corners; ++pass) corners = refinedOnce(picture, corners);
  return corners;
}

function refinedOnce(picture: Grey, corners: Corners): Corners | null {
  const lines: Line[] = [];
  for (let side = 0; side < 4; ++side) {
    const line = lineAlong(picture, corners[side]!, corners[(side + 1) % 4]!);
    if (!line) return null;
    lines.push(line);
  }
  const met: Corner[] = [];
  for (let side = 0; side < 4; ++side) {
    const corner = meeting(lines[(side + 3) % 4]!, lines[side]!);
    const size = Math.hypot(corners[(side + 1) % 4]!.x - corners[side]!.x, corners[(side + 1) % 4]!.y - corners[side]!.y);
    if (!corner || Math.hypot(corner.x - corners[side]!.x, corner.y - corners[side]!.y) > Math.max(4, size / cellsAcross)) return null;
    met.push(corner);
  }
  return met as Corners;
}

/** The side from `a` to `b`, which has the black square on its right. */
function lineAlong(picture: Grey, a: Corner, b: Corner): Line | null {
  const length = Math.hypot(b.x - a.x, b.y - a.y), along = { x: (b.x - a.x) / length, y: (b.y - a.y) / length };
  const out = { x: along.y, y: -along.x }, far = Math.max(2, (reach * length) / cellsAcross), points: Corner[] = [];
  for (let i = 0; i < linesPerSide; ++i) {
    const t = 0.08 + (0.84 * i) / (linesPerSide - 1), x = a.x + (b.x - a.x) * t, y = a.y + (b.y - a.y) * t;
    const offset = edgeAcross(picture, x, y, out, far);
    if (offset !== null) points.push({ x: x + out.x * offset, y: y + out.y * offset });
  }
  return fitted(points, along);
}

/** How far along `out` the picture brightens most, in pixels: the middle of that rise. */
function edgeAcross(picture: Grey, x: number, y: number, out: Corner, far: number): number | null {
  const count = Math.ceil(far / step), rises: number[] = [];
  let best = -1;
  for (let k = -count; k <= count; ++k) {
    const inner = sample(picture, x + out.x * (k - 1) * step, y + out.y * (k - 1) * step);
    const outer = sample(picture, x + out.x * (k + 1) * step, y + out.y * (k + 1) * step);
    rises.push(outer - inner);
    if (best < 0 || rises.at(-1)! > rises[best]!) best = rises.length - 1;
  }
  const most = rises[best]!;
  if (most < 4) return null; // grey levels: below it is noise
  let from = best, to = best;
  while (from > 0 && rises[from - 1]! > most / 4) --from;
  while (to < rises.length - 1 && rises[to + 1]! > most / 4) ++to;
  if (from === 0 || to === rises.length - 1) return null; // goes on beyond what was looked at
  let sum = 0, weight = 0;
  for (let k = from; k <= to; ++k) {
    sum += rises[k]! * (k - count);
    weight += rises[k]!;
  }
  return (sum / weight) * step;
}

function sample({ width, height, data }: Grey, x: number, y: number) {
  const u = Math.min(Math.max(x - 0.5, 0), width - 1.001), v = Math.min(Math.max(y - 0.5, 0), height - 1.001);
  const i = Math.floor(u), j = Math.floor(v), a = u - i, b = v - j, at = j * width + i;
  return (data[at]! * (1 - a) + data[at + 1]! * a) * (1 - b) + (data[at + width]! * (1 - a) + data[at + width + 1]! * a) * b;
}

/** Least squares across the line; points that lie off it by more than twice the usual are left out. */
function fitted(points: Corner[], along: Corner): Line | null {
  let used = points;
  for (let pass = 0; ; ++pass) {
    if (used.length < linesPerSide / 2) return null;
    const at = { x: 0, y: 0 };
    for (const { x, y } of used) {
      at.x += x / used.length;
      at.y += y / used.length;
    }
    let xx = 0, xy = 0, yy = 0;
    for (const { x, y } of used) {
      xx += (x - at.x) ** 2;
      xy += (x - at.x) * (y - at.y);
      yy += (y - at.y) ** 2;
    }
    const angle = Math.atan2(2 * xy, xx - yy) / 2, line = { at, along: { x: Math.cos(angle), y: Math.sin(angle) } };
    if (Math.abs(line.along.x * along.x + line.along.y * along.y) < 0.9) return null;
    if (pass === 2) return line;
    const off = ({ x, y }: Corner) => Math.abs((x - at.x) * line.along.y - (y - at.y) * line.along.x);
    const usual = used.map(off).sort((p, q) => p - q)[used.length >> 1]!;
    used = used.filter((point) => off(point) <= Math.max(0.05, 3 * usual));
  }
}

function meeting(a: Line, b: Line): Corner | null {
  const across = a.along.x * b.along.y - a.along.y * b.along.x;
  if (Math.abs(across) < 0.05) return null;
  const t = ((b.at.x - a.at.x) * b.along.y - (b.at.y - a.at.y) * b.along.x) / across;
  return { x: a.at.x + a.along.x * t, y: a.at.y + a.along.y * t };
}
