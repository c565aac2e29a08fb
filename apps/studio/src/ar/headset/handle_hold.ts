// A handle that a hand has hold of: near, it goes and turns with the hand; far, it is at the end of the hand's ray, and
// stretching the arm pushes it away in proportion.
import { Matrix4, Quaternion, Ray, Vector3 } from 'three';
import type { Vector } from '../../engine/messages';
import { turnVector } from '../../scene/places';
import type { ArView } from '../ar_view';
import type { Gesture } from '../gesture';
import type { Hand } from './hand';
import { Stick } from './stick';

const leastMove = 0.004, leastTurn = 0.05; // metres of the room, radians: less is a tap
const ahead: Vector = [0, 0, -1];

/** In the model's own space: where the handle is wanted, and how far turned since it was taken. */
interface Carried { at: Vector3; turn: Quaternion }

abstract class HandleHold implements Gesture {
  begun = false;
  protected readonly from: Vector3;
  private readonly scale: number; // metres of the model's own space for one of the room
  private sent: Carried | null = null;
  private rest = new Vector3(); // between where the hand wants the handle and where its limb reaches
  private readonly stopReading: () => void;

  constructor(protected ar: ArView, protected joint: number) {
    const { studio, handles } = ar.desk;
    this.from = handles.position(joint);
    this.scale = ar.room.matrixWorld.getMaxScaleOnAxis();
    this.stopReading = studio.readStance(({ handles: stood }) => {
      const asked = this.asked();
      if (this.begun && asked) this.rest.fromArray(stood, 4 * joint).sub(asked);
    });
  }

  frame() {
    const carried = this.carried(), moved = carried.at.distanceTo(this.from), turned = 2 * Math.acos(Math.min(1, Math.abs(carried.turn.w)));
    if (moved > leastMove * this.scale || turned > leastTurn) this.begun = true;
    if (!this.begun) return;
    if (!this.sent || !carried.at.equals(this.sent.at) || !carried.turn.equals(this.sent.turn)) this.send(carried);
    this.sent = carried;
    // The engine answers a frame or two later, and the hand has moved on by then.
    this.ar.desk.handles.hold(this.joint, carried.at.clone().add(this.rest));
  }

  end() {
    this.stopReading();
    if (this.begun) this.ar.desk.studio.endDrag();
    else this.ar.desk.studio.cancelDrag(); // a tap selects, and is no step to undo
  }

  protected abstract carried(): Carried;
  protected abstract send(carried: Carried): void;

  /** Where the handles that are shown now were wanted. */
  private asked(): Vector3 | null {
    const shown = this.ar.desk.studio.shownDrag();
    if (shown?.do === 'move_drag') return this.from.clone().add(new Vector3(...shown.offset));
    return shown?.do === 'update_drag' ? new Vector3(...shown.ray.origin).add(new Vector3(...ahead)) : null;
  }

  /** Looked at along z: a drag that moves by what is asked alone. */
  protected rayTo(at: Vector3) { return { origin: at.clone().sub(new Vector3(...ahead)).toArray(), direction: ahead }; }
}

/** Six degrees of freedom. */
export class HandleInHand extends HandleHold {
  /** Of the hand when it held for the first frame: the fingers that close move it a little. */
  private fromHand: Matrix4 | null = null;

  constructor(ar: ArView, joint: number, private hand: Hand) {
    super(ar, joint);
    ar.desk.studio.beginDrag(joint, this.rayTo(this.from), ahead, 'move');
  }

  protected carried(): Carried {
    this.fromHand ??= this.held().invert();
    const change = this.held().multiply(this.fromHand);
    return { at: this.from.clone().applyMatrix4(change), turn: new Quaternion().setFromRotationMatrix(change) };
  }

  protected send({ at, turn }: Carried) {
    const shorter = turn.w < 0 ? new Quaternion(-turn.x, -turn.y, -turn.z, -turn.w) : turn;
    this.ar.desk.studio.moveDrag(at.clone().sub(this.from).toArray(), turnVector(shorter));
  }

  /** The hand in the model's own space. */
  private held() { return new Matrix4().multiplyMatrices(this.ar.room.matrixWorld, this.hand.carrier); }
}

export class HandleOnRay extends HandleHold {
  private readonly stick: Stick;

  constructor(ar: ArView, joint: number, hand: Hand) {
    super(ar, joint);
    this.stick = new Stick(hand, ar.eye, this.from.clone().applyMatrix4(ar.room.matrixWorld.clone().invert()));
    ar.desk.studio.beginDrag(joint, this.rayTo(this.from), ahead, 'move');
  }

  protected carried(): Carried { return { at: this.stick.end().applyMatrix4(this.ar.room.matrixWorld), turn: new Quaternion() }; }
  protected send({ at }: Carried) { this.ar.desk.studio.updateDrag(this.rayTo(at), ahead); }
}

/** Turned about its parent, round the axis along which the user looks, or scaled as the ray goes up or down. */
export class HandleSwing implements Gesture {
  begun = false;
  private readonly from: Ray;
  /** From where the hand points to the handle's middle, turning with the hand. */
  private readonly beside: Quaternion;
  private sent: number[] = [];

  constructor(private ar: ArView, joint: number, private hand: Hand) {
    const { studio, handles } = ar.desk, ray = this.pointed(), to = handles.position(joint).sub(ray.origin).normalize();
    this.beside = new Quaternion().setFromUnitVectors(ray.direction, to);
    this.from = new Ray(ray.origin, to);
    studio.beginDrag(joint, { origin: ray.origin.toArray(), direction: to.toArray() }, this.view());
  }

  frame() {
    const { origin, direction } = this.pointed(), { room, desk } = this.ar;
    direction.applyQuaternion(this.beside);
    if (origin.distanceTo(this.from.origin) > leastMove * room.matrixWorld.getMaxScaleOnAxis() || direction.angleTo(this.from.direction) > leastTurn) this.begun = true;
    const view = this.view(), now = [...origin.toArray(), ...direction.toArray(), ...view];
    if (!this.begun || now.every((value, i) => value === this.sent[i])) return;
    this.sent = now;
    desk.studio.updateDrag({ origin: origin.toArray(), direction: direction.toArray() }, view);
  }

  end() {
    if (this.begun) this.ar.desk.studio.endDrag();
    else this.ar.desk.studio.cancelDrag();
  }

  /** In the model's own space. */
  private pointed() { return this.hand.ray().applyMatrix4(this.ar.room.matrixWorld); }
  private view(): Vector { return this.ar.eye.getWorldDirection(new Vector3()).toArray(); }
}
