// A model held from afar that is not being posed: it goes over the surface that it stands on, and onto others.
import { Matrix4, Vector3, type Ray } from 'three';
import type { ArView } from './ar_view';
import type { Gesture } from './gesture';
import type { Pointing } from './pointing';
import { onLevel } from './room';

const sameSurface = 0.05; // metres between the heights of two surfaces that are one, as devices measure

/** In the world. */
interface Held {
  place: Matrix4;
  /** The point that is pointed at. */
  from: Vector3;
  base: Vector3;
  /** How high the surface is that was behind it at first; not looked for yet, or none. */
  behind?: number | null;
}

export class BodyDrag implements Gesture {
  begun = false;
  private member: number | null = null;
  private held: Held | null = null;
  private over = false;

  /** `whose` tells which member is pointed at, null beside all of them. */
  constructor(private ar: ArView, private by: Pointing, whose: Promise<number | null>) {
    const from = by.ray();
    void whose.then((member) => {
      if (member === null || this.over) return;
      this.member = member;
      this.hold(from);
    });
  }

  frame() {
    const { by, held, member, ar } = this, { places, page, arrange } = ar.desk;
    if (by.moved) this.begun = true;
    if (!this.begun || !held || member === null) return;
    const surface = by.meets();
    held.behind ??= surface?.y ?? null;
    const to = this.onSurface(surface, held) ?? by.carry(held.from);
    if (!to) return;
    const change = to.clone().sub(held.from);
    places.move(member, new Matrix4().makeTranslation(change).multiply(held.place), page.now.session!.members);
    arrange();
    // From now on it is held by what stands on the new surface.
    if (surface && Math.abs(to.y - held.from.y) > sameSurface) this.holdAt(to);
  }

  end() {
    this.over = true;
    if (this.begun && this.member !== null) this.ar.keepPlace(this.member);
  }

  /** By the point of the model's box that is pointed at. */
  private hold(ray: Ray) {
    const { ar } = this, { places, page } = ar.desk, { members } = page.now.session!;
    const base = ar.baseOf(this.member!);
    const from = ray.intersectBox(places.box(this.member!, members), new Vector3()) ?? onLevel(ray, base) ?? base;
    this.holdAt(from);
  }

  private holdAt(from: Vector3) {
    const { places } = this.ar.desk;
    this.held = { place: places.of(this.member!).clone(), from, base: this.ar.baseOf(this.member!) };
  }

  /** Where its held point goes when it is to stand on a surface of another height, which was not behind it at first. */
  private onSurface(surface: Vector3 | null, { from, base, behind }: Held): Vector3 | null {
    const another = (height: number) => Math.abs(surface!.y - height) > sameSurface;
    if (!surface || !another(base.y) || (behind != null && !another(behind))) return null;
    return surface.clone().add(from).sub(base);
  }
}
