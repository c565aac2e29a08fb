// What is drawn of a hand: its joints as spheres or a plain controller, and its ray.
import { CapsuleGeometry, CylinderGeometry, Group, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial, SphereGeometry } from 'three';
import { selectedColor } from '../../scene/palette';
import { markLayer } from '../ar_view';
import type { Hand } from './hand';

const jointCount = 25; // WebXR Hand Input
const usualRadius = 0.008; // metres of a joint that tells none

export class HandModel {
  readonly root = new Group();

  private readonly skin = new MeshStandardMaterial({ color: 0xd9dee8, roughness: 0.6, emissive: 0x20242c });
  private readonly glow = new MeshBasicMaterial({ color: selectedColor, toneMapped: false });
  private readonly joints: InstancedMesh | null;
  private readonly controller: Mesh | null;
  /** Of a metre, along -z. */
  private readonly beam = new Mesh(new CylinderGeometry(0.0008, 0.0025, 1, 8).translate(0, 0.5, 0).rotateX(-Math.PI / 2), this.glow);
  private readonly dot = new Mesh(new SphereGeometry(0.006, 16, 12), this.glow);
  private readonly ray = new Group();

  constructor(private hand: Hand, bare: boolean) {
    this.joints = bare ? new InstancedMesh(new SphereGeometry(1, 12, 8), this.skin, jointCount) : null;
    // From the grip's middle to where the finger lies; WebXR's grip has the rod along its -z.
    this.controller = bare ? null : new Mesh(new CapsuleGeometry(0.016, 0.07, 6, 16).rotateX(Math.PI / 2), this.skin);
    this.ray.matrixAutoUpdate = false;
    this.ray.add(this.beam, this.dot);
    this.root.add(this.ray);
    if (this.joints) {
      this.joints.frustumCulled = false;
      this.root.add(this.joints);
    }
    if (this.controller) {
      this.controller.matrixAutoUpdate = false;
      this.controller.visible = false;
      this.root.add(this.controller);
    }
    this.root.traverse((part) => part.layers.enable(markLayer));
  }

  showController(carrier: Matrix4) {
    if (!this.controller) return;
    this.controller.visible = true;
    this.controller.matrix.copy(carrier);
  }

  showJoint(joint: number, pose: XRJointPose | undefined) {
    if (!this.joints || joint >= jointCount) return;
    const radius = pose?.radius ?? (pose ? usualRadius : 0), matrix = new Matrix4().makeScale(radius, radius, radius);
    if (pose) matrix.setPosition(pose.transform.position.x, pose.transform.position.y, pose.transform.position.z);
    this.joints.setMatrixAt(joint, matrix);
    this.joints.instanceMatrix.needsUpdate = true;
  }

  draw() {
    const { rayLength, aim } = this.hand;
    this.ray.visible = rayLength !== null;
    if (rayLength === null) return;
    this.ray.matrix.copy(aim);
    this.beam.scale.z = rayLength;
    this.dot.position.z = -rayLength;
  }

  dispose() {
    for (const part of [this.joints, this.controller, this.beam, this.dot]) part?.geometry.dispose();
    this.joints?.dispose();
    this.skin.dispose();
    this.glow.dispose();
  }
}
