// Follows the card from picture to picture. Pure: runs in a worker and in a test alike.
import type { Corners, Grey } from './card';
import { Detector } from './detector';
import { refinedCorners } from './edges';
import { stretched } from './picture';
import { cardCorners, poseOf, seenAt, type Lens, type Pose } from './pose';

// Steadied by how far the corners go in the picture, in pixels: what noise does is smoothed, what the hand does is not held back.
const noise = 0.1, motion = 1, leastTrust = 0.2;
const worstFit = 2; // pixels: corners that no square before this lens can have

export class Tracker {
  /** As they were seen last; null where they were not. */
  corners: Corners | null = null;
  private detector = new Detector();
  private last: Pose | null = null;
  private lens: Lens | null = null;

  /** Metres along the black square's side. */
  constructor(private side: number) {}

  /** Of the card before the camera; null where it is not seen. */
  follow(picture: Grey, lens: Lens): Pose | null {
    const pose = this.measure(picture, lens);
    // What was seen through a lens that is now taken for a longer one was farther off.
    if (this.last && this.lens) this.last.position.z *= lens.focal / this.lens.focal;
    this.lens = lens;
    this.last = pose && this.last ? this.steadied(this.last, pose, lens) : pose;
    return this.last;
  }

  /** Without what was seen before. */
  measure(picture: Grey, lens: Lens): Pose | null {
    const rough = this.detector.find(stretched(picture));
    this.corners = rough && refinedCorners(picture, rough);
    const pose = this.corners && poseOf(this.corners, this.side, lens);
    return pose && pose.error < worstFit ? pose : null;
  }

  private steadied(last: Pose, pose: Pose, lens: Lens): Pose {
    const far = Math.max(...cardCorners(this.side).map((corner) => {
      const a = seenAt(corner, last, lens), b = seenAt(corner, pose, lens);
      return Math.hypot(a.x - b.x, a.y - b.y);
    }));
    const trust = leastTrust + (1 - leastTrust) * Math.min(1, Math.max(0, (far - noise) / (motion - noise)));
    return { rotation: last.rotation.clone().slerp(pose.rotation, trust), position: last.position.clone().lerp(pose.position, trust), error: pose.error };
  }
}
