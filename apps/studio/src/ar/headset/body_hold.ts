// A model that hands have hold of as a whole.
import { Matrix4, Ray, Vector3 } from 'three';
import type { ArView } from '../ar_view';
import type { Gesture } from '../gesture';
import type { Pointing } from '../pointing';
import { TurnScale } from '../turn_scale';
import type { Hand } from './hand';
import { Stick } from './stick';

const leastMove = 0.01, leastTurn = 0.05; // metres, radians: less is a tap
const nearFloor = 0.04; // metres: as good as on it

/** Which way it points along the floor, in radians about y. */
const heading = ({ x, z }: Vector3) => Math.atan2(x, z);

/** From afar, as a finger on the screen does it. */
export function pointingBy(ar: ArView, hand: Hand, meets: () => Matrix4 | null): Pointing {
  const toWorld = () => ar.room.matrix, from = hand.ray(), aim = hand.aim.clone();
  let stick: { held: Vector3; end: Stick } | null = null;
  return {
    get moved() {
      const { origin, direction } = hand.ray();
      return origin.distanceTo(from.origin) > leastMove || direction.angleTo(from.direction) > leastTurn;
    },
    ray: () => hand.ray().applyMatrix4(toWorld()),
    meets: () => {
      const at = meets();
      return at && new Vector3().setFromMatrixPosition(at).applyMatrix4(toWorld());
    },
    carry(held) {
      if (stick?.held !== held) stick = { held, end: new Stick(hand, ar.eye, held.clone().applyMatrix4(toWorld().clone().invert()), stick ? hand.aim : aim) };
      return stick.end.end().applyMatrix4(toWorld()).setY(held.y);
    },
  };
}

/** Taken in the hand: it goes along, and turns about the upright. What stands remains upright. */
export class BodyInHand implements Gesture {
  begun = false;
  private readonly place: Matrix4;
  private readonly base: Vector3;
  private readonly at: Vector3;
  private readonly heading: number;

  constructor(private ar: ArView, private member: number, private hand: Hand) {
    this.place = ar.desk.places.of(member).clone();
    this.base = ar.baseOf(member);
    this.at = this.held();
    this.heading = this.turned();
  }

  frame() {
    const { ar, at, base } = this, { places, page, arrange } = ar.desk, { session } = page.now;
    const now = this.held(), turn = this.turned() - this.heading;
    if (now.distanceTo(at) > leastMove || Math.abs(turn) > leastTurn) this.begun = true;
    if (!this.begun || !session || ar.isPlacing) return;
    const floor = new Vector3().applyMatrix4(ar.room.matrix).y, height = base.y + now.y - at.y;
    if (Math.abs(height - floor) < nearFloor) now.y += floor - height;
    const change = new Matrix4().makeTranslation(now).multiply(new Matrix4().makeRotationY(turn)).multiply(new Matrix4().makeTranslation(at.clone().negate()));
    places.move(this.member, change.multiply(this.place), session.members);
    arrange();
  }

  end() {
    if (this.begun && !this.ar.isPlacing) void this.ar.keepPlace(this.member);
  }

  /** In the world. */
  private held() { return new Vector3().setFromMatrixPosition(this.hand.carrier).applyMatrix4(this.ar.room.matrix); }

  /** By that axis of the hand that was the most level when it took hold. */
  private axis: number | null = null;
  private turned(): number {
    const columns = [0, 1, 2].map((column) => new Vector3().setFromMatrixColumn(this.hand.carrier, column));
    this.axis ??= columns.map(({ y }, column) => ({ column, up: Math.abs(y) })).sort((a, b) => a.up - b.up)[0]!.column;
    return heading(columns[this.axis]!);
  }
}

/** Two hands turn and scale it where it stands, and take it along over its surface. */
export class BodyInTwoHands implements Gesture {
  begun = false;
  private readonly model: TurnScale;
  private readonly at0;
  private turn = 0;

  constructor(private ar: ArView, private hands: readonly [Hand, Hand]) {
    this.model = new TurnScale(ar);
    this.at0 = this.between();
  }

  frame() {
    const now = this.between(), { at0 } = this, shift = now.middle.sub(at0.middle).setY(0);
    // Across the seam of the angle, as far round as hands go.
    const turn = now.heading - at0.heading;
    this.turn = turn - 2 * Math.PI * Math.round((turn - this.turn) / (2 * Math.PI));
    if (shift.length() > leastMove || Math.abs(now.length - at0.length) > leastMove || Math.abs(this.turn) > leastTurn) this.begun = true;
    if (this.begun) this.model.to(now.length / at0.length, this.turn, shift);
  }

  end() {
    if (this.begun) this.model.keep();
  }

  /** In the world. */
  private between() {
    const [a, b] = this.hands.map(({ carrier, aim, reaches }) => new Vector3().setFromMatrixPosition(reaches ? carrier : aim).applyMatrix4(this.ar.room.matrix)) as [Vector3, Vector3];
    const way = b.clone().sub(a);
    return { middle: a.add(b).multiplyScalar(0.5), length: Math.max(0.01, way.length()), heading: heading(way) };
  }
}

/** The member that a point of the world is in; the smallest of several. */
export function memberAround(ar: ArView, point: Vector3): number | null {
  const { places, page } = ar.desk, members = page.now.session?.members ?? [];
  const around = members.map((_, member) => ({ member, box: places.box(member, members) })).filter(({ box }) => box.containsPoint(point));
  const size = ({ box }: (typeof around)[number]) => box.getSize(new Vector3()).length();
  return around.sort((a, b) => size(a) - size(b))[0]?.member ?? null;
}

/** How far along a ray of the world a member's box is met first. */
export function nearestBox(ar: ArView, ray: Ray): number | null {
  const { places, page } = ar.desk, members = page.now.session?.members ?? [], at = new Vector3();
  const met = members.flatMap((_, member) => (ray.intersectBox(places.box(member, members), at) ? [at.distanceTo(ray.origin)] : []));
  return met.length > 0 ? Math.min(...met) : null;
}
