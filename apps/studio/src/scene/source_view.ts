// The skeleton that a motion was made for, as lines beside the model, its chains in the colours of the match.
import { Vector3, type Color } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { PageState } from '../app/state';
import type { SessionState } from '../engine/messages';
import { ModelView } from './model_view';
import { boneColor, jointColor } from './palette';

/** A colour for each joint: that of its part in the match. */
export function matchColors(
  names: string[], match: SessionState['match'], side: 'source' | 'target', others = names.map(() => boneColor),
): Color[] {
  const colors = [...others];
  const places = new Map(names.map((name, joint) => [name, joint]));
  match.forEach((part, index) => {
    for (const name of part[side]) {
      const joint = places.get(name);
      if (joint !== undefined) colors[joint] = jointColor(index);
    }
  });
  return colors;
}

export class SourceView {
  readonly root: LineSegments2;
  /** The model that the motion came with, where it came with one. */
  readonly model = new ModelView();
  private ends = new Float32Array();
  private parents: number[] = [];
  private clip = '';
  private fit: { scale: number; x: number; y: number; z: number } | null = null;
  private box: SessionState['box'] | null = null;
  private rest = new Vector3();
  private shownModel: PageState['sourceModel'] = null;

  constructor() {
    this.root = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ vertexColors: true, linewidth: 5 }));
    this.root.frustumCulled = false;
    this.root.visible = false;
  }

  show(session: SessionState) {
    const clip = session.clips[session.clip ?? -1], source = clip?.source;
    const motion = session.motions.find(({ name }) => name === source?.motion);
    this.box = session.box;
    this.rest.fromArray(session.joints[0]?.rest ?? [0, 0, 0]);
    if (!clip || !source || !motion) {
      this.parents = [];
      this.clip = '';
      return;
    }
    const known = `${session.name} ${source.motion} ${source.clip}`;
    if (known !== this.clip) this.fit = null;
    this.clip = known;
    this.parents = motion.joints.map(({ parent }) => parent);
    const colors = matchColors(motion.joints.map(({ name }) => name), session.match, 'source');
    const values = colors.flatMap(({ r, g, b }) => [r, g, b, r, g, b]);
    this.root.geometry.dispose();
    this.ends = new Float32Array(values.length);
    this.root.geometry = new LineSegmentsGeometry();
    this.root.geometry.setPositions(this.ends);
    this.root.geometry.setColors(new Float32Array(values));
  }

  showModel({ sourceModel, sourceShown, wireframe }: PageState) {
    if (sourceModel !== this.shownModel) {
      this.shownModel = sourceModel;
      if (sourceModel) this.model.show(sourceModel.model, sourceModel.joints);
      else this.model.clear();
    }
    this.model.root.visible = sourceModel !== null && sourceShown;
    if (sourceModel) this.model.setDisplay('handles', null, wireframe);
  }

  /** `root` is where the model's root stands now: the two set out side by side. */
  take(places: Float32Array, skin: Float32Array, root: Vector3) {
    this.root.visible = places.length > 0 && places.length === 3 * this.parents.length;
    if (!this.root.visible || !this.box) return;
    this.fit ??= this.beside(places, this.box, root.clone().sub(this.rest));
    const { scale, x, y, z } = this.fit;
    if (this.shownModel && skin.length === 16 * this.shownModel.joints) this.model.take(skin);
    this.model.root.position.set(x, y, z);
    this.model.root.scale.setScalar(scale);
    this.parents.forEach((parent, joint) => {
      [joint, parent < 0 ? joint : parent].forEach((from, end) => this.ends.set([
        scale * places[3 * from]! + x, scale * places[3 * from + 1]! + y, scale * places[3 * from + 2]! + z,
      ], 6 * joint + 3 * end));
    });
    this.root.geometry.setPositions(this.ends);
  }

  /** As tall as the model, on its ground, at its side. */
  private beside(places: Float32Array, { min, max }: SessionState['box'], way: Vector3) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    places.forEach((value, i) => {
      low[i % 3] = Math.min(low[i % 3]!, value);
      high[i % 3] = Math.max(high[i % 3]!, value);
    });
    const tall = max[1] - min[1];
    const scale = tall / Math.max(1e-9, high[1]! - low[1]!);
    const width = scale * (high[0]! - low[0]!);
    return {
      scale, x: way.x + min[0] - 0.15 * tall - width / 2 - (scale * (low[0]! + high[0]!)) / 2,
      y: min[1] - scale * low[1]!, z: way.z + (min[2] + max[2]) / 2 - (scale * (low[2]! + high[2]!)) / 2,
    };
  }
}
