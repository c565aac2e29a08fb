// Where the members of a scene stand: as the engine has them, or as one is being moved.
import { Box3, Matrix4, Vector3 } from 'three';
import type { SessionState } from '../engine/messages';

type Members = SessionState['members'];

export class Places {
  private matrices: Matrix4[] = [new Matrix4()];

  of(member: number): Matrix4 { return this.matrices[member] ?? new Matrix4(); }

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

function isCarriedBy(member: number, carrier: number, members: Members): boolean {
  for (let m: number | undefined = member; m !== undefined; m = members[m]?.attached?.to) if (m === carrier) return true;
  return false;
}
