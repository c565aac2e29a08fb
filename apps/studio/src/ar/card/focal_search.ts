// The focal length of a camera that nobody knows, from how the card is foreshortened: with a wrong one no pose fits the four
// corners. Browsers do not tell it, and phones differ by some 15 %.
import type { Corners } from './card';
import { poseOf, type Lens } from './pose';

const step = 0.05, scales = Array.from({ length: 13 }, (_, i) => Math.exp(step * (i - 6))); // of the focal length assumed: to 35 % more
const spread = 0.15; // of phones about what is assumed, natural logarithm
const noise = 0.1; // pixels, of a corner
const most = 100; // one picture's say: corners that fit no focal length do not drown the others
const kept = 0.98; // from picture to picture, so that a second or two count

export class FocalSearch {
  /** The likeliest by what was seen until now. */
  lens: Lens;
  private costs = scales.map(() => 0);

  /** `side`: of the black square, in metres. */
  constructor(private side: number, private assumed: Lens) { this.lens = assumed; }

  /** Takes some 13 poses' time. A card that faces the camera tells nothing, and changes nothing. */
  learn(corners: Corners) {
    scales.forEach((scale, i) => {
      const pose = poseOf(corners, this.side, this.scaled(scale));
      this.costs[i] = this.costs[i]! * kept + (pose ? Math.min(most, 4 * (pose.error / noise) ** 2) : most);
    });
    const costs = this.costs.map((cost, i) => cost + (Math.log(scales[i]!) / spread) ** 2);
    const best = Math.min(scales.length - 2, Math.max(1, costs.indexOf(Math.min(...costs))));
    const before = costs[best - 1]!, at = costs[best]!, after = costs[best + 1]!, bend = before - 2 * at + after;
    // The lowest point of the parabola through the three.
    const off = bend > 0 ? Math.min(1, Math.max(-1, (before - after) / (2 * bend))) : 0;
    this.lens = this.scaled(scales[best]! * Math.exp(step * off));
  }

  private scaled(scale: number): Lens { return { ...this.assumed, focal: this.assumed.focal * scale }; }
}
