// A point of the room held from afar, as if at the end of a stick in the hand. Stretching the arm to twice its distance
// from the eyes pushes it to twice its distance from the hand.
import { Quaternion, Vector3, type Camera, type Matrix4 } from 'three';
import type { Hand } from './hand';

const leastArm = 0.1; // metres

export class Stick {
  private readonly direction: Vector3; // in the hand's own axes
  private readonly length: number;
  private readonly arm: number;

  /** `aim` is the hand's when it took hold. */
  constructor(private hand: Hand, private eye: Camera, point: Vector3, aim: Matrix4 = hand.aim) {
    const origin = new Vector3().setFromMatrixPosition(aim), way = point.clone().sub(origin);
    this.length = way.length();
    this.direction = way.normalize().applyQuaternion(turnOf(aim).invert());
    this.arm = this.reach(origin);
  }

  end(): Vector3 {
    const { origin } = this.hand.ray();
    return this.direction.clone().applyQuaternion(turnOf(this.hand.aim)).multiplyScalar((this.length * this.reach(origin)) / this.arm).add(origin);
  }

  private reach(origin: Vector3) { return Math.max(leastArm, origin.distanceTo(this.eye.position)); }
}

const turnOf = (aim: Matrix4) => new Quaternion().setFromRotationMatrix(aim);
