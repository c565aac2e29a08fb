// How far joints may turn: a fan for a hinge, a cone for a ball, at the joint, along its bone.
import {
  BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Quaternion, Vector3,
} from 'three';
import type { SessionState } from '../engine/messages';
import { pinColor } from './palette';
import type { HandleView } from './handle_view';

const steps = 24;
const degrees = Math.PI / 180;
const axes = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };

type Limit = SessionState['limits'][string];
const range = (limit: Limit, name: string): [number, number] | null => {
  const value = limit[name];
  return Array.isArray(value) && value.length === 2 && value.every((end) => typeof end === 'number') ? value as [number, number] : null;
};

export class LimitView {
  readonly root = new Group();
  private material = new MeshBasicMaterial({ color: pinColor, transparent: true, opacity: 0.35, side: DoubleSide, depthTest: false });
  private fans: { joint: number; mesh: Mesh }[] = [];

  /** Directions of the bone from joint to child, turned to each end of what is allowed, in rest pose. */
  show(session: SessionState) {
    this.fans.forEach(({ mesh }) => mesh.geometry.dispose());
    this.root.clear();
    this.fans = [];
    for (const [name, limit] of Object.entries(session.limits)) {
      const joint = session.joints.findIndex((known) => known.name === name);
      const child = session.joints.findIndex((known) => known.parent === joint);
      if (joint < 0 || child < 0) continue;
      const from = new Vector3(...session.joints[joint]!.rest), to = new Vector3(...session.joints[child]!.rest);
      const bone = to.sub(from);
      const rim = rimOf(limit, bone);
      if (rim.length < 2) continue;
      const geometry = new BufferGeometry();
      const values = rim.flatMap((at, i) => (i + 1 < rim.length ? [0, 0, 0, ...at.toArray(), ...rim[i + 1]!.toArray()] : []));
      geometry.setAttribute('position', new BufferAttribute(new Float32Array(values), 3));
      const mesh = new Mesh(geometry, this.material);
      mesh.renderOrder = 3;
      mesh.frustumCulled = false;
      this.fans.push({ joint, mesh });
      this.root.add(mesh);
    }
  }

  take(handles: HandleView) {
    for (const { joint, mesh } of this.fans) handles.position(joint, mesh.position);
  }
}

/** The way round of what the bone's end may reach, at half its length. */
function rimOf(limit: Limit, bone: Vector3): Vector3[] {
  const at = (x: number, y: number, z: number) => bone.clone().multiplyScalar(0.5).applyQuaternion(
    new Quaternion().setFromAxisAngle(axes.z, z * degrees)
      .multiply(new Quaternion().setFromAxisAngle(axes.y, y * degrees))
      .multiply(new Quaternion().setFromAxisAngle(axes.x, x * degrees)));
  const given = (['x', 'y', 'z'] as const).flatMap((name) => {
    const ends = range(limit, name);
    return ends && ends[1] > ends[0] ? [{ name, ends }] : [];
  });
  // The turn about the bone itself moves no bone.
  const along = bone.clone().normalize();
  const swings = given.filter(({ name }) => Math.abs(along.dot(axes[name])) < 0.9);
  const first = swings[0], second = swings[1];
  const turn = (name: 'x' | 'y' | 'z', angle: number) => ({ x: 0, y: 0, z: 0, [name]: angle });
  if (!first) return [];
  if (!second) {
    return Array.from({ length: steps + 1 }, (_, i) => {
      const { x, y, z } = turn(first.name, first.ends[0] + ((first.ends[1] - first.ends[0]) * i) / steps);
      return at(x, y, z);
    });
  }
  return Array.from({ length: steps + 1 }, (_, i) => {
    const angle = (2 * Math.PI * i) / steps;
    const part = ([low, high]: [number, number], share: number) => (share < 0 ? -low : high) * share;
    const a = turn(first.name, part(first.ends, Math.cos(angle))), b = turn(second.name, part(second.ends, Math.sin(angle)));
    return at(a.x + b.x, a.y + b.y, a.z + b.z);
  });
}
