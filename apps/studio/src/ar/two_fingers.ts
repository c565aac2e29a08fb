// Two fingers turn and scale the chosen model. A tap of both undoes.
import { tapDistance } from '../scene/pointer';
import type { ArView } from './ar_view';
import type { Finger, Gesture } from './gesture';
import { TurnScale } from './turn_scale';

export class TwoFingers implements Gesture {
  begun = false;
  private readonly at0: { length: number; angle: number };
  private readonly model: TurnScale;

  constructor(private ar: ArView, private fingers: readonly [Finger, Finger]) {
    this.model = new TurnScale(ar);
    this.at0 = this.between();
  }

  frame() {
    if (this.fingers.some(({ x, y, from }) => Math.hypot(x - from.x, y - from.y) > tapDistance)) this.begun = true;
    if (!this.begun) return;
    const now = this.between();
    this.model.to(now.length / this.at0.length, this.at0.angle - now.angle); // seen from above; the screen's angle runs the other way
  }

  end() {
    if (this.begun) this.model.keep();
    else void this.ar.desk.studio.undo();
  }

  private between() {
    const [a, b] = this.fingers, x = b.x - a.x, y = b.y - a.y;
    return { length: Math.max(1, Math.hypot(x, y)), angle: Math.atan2(y, x) };
  }
}
