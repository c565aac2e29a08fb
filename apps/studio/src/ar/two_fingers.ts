// Two fingers turn and scale the chosen model; at its real size it stays for a while. A tap of both undoes.
import { Matrix4, Vector3 } from 'three';
import { tapDistance } from '../scene/pointer';
import type { ArView } from './ar_view';
import type { Finger, Gesture } from './gesture';

const detent = 1.08; // times the real size, or that part of it: as good as the real size
const leastScale = 0.01, mostScale = 100;

export class TwoFingers implements Gesture {
  begun = false;
  private readonly at0: { length: number; angle: number };
  private readonly member: number;
  private readonly place: Matrix4;
  private readonly base: Vector3;
  private readonly scale: number;

  constructor(private ar: ArView, private fingers: readonly [Finger, Finger]) {
    const { places, page } = ar.desk;
    this.member = page.now.session!.member;
    this.place = places.of(this.member).clone();
    this.base = ar.baseOf(this.member);
    this.scale = places.shown(this.member).scale;
    this.at0 = this.between();
  }

  frame() {
    if (this.fingers.some(({ x, y, from }) => Math.hypot(x - from.x, y - from.y) > tapDistance)) this.begun = true;
    const { session } = this.ar.desk.page.now;
    if (!this.begun || !session || this.ar.isPlacing) return;
    const { places, arrange } = this.ar.desk, now = this.between(), { base } = this;
    const wanted = Math.min(mostScale, Math.max(leastScale, (this.scale * now.length) / this.at0.length));
    const scale = Math.abs(Math.log(wanted)) < Math.log(detent) ? 1 : wanted;
    // As seen from above; the screen's angle runs the other way.
    const change = new Matrix4().makeTranslation(base)
      .multiply(new Matrix4().makeRotationY(this.at0.angle - now.angle)).scale(new Vector3().setScalar(scale / this.scale))
      .multiply(new Matrix4().makeTranslation(base.clone().negate()));
    places.move(this.member, change.multiply(this.place), session.members);
    this.ar.showRealSize(scale === 1);
    arrange();
  }

  end() {
    if (!this.begun) void this.ar.desk.studio.undo();
    else if (!this.ar.isPlacing) this.ar.keepPlace(this.member);
  }

  private between() {
    const [a, b] = this.fingers, x = b.x - a.x, y = b.y - a.y;
    return { length: Math.max(1, Math.hypot(x, y)), angle: Math.atan2(y, x) };
  }
}
