// Follows the card off the page's own thread: a picture of the camera comes, where the camera is goes back.
import { cameraOf, lensOf } from './pose';
import { cardSide } from './card';
import { FocalSearch } from './focal_search';
import { greyOf } from './picture';
import { Tracker } from './tracker';

export interface ToTracker {
  /** Closed when it was looked at. */
  picture: ImageBitmap;
  /** Degrees from the picture's lower to its upper edge, as far as anybody knows. */
  fieldOfView: number;
}
export interface FromTracker {
  /** In the room whose origin is the card, by columns; null where the card is not seen. */
  camera: number[] | null;
  /** Degrees from the picture's lower to its upper edge, as they were found. */
  fieldOfView: number;
}

const longest = 640; // pixels: more takes longer, and finds a card of 80 mm hardly farther off than at arm's length
const degrees = 180 / Math.PI;

const tracker = new Tracker(cardSide), canvas = new OffscreenCanvas(1, 1);
const context = canvas.getContext('2d', { willReadFrequently: true })!;
let search: FocalSearch | null = null;

function follow({ picture, fieldOfView }: ToTracker): FromTracker {
  const scale = Math.min(1, longest / Math.max(picture.width, picture.height));
  const width = Math.round(picture.width * scale), height = Math.round(picture.height * scale);
  if (!search || canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    const assumed = lensOf(width, height, fieldOfView);
    // A phone that was turned has the same lens.
    search = new FocalSearch(cardSide, { ...assumed, focal: search?.lens.focal ?? assumed.focal });
  }
  context.drawImage(picture, 0, 0, width, height);
  picture.close();
  const pose = tracker.follow(greyOf(width, height, context.getImageData(0, 0, width, height).data), search.lens);
  const { focal } = search.lens;
  if (tracker.corners) search.learn(tracker.corners);
  return { camera: pose && [...cameraOf(pose).elements], fieldOfView: 2 * Math.atan(height / 2 / focal) * degrees };
}

self.onmessage = ({ data }: MessageEvent<ToTracker>) => self.postMessage(follow(data));
