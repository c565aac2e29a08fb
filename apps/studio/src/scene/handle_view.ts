// Handles as spheres, and the bones between them.
import {
  BufferAttribute, BufferGeometry, Camera, Color, Group, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4,
  MeshStandardMaterial, PerspectiveCamera, SphereGeometry, Vector3,
} from 'three';
import type { SessionState } from '../engine/messages';
import { boneColor, handleColor, hoverColor, pinColor, rootColor, selectedColor } from './palette';

const shrink = 0.8; // of the fitted radius, so that neighbours stay apart
const leastPixels = 6;
const mostPixels = 26; // a trunk's sphere must not hide the others

/** Metres of the drawn scene that a pixel covers at a distance of one metre of the camera's world (perspective), or
 *  anywhere (orthographic). */
export function pixelSize(camera: Camera, height: number): number {
  return (2 * new Vector3().setFromMatrixColumn(camera.matrixWorld, 0).length()) / (camera.projectionMatrix.elements[5]! * height);
}

export class HandleView {
  readonly root = new Group();

  private spheres: InstancedMesh | null = null;
  private bones: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;
  private handles: Float32Array = new Float32Array();
  private joints: SessionState['joints'] = [];

  get count() { return this.handles.length / 4; }

  position(joint: number, target = new Vector3()): Vector3 {
    return target.fromArray(this.handles, 4 * joint);
  }

  show(joints: SessionState['joints']) {
    if (this.spheres && this.joints.length === joints.length) {
      this.joints = joints;
      return;
    }
    this.joints = joints;
    this.spheres?.dispose();
    this.bones?.geometry.dispose();
    this.root.clear();
    const material = new MeshStandardMaterial({ color: 0xffffff, roughness: 0.4, emissive: 0x55060e });
    this.spheres = new InstancedMesh(new SphereGeometry(1, 24, 16), material, joints.length);
    this.spheres.frustumCulled = false;
    this.spheres.renderOrder = -1; // before the translucent surface
    const lines = new BufferGeometry();
    lines.setAttribute('position', new BufferAttribute(new Float32Array(6 * joints.length), 3));
    lines.setAttribute('color', new BufferAttribute(new Float32Array(6 * joints.length), 3));
    this.bones = new LineSegments(lines, new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.8, depthTest: false }));
    this.bones.frustumCulled = false;
    this.bones.renderOrder = 2;
    this.root.add(this.spheres, this.bones);
    this.colorBones(joints.map(() => boneColor));
  }

  /** Each bone in the colour of its joint. */
  colorBones(colors: Color[]) {
    const attribute = this.bones?.geometry.getAttribute('color') as BufferAttribute | undefined;
    if (!attribute || attribute.count !== 2 * colors.length) return;
    colors.forEach(({ r, g, b }, joint) => attribute.setXYZ(2 * joint, r, g, b).setXYZ(2 * joint + 1, r, g, b));
    attribute.needsUpdate = true;
  }

  take(handles: Float32Array) {
    this.handles = handles;
    if (!this.bones || this.joints.length !== this.count) return;
    const ends = this.bones.geometry.getAttribute('position') as BufferAttribute;
    this.joints.forEach(({ parent }, joint) => {
      const from = parent < 0 ? joint : parent;
      ends.setXYZ(2 * joint, this.handles[4 * joint]!, this.handles[4 * joint + 1]!, this.handles[4 * joint + 2]!);
      ends.setXYZ(2 * joint + 1, this.handles[4 * from]!, this.handles[4 * from + 1]!, this.handles[4 * from + 2]!);
    });
    ends.needsUpdate = true;
  }

  /** Draws one where it is held, until the next stance. */
  hold(joint: number, at: Vector3) {
    const handles = this.handles.slice();
    at.toArray(handles, 4 * joint);
    this.take(handles);
  }

  /** The radius that a handle is drawn with, in metres. */
  drawnRadius(joint: number, camera: Camera, height: number): number {
    const pixel = pixelSize(camera, height) * this.depth(joint, camera);
    const fitted = shrink * (this.handles[4 * joint + 3] ?? 0);
    return Math.min(Math.max(fitted, leastPixels * pixel), mostPixels * pixel);
  }

  private depth(joint: number, camera: Camera): number {
    if (!(camera instanceof PerspectiveCamera)) return 1;
    return Math.max(1e-6, -this.position(joint).applyMatrix4(camera.matrixWorldInverse).z);
  }

  paint(selected: ReadonlySet<number>, hovered: number | null, pinned: ReadonlySet<number>) {
    for (let joint = 0; this.spheres && joint < this.joints.length; ++joint) {
      const color = selected.has(joint) ? selectedColor : joint === hovered ? hoverColor
        : pinned.has(joint) ? pinColor : this.joints[joint]?.parent === -1 ? rootColor : handleColor;
      this.spheres.setColorAt(joint, color);
    }
    if (this.spheres?.instanceColor) this.spheres.instanceColor.needsUpdate = true;
  }

  /** Before each frame: sizes depend on the camera. */
  fit(camera: Camera, height: number, spheres: boolean, bones: boolean) {
    if (!this.spheres || !this.bones || this.joints.length !== this.count) return;
    this.spheres.visible = spheres;
    this.bones.visible = bones;
    const matrix = new Matrix4();
    for (let joint = 0; joint < this.count; ++joint) {
      const radius = this.drawnRadius(joint, camera, height);
      matrix.makeScale(radius, radius, radius).setPosition(this.position(joint));
      this.spheres.setMatrixAt(joint, matrix);
    }
    this.spheres.instanceMatrix.needsUpdate = true;
  }

  /** Those whose middle is in a box of the view, in pixels. */
  within(box: { left: number; top: number; right: number; bottom: number }, camera: Camera, width: number, height: number): number[] {
    return Array.from({ length: this.count }, (_, joint) => joint).filter((joint) => {
      const place = this.position(joint).project(camera), x = (place.x + 1) / 2 * width, y = (1 - place.y) / 2 * height;
      return place.z <= 1 && x >= box.left && x <= box.right && y >= box.top && y <= box.bottom;
    });
  }

  /** The handle under a pointer, at least `slop` pixels wide; the one in front of those that are drawn there. */
  pick(x: number, y: number, camera: Camera, width: number, height: number, slop: number): number | null {
    let best: number | null = null, bestRank = Infinity, bestMet = false;
    for (let joint = 0; joint < this.count; ++joint) {
      const place = this.position(joint).project(camera);
      if (place.z > 1) continue;
      const beside = Math.hypot((place.x + 1) / 2 * width - x, (1 - place.y) / 2 * height - y);
      const pixels = this.drawnRadius(joint, camera, height) / (pixelSize(camera, height) * this.depth(joint, camera));
      const met = beside <= pixels;
      if (!met && beside > slop) continue;
      const rank = met ? place.z : beside;
      if ((bestMet && !met) || (met === bestMet && rank >= bestRank)) continue;
      best = joint, bestRank = rank, bestMet = met;
    }
    return best;
  }
}
