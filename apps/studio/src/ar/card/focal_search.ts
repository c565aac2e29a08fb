// The focal length of a camera that nobody knows, from how the card is foreshortened: with a wrong one no pose fits the four
// corners. Browsers do not tell it, and phones differ by some 15 %.
import type { Corners } from './card';
import { poseFrom, poseOf, type Lens, type Pose } from './pose';

const step = 0.05, scales = Array.from({ length: 13 }, (_, i) => Math.exp(step * (i - 6))); // of the focal length assumed: to 35 % more
const spread = 0.15; // of phones about what is assumed, natural logarithm
const noise = 0.1; // pixels, of a corner
const most = 100; // one picture's say: corners that fit no focal length do not drown the others
const kept = 0.98; // from view to view, so that some fifty count
const moved = 8; // pixels that a corner goes until it is another view: the same one again tells nothing new, and the model of a camera at rest does not drift

export class FocalSearch {
  /** The likeliest by what was seen until now. */
  lens: Lens;
  private costs = scales.map(() => 0);
  private last: Corners | null = null;

  /** `side`: of the black square, in metres. */
  constructor(private side: number, private assumed: Lens) { this.lens = assumed; }

  /** Takes some three poses' time. A card that faces the camera tells nothing, and changes nothing. */
  learn(corners: Corners) {
    if (this.last?.every(({ x, y }, i) => Math.hypot(x - corners[i]!.x, y - corners[i]!.y) < moved)) return;
    this.last = corners;
    this.errorsOf(corners).forEach((error, i) => {
      this.costs[i] = this.costs[i]! * kept + Math.min(most, 4 * (error / noise) ** 2);
    });
    const costs = this.costs.map((cost, i) => cost + (Math.log(scales[i]!) / spread) ** 2);
    const best = Math.min(scales.length - 2, Math.max(1, costs.indexOf(Math.min(...costs))));
    const before = costs[best - 1]!, at = costs[best]!, after = costs[best + 1]!, bend = before - 2 * at + after;
    // The lowest point of the parabola through the three.
    const off = bend > 0 ? Math.min(1, Math.max(-1, (before - after) / (2 * bend))) : 0;
    this.lens = this.scaled(scales[best]! * Math.exp(step * off));
  }

  /** Pixels, for each of the scales: from the middle one to either side, each pose from its neighbour's. */
  private errorsOf(corners: Corners): number[] {
    const errors = scales.map(() => Infinity), middle = scales.length >> 1, first = poseOf(corners, this.side, this.scaled(1));
    for (const by of [-1, 1]) {
      let pose: Pose | null = first;
      for (let i = middle; pose && scales[i]; i += by) {
        errors[i] = pose.error;
        const ahead: Pose = { ...pose, position: pose.position.clone() };
        ahead.position.z *= Math.exp(step * by); // farther through a longer lens
        pose = poseFrom(ahead, corners, this.side, this.scaled(scales[i + by] ?? scales[i]!));
      }
    }
    return errors;
  }

  private scaled(scale: number): Lens { return { ...this.assumed, focal: this.assumed.focal * scale }; }
}
