// One hand, bare or with a controller: what it holds with, where it points, what it touches with. All in the room.
import { Group, Matrix4, Ray, Vector3 } from 'three';
import { HandModel } from './hand_model';

const ahead = new Vector3(0, 0, -1);

export class Hand {
  /** Child of the room. */
  readonly root = new Group();
  /** What it takes is near this: between the tips of thumb and finger, or in the controller. */
  readonly grip = new Vector3();
  /** What it holds goes along with this: the controller or the wrist, since fingers that close and open would move what
   *  is between them. */
  readonly carrier = new Matrix4();
  /** It points along -z. */
  readonly aim = new Matrix4();
  /** What touches a panel. */
  readonly tip = new Vector3();
  /** Where it is is known now. */
  tracked = false;
  /** Whether it can hold what is near; eyes and heads that point alone cannot. */
  reaches = false;
  /** Where its ray ends, in metres; null where none is shown. */
  rayLength: number | null = null;
  hits: XRHitTestSource | null = null;

  private readonly model: HandModel;

  constructor(readonly source: XRInputSource) {
    this.model = new HandModel(this, source.hand !== undefined);
    this.root.add(this.model.root);
  }

  get isLeft() { return this.source.handedness === 'left'; }

  /** Its ray, in the room. */
  ray(): Ray { return new Ray(new Vector3().setFromMatrixPosition(this.aim), ahead.clone().transformDirection(this.aim)); }

  update(frame: XRFrame, space: XRReferenceSpace) {
    const { source } = this, aim = frame.getPose(source.targetRaySpace, space);
    this.tracked = aim != null;
    this.root.visible = this.tracked;
    if (!aim) return;
    this.aim.fromArray(aim.transform.matrix);
    this.reaches = source.hand ? this.holdBare(frame, space, source.hand) : this.holdController(frame, space);
  }

  /** Once it is known what it points at. */
  draw() { this.model.draw(); }

  /** A short buzz, where it has a motor. */
  pulse() {
    void this.source.gamepad?.hapticActuators?.[0]?.pulse?.(0.4, 15)?.catch(() => { /* felt or not */ });
  }

  dispose() {
    this.hits?.cancel();
    this.model.dispose();
    this.root.removeFromParent();
  }

  private holdController(frame: XRFrame, space: XRReferenceSpace): boolean {
    const { gripSpace } = this.source, grip = gripSpace && frame.getPose(gripSpace, space);
    if (!grip) return false;
    this.carrier.fromArray(grip.transform.matrix);
    this.grip.setFromMatrixPosition(this.carrier);
    this.tip.setFromMatrixPosition(this.aim);
    this.model.showController(this.carrier);
    return true;
  }

  private holdBare(frame: XRFrame, space: XRReferenceSpace, hand: XRHand): boolean {
    if (!frame.getJointPose) return false;
    let joint = 0;
    for (const at of hand.values()) this.model.showJoint(joint++, frame.getJointPose(at, space));
    const pose = (name: XRHandJoint) => {
      const at = hand.get(name);
      return at && frame.getJointPose!(at, space)?.transform;
    };
    const thumb = pose('thumb-tip'), finger = pose('index-finger-tip'), wrist = pose('wrist');
    if (!thumb || !finger || !wrist) return false;
    this.tip.set(finger.position.x, finger.position.y, finger.position.z);
    this.grip.set(thumb.position.x, thumb.position.y, thumb.position.z).add(this.tip).multiplyScalar(0.5);
    this.carrier.fromArray(wrist.matrix);
    return true;
  }
}
