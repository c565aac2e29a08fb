// How far joints may turn: a fan for a hinge, a cone for a ball, at the joint, along its bone.
import {
  BufferAttribute, BufferGeometry, DoubleSide, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial,
} from 'three';
import type { SessionState } from '../engine/messages';
import { limitColor } from './palette';
import type { HandleView } from './handle_view';

const size = 0.6; // of the bone's length

interface Cone {
  joint: number;
  parent: number;
  group: Group;
}

export class LimitView {
  readonly root = new Group();
  private fill = new MeshBasicMaterial({ color: limitColor, transparent: true, opacity: 0.28, side: DoubleSide, depthWrite: false, depthTest: false });
  private edge = new LineBasicMaterial({ color: limitColor, transparent: true, opacity: 0.9, depthTest: false });
  private cones: Cone[] = [];
  private shown = '';

  show(session: SessionState) {
    const now = JSON.stringify(session.limit_outlines);
    if (now === this.shown) return;
    this.shown = now;
    this.root.clear();
    this.cones = session.limit_outlines.map(({ joint, length, closed, rim }) => {
      const group = new Group();
      const points = rim.map((at) => at.map((value) => value * size * length));
      const ends = closed ? [...points, points[0]!] : points;
      const sides = ends.flatMap((at, i) => (i + 1 < ends.length ? [[0, 0, 0], at, ends[i + 1]!] : []));
      const lines = ends.flatMap((at, i) => (i + 1 < ends.length ? [at, ends[i + 1]!] : []));
      if (!closed) lines.push([0, 0, 0], ends[0]!, [0, 0, 0], ends.at(-1)!);
      group.add(new Mesh(geometryOf(sides), this.fill), new LineSegments(geometryOf(lines), this.edge));
      group.children.forEach((part) => {
        part.renderOrder = 3;
        part.frustumCulled = false;
      });
      group.matrixAutoUpdate = false;
      this.root.add(group);
      return { joint, parent: session.joints[joint]?.parent ?? -1, group };
    });
  }

  /** A limit is about how its joint stands to the joint above: it turns with that one. */
  take(handles: HandleView, skin: Float32Array) {
    for (const { joint, parent, group } of this.cones) {
      if (parent < 0) group.matrix.identity();
      else group.matrix.extractRotation(new Matrix4().fromArray(skin, 16 * parent));
      group.matrix.setPosition(handles.position(joint));
    }
  }
}

function geometryOf(points: number[][]): BufferGeometry {
  return new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(points.flat()), 3));
}
