// Where the members of a scene stand: as the engine has them, or as one is being moved.
import { Box3, MathUtils, Matrix4, Quaternion, Vector3 } from 'three';
import type { Placement, SessionState } from '../engine/messages';

type Members = SessionState['members'];

export class Places {
  private matrices: Matrix4[] = [new Matrix4()];

  of(member: number): Matrix4 { return this.matrices[member] ?? new Matrix4(); }

  /** As the page was told, unless what carries the member may have moved since. */
  placement(member: number, members: Members): Placement {
    const known = members[member]!;
    return known.attached ? this.shown(member) : known.placement;
  }

  /** As it is drawn now. */
  shown(member: number): Placement {
    const position = new Vector3(), turn = new Quaternion(), scale = new Vector3();
    this.of(member).decompose(position, turn, scale);
    return { position: position.toArray(), turn: turnVector(turn), scale: Math.cbrt(Math.abs(scale.x * scale.y * scale.z)) };
  }

  /** 16 numbers for each; none where a single model stands in its own space. */
  take(values: Float32Array) {
    this.matrices = values.length === 0 ? [new Matrix4()] : Array.from({ length: values.length / 16 }, (_, m) => new Matrix4().fromArray(values, 16 * m));
  }

  /** That member goes there, and what hangs on it comes along. */
  move(member: number, place: Matrix4, members: Members) {
    const by = place.clone().multiply(this.of(member).clone().invert());
    members.forEach((_, m) => { if (isCarriedBy(m, member, members)) this.matrices[m] = by.clone().multiply(this.of(m)); });
  }

  /** The bound surface in the world. */
  box(member: number, members: Members): Box3 {
    const { min, max } = members[member]!.box;
    return new Box3(new Vector3(...min), new Vector3(...max)).applyMatrix4(this.of(member));
  }

  boxOfAll(members: Members): Box3 {
    return members.reduce((all, _, member) => all.union(this.box(member, members)), new Box3());
  }
}

/** Degrees about an axis, as one vector. */
export function turnVector({ x, y, z, w }: Quaternion): Placement['turn'] {
  const sine = Math.hypot(x, y, z), degrees = MathUtils.radToDeg(2 * Math.atan2(sine, w));
  return sine < 1e-12 ? [0, 0, 0] : [x, y, z].map((part) => (degrees * part) / sine) as Placement['turn'];
}

export function quaternionOf(turn: Placement['turn']): Quaternion {
  const vector = new Vector3(...turn), degrees = vector.length();
  return new Quaternion().setFromAxisAngle(vector.normalize(), MathUtils.degToRad(degrees));
}

function isCarriedBy(member: number, carrier: number, members: Members): boolean {
  for (let m: number | undefined = member; m !== undefined; m = members[m]?.attached?.to) if (m === carrier) return true;
  return false;
}
