// Follows the card from picture to picture. Pure: runs in a worker and in a test alike.
import type { Corner, Corners, Grey } from './card';
import { Detector } from './detector';
import { refinedCorners } from './edges';
import { cutOut, stretched } from './picture';
import { cardCorners, poseOf, seenAt, type Lens, type Pose } from './pose';

// Steadied by how far the corners go in the picture, in pixels: what noise does is smoothed, what the hand does is not held back.
const noise = 0.1, motion = 1, leastTrust = 0.2;
/** Of the card's size in the picture, to either side of where it is expected: the white rim of a sixth, and a third for a hand that
 *  changes its speed, by 0.8 m/s between two of 30 pictures a second. */
const around = 0.5;
const worstFit = 2; // pixels: corners that no square before this lens can have

export class Tracker {
  /** As they were seen last; null where they were not. */
  corners: Corners | null = null;
  private detector = new Detector();
  private last: Pose | null = null;
  private lens: Lens | null = null;
  /** Pixels that the middle went between the last two pictures. */
  private moved: Corner = { x: 0, y: 0 };

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

  /** Not steadied. */
  measure(picture: Grey, lens: Lens): Pose | null {
    const rough = this.nearby(picture) ?? this.detector.find(stretched(picture)), before = this.corners;
    this.corners = rough && refinedCorners(picture, rough);
    this.moved = this.corners && before ? offset(centreOf(before), centreOf(this.corners)) : { x: 0, y: 0 };
    const pose = this.corners && poseOf(this.corners, this.side, lens);
    return pose && pose.error < worstFit ? pose : null;
  }

  /** Where it should be if it goes on as it went: the whole picture takes several times as long. */
  private nearby(picture: Grey): Corners | null {
    if (!this.corners) return null;
    const { x: u, y: v } = this.moved, xs = this.corners.map(({ x }) => x + u), ys = this.corners.map(({ y }) => y + v);
    const size = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)), margin = around * size;
    const box = { left: Math.min(...xs) - margin, top: Math.min(...ys) - margin, right: Math.max(...xs) + margin, bottom: Math.max(...ys) + margin };
    const { part, at } = cutOut(picture, box), found = part && this.detector.find(stretched(part));
    return found && found.map(({ x, y }) => ({ x: x + at.x, y: y + at.y })) as Corners;
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

const centreOf = (corners: Corners): Corner => ({ x: corners.reduce((sum, { x }) => sum + x / 4, 0), y: corners.reduce((sum, { y }) => sum + y / 4, 0) });
const offset = (from: Corner, to: Corner): Corner => ({ x: to.x - from.x, y: to.y - from.y });
