// Fingers on what is looked through: a handle, a model, two fingers, a tap.
import { Vector3 } from 'three';
import { slop, tapDistance } from '../scene/pointer';
import type { ArView } from './ar_view';
import { BodyDrag } from './body_drag';
import type { Finger, Gesture } from './gesture';
import { HandleDrag } from './handle_drag';
import { pointingOf } from './pointing';
import type { Spot } from './sight';
import { TwoFingers } from './two_fingers';

export class Touch {
  private fingers: Finger[] = [];
  private gesture: Gesture | null = null;

  constructor(private ar: ArView) {}

  down(id: number, { x, y }: Spot) {
    this.fingers.push({ id, x, y, from: { x, y } });
    const [first, second] = this.fingers;
    if (!first || !this.ar.desk.page.now.session) return;
    if (!second) this.gesture = this.oneFinger(first);
    else if (this.fingers.length === 2 && !this.gesture?.begun) {
      this.gesture?.end();
      this.gesture = new TwoFingers(this.ar, [first, second]);
    }
  }

  move(id: number, { x, y }: Spot) {
    const finger = this.fingers.find((one) => one.id === id);
    if (finger) Object.assign(finger, { x, y });
  }

  up(id: number) {
    const finger = this.fingers.find((one) => one.id === id), { gesture } = this;
    if (!finger) return;
    gesture?.frame();
    const tapped = this.fingers.length === 1 && !gesture?.begun && !(gesture instanceof TwoFingers) && !(gesture instanceof HandleDrag)
      && Math.hypot(finger.x - finger.from.x, finger.y - finger.from.y) <= tapDistance;
    this.finish();
    if (tapped) void this.ar.tap(finger);
  }

  /** With each frame, as the device moves. */
  frame() { this.gesture?.frame(); }

  /** The fingers are not heard any more: what they did stays. */
  letGo() {
    if (this.gesture instanceof TwoFingers && !this.gesture.begun) this.gesture = null; // no tap
    this.finish();
  }

  /** Fingers that are left on the screen do nothing any more. */
  private finish() {
    this.fingers = [];
    this.gesture?.end();
    this.gesture = null;
  }

  private oneFinger(finger: Finger): Gesture | null {
    const { ar } = this, { page, studio, viewport } = ar.desk;
    if (ar.isPlacing) return null;
    if (page.now.display !== 'handles') return new BodyDrag(ar, pointingOf(ar, finger), studio.memberUnder(viewport.ray(finger.x, finger.y).ray));
    const joint = this.nearestHandle(finger);
    return joint === null ? null : new HandleDrag(ar.desk, joint, finger);
  }

  /** To the finger, then to the camera, where it could be either. */
  private nearestHandle({ x, y }: Spot): number | null {
    const { handles, viewport } = this.ar.desk, { width, height } = viewport.size;
    const near = Array.from({ length: handles.count }, (_, joint) => {
      const at = handles.position(joint, new Vector3()).project(viewport.camera);
      return { joint, depth: at.z, away: Math.hypot(((at.x + 1) / 2) * width - x, ((1 - at.y) / 2) * height - y) };
    }).filter(({ depth, away }) => depth <= 1 && away <= slop.touch).sort((a, b) => a.away - b.away);
    const either = near.filter(({ away }) => away <= near[0]!.away + tapDistance).sort((a, b) => a.depth - b.depth);
    return either[0]?.joint ?? null;
  }
}
