// Handles as spheres, and the bones between them.
import {
  Box2, BufferAttribute, BufferGeometry, Camera, Color, Group, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4,
  MeshStandardMaterial, PerspectiveCamera, SphereGeometry, Vector2, Vector3,
} from 'three';
import type { SessionState } from '../engine/messages';
import { boneColor, doubtColor, handleColor, hoverColor, pinColor, rootColor, selectedColor } from './palette';

const shrink = 0.8; // of the fitted radius, so that neighbours stay apart
const leastPixels = 6; // where the model is small on the screen fewer, so that the handles do not hide it
const fewestPixels = 3;
const mostCover = 0.05; // all of them, of a square as large as the model
const mostPixels = 26; // a trunk's sphere must not hide the others

/** Metres of the drawn scene that a pixel covers at a point of it. By the camera's place alone: where its world is scaled, three scales its view
 *  matrix with WebXR and not without. */
export function pixelSize(at: Vector3, camera: Camera, height: number): number {
  const ahead = new Vector3().setFromMatrixColumn(camera.matrixWorld, 2).normalize().negate();
  const from = new Vector3().setFromMatrixPosition(camera.matrixWorld);
  const depth = camera instanceof PerspectiveCamera ? Math.max(1e-6, at.clone().sub(from).dot(ahead)) : 1;
  return (2 * depth) / (camera.projectionMatrix.elements[5]! * height);
}

export class HandleView {
  readonly root = new Group();

  private spheres: InstancedMesh | null = null;
  private bones: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;
  private handles: Float32Array = new Float32Array();
  private joints: SessionState['joints'] = [];
  private least = leastPixels; // as of the last frame

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
    const pixel = pixelSize(this.position(joint), camera, height);
    const fitted = shrink * (this.handles[4 * joint + 3] ?? 0);
    return Math.min(Math.max(fitted, this.least * pixel), mostPixels * pixel);
  }

  /** Pixels of the smallest radius that this view of the model has room for. */
  private leastIn(camera: Camera, height: number): number {
    const { elements } = camera.projectionMatrix, width = (height * elements[5]!) / elements[0]!, spread = new Box2();
    for (let joint = 0; joint < this.count; ++joint) {
      const { x, y } = this.position(joint).project(camera);
      spread.expandByPoint(new Vector2((x * width) / 2, (y * height) / 2));
    }
    const { x, y } = spread.getSize(new Vector2());
    return Math.min(leastPixels, Math.max(fewestPixels, Math.max(x, y) * Math.sqrt(mostCover / (Math.PI * this.count))));
  }

  paint(selected: ReadonlySet<number>, hovered: number | null, pinned: ReadonlySet<number>, doubted: ReadonlySet<number> = new Set()) {
    for (let joint = 0; this.spheres && joint < this.joints.length; ++joint) {
      const color = selected.has(joint) ? selectedColor : joint === hovered ? hoverColor
        : pinned.has(joint) ? pinColor : doubted.has(joint) ? doubtColor : this.joints[joint]?.parent === -1 ? rootColor : handleColor;
      this.spheres.setColorAt(joint, color);
    }
    if (this.spheres?.instanceColor) this.spheres.instanceColor.needsUpdate = true;
  }

  /** Before each frame: sizes depend on the camera. */
  fit(camera: Camera, height: number, spheres: boolean, bones: boolean) {
    if (!this.spheres || !this.bones || this.joints.length !== this.count) return;
    this.spheres.visible = spheres;
    this.bones.visible = bones;
    this.least = this.leastIn(camera, height);
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
      const pixels = this.drawnRadius(joint, camera, height) / pixelSize(this.position(joint), camera, height);
      const met = beside <= pixels;
      if (!met && beside > slop) continue;
      const rank = met ? place.z : beside;
      if ((bestMet && !met) || (met === bestMet && rank >= bestRank)) continue;
      best = joint, bestRank = rank, bestMet = met;
    }
    return best;
  }
}
