// The chosen model turned and scaled about the middle of its feet; at its real size it stays for a while.
import { Matrix4, Vector3 } from 'three';
import type { ArView } from './ar_view';

const detent = 1.08; // times the real size, or that part of it: as good as the real size
const leastScale = 0.01, mostScale = 100;

export class TurnScale {
  private readonly member: number;
  private readonly place: Matrix4;
  private readonly base: Vector3;
  private readonly scale: number;
  private scaled: number;

  constructor(private ar: ArView) {
    const { places, page } = ar.desk;
    this.member = page.now.session!.member;
    this.place = places.of(this.member).clone();
    this.base = ar.baseOf(this.member);
    this.scale = this.scaled = places.shown(this.member).scale;
  }

  /** From how it was at first: so many times as large, radians about y, and moved in the world. */
  to(times: number, turn: number, shift = new Vector3()) {
    const { session } = this.ar.desk.page.now, { places, arrange } = this.ar.desk, { base } = this;
    if (!session || this.ar.isPlacing) return;
    const wanted = Math.min(mostScale, Math.max(leastScale, this.scale * times));
    const scale = this.scaled = Math.abs(Math.log(wanted)) < Math.log(detent) ? 1 : wanted;
    const change = new Matrix4().makeTranslation(base.clone().add(shift))
      .multiply(new Matrix4().makeRotationY(turn)).scale(new Vector3().setScalar(scale / this.scale))
      .multiply(new Matrix4().makeTranslation(base.clone().negate()));
    places.move(this.member, change.multiply(this.place), session.members);
    this.ar.showRealSize(scale === 1);
    arrange();
  }

  keep() {
    if (!this.ar.isPlacing) void this.ar.keepPlace(this.member, this.scaled);
  }
}
