// Pictures of one size in a row as an animated PNG, which repeats for ever (https://www.w3.org/TR/png-3, 11.3.6).

const signature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
const chunkOverhead = 12; // bytes: length, kind and checksum

interface Chunk {
  kind: string;
  data: Uint8Array;
}

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});

function crcOf(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = crcTable[(crc ^ byte) & 255]! ^ (crc >>> 8);
  return ~crc >>> 0;
}

function chunksOf(png: Uint8Array): Chunk[] {
  const view = new DataView(png.buffer, png.byteOffset, png.byteLength), chunks: Chunk[] = [];
  for (let at = signature.length; at + chunkOverhead <= png.length;) {
    const length = view.getUint32(at);
    chunks.push({ kind: String.fromCharCode(...png.subarray(at + 4, at + 8)), data: png.subarray(at + 8, at + 8 + length) });
    at += length + chunkOverhead;
  }
  return chunks;
}

function written({ kind, data }: Chunk): Uint8Array {
  const bytes = new Uint8Array(data.length + chunkOverhead), view = new DataView(bytes.buffer);
  view.setUint32(0, data.length);
  for (let i = 0; i < 4; ++i) bytes[4 + i] = kind.charCodeAt(i);
  bytes.set(data, 8);
  view.setUint32(8 + data.length, crcOf(bytes.subarray(4, 8 + data.length)));
  return bytes;
}

const numbers = (values: number[]): Uint8Array => {
  const view = new DataView(new ArrayBuffer(4 * values.length));
  values.forEach((value, i) => view.setUint32(4 * i, value));
  return new Uint8Array(view.buffer);
};

/** `pictures`: PNG files, all made by the same encoder; `rate`: of them in a second, a whole number. */
export async function animatedPng(pictures: readonly Blob[], rate: number): Promise<Blob> {
  const frames: Chunk[][] = [];
  for (const picture of pictures) frames.push(chunksOf(new Uint8Array(await picture.arrayBuffer())));
  const header = frames[0]!.find(({ kind }) => kind === 'IHDR')!, size = header.data.subarray(0, 8);
  let sequence = 0;
  const chunks: Chunk[] = [header, { kind: 'acTL', data: numbers([frames.length, 0]) }];
  frames.forEach((frame, number) => {
    const control = new Uint8Array(26);
    control.set(numbers([sequence++]));
    control.set(size, 4); // at 0, 0; takes the place of what is there
    new DataView(control.buffer).setUint16(20, 1);
    new DataView(control.buffer).setUint16(22, rate);
    chunks.push({ kind: 'fcTL', data: control });
    for (const { data } of frame.filter(({ kind }) => kind === 'IDAT')) {
      if (number === 0) {
        chunks.push({ kind: 'IDAT', data });
        continue;
      }
      const numbered = new Uint8Array(4 + data.length);
      numbered.set(numbers([sequence++]));
      numbered.set(data, 4);
      chunks.push({ kind: 'fdAT', data: numbered });
    }
  });
  chunks.push({ kind: 'IEND', data: new Uint8Array() });
  return new Blob([new Uint8Array(signature), ...chunks.map(written)] as BlobPart[], { type: 'image/png' });
}
