// The studio's icon: a bent chain with three red handles, drawn into PNG files for home screens.
import { crc32, deflateSync } from 'node:zlib';

type Point = [number, number];
const chain: Point[] = [[4, 13], [8, 8], [6, 3]]; // in a square of 16 by 16
const lineRadius = 1, handleRadius = 2.4;
const paper = [0xf4, 0xf5, 0xf7], line = [0x37, 0x41, 0x51], handle = [0xdc, 0x2f, 0x3c];
/** Of the picture; the rest is margin, since a launcher may cut a circle of 80 % out of it. */
const drawn = 0.62;
const centre: Point = [6, 8];

function distanceToLine([x, y]: Point, [ax, ay]: Point, [bx, by]: Point) {
  const dx = bx - ax, dy = by - ay;
  const along = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)));
  return Math.hypot(x - ax - along * dx, y - ay - along * dy);
}

function colourAt(at: Point) {
  if (chain.some(([x, y]) => Math.hypot(at[0] - x, at[1] - y) < handleRadius)) return handle;
  if (chain.some((to, i) => i > 0 && distanceToLine(at, chain[i - 1]!, to) < lineRadius)) return line;
  return paper;
}

function chunk(type: string, data: Buffer) {
  const body = Buffer.concat([Buffer.from(type), data]), size = Buffer.alloc(4), sum = Buffer.alloc(4);
  size.writeUInt32BE(data.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([size, body, sum]);
}

/** Square, opaque, so many pixels wide. */
export function iconPng(size: number): Buffer {
  const samples = 4; // along each side of a pixel
  const unit = 16 / (size * drawn);
  const rows = Buffer.alloc(size * (1 + 3 * size)); // each begins with its filter, 0: none
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const sum = [0, 0, 0];
      for (let i = 0; i < samples * samples; ++i) {
        const dx = x + ((i % samples) + 0.5) / samples, dy = y + (Math.floor(i / samples) + 0.5) / samples;
        const colour = colourAt([centre[0] + (dx - size / 2) * unit, centre[1] + (dy - size / 2) * unit]);
        sum.forEach((_, channel) => { sum[channel]! += colour[channel]!; });
      }
      sum.forEach((value, channel) => { rows[y * (1 + 3 * size) + 1 + 3 * x + channel] = Math.round(value / samples ** 2); });
    }
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(size, 0);
  header.writeUInt32BE(size, 4);
  header.set([8, 2, 0, 0, 0], 8); // 8 bits a channel, red green blue
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', header), chunk('IDAT', deflateSync(rows, { level: 9 })), chunk('IEND', Buffer.alloc(0))]);
}
