// Finds the card in a picture, to the pixel.
import { AR } from 'js-aruco2/src/aruco.js';
import 'js-aruco2/src/dictionaries/aruco_mip_16h3.js';
import { cardId, dictionary, type Corners, type Grey } from './card';
import { halved } from './picture';

export class Detector {
  // A distance of 1 is exclusive: only the very code counts.
  private detector = new AR.Detector({ dictionaryName: dictionary, maxHammingDistance: 1 });
  private rgba = new Uint8ClampedArray();

  /** Half the size again where nothing is found: blur and noise are half there. */
  find(picture: Grey): Corners | null {
    return this.search(picture, 1) ?? this.search(halved(picture), 2);
  }

  private search({ width, height, data }: Grey, scale: number): Corners | null {
    if (this.rgba.length < 4 * data.length) this.rgba = new Uint8ClampedArray(4 * data.length);
    const rgba = this.rgba.subarray(0, 4 * data.length);
    for (let i = 0, to = 0; i < data.length; ++i, to += 4) rgba[to] = rgba[to + 1] = rgba[to + 2] = data[i]!;
    const found = this.detector.detectImage(width, height, rgba).find(({ id }) => id === cardId);
    return found ? found.corners.map(({ x, y }) => ({ x: (x + 0.5) * scale, y: (y + 0.5) * scale })) as Corners : null;
  }
}
