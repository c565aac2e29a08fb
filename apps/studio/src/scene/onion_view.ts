// Ghosts: the character's bones some moments before and after the one that is shown, and the path of the selected joint.
import { Color, Group, Points, BufferGeometry, Float32BufferAttribute, PointsMaterial } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { PageState } from '../app/state';
import type { Paths } from '../engine/messages';
import { afterColor, beforeColor, selectedColor } from './palette';

const each = 3; // ghosts before, and as many after
const apart = 0.1; // seconds between ghosts of recorded motion
const faintest = 0.25, clearest = 0.7; // opacity of the furthest and the nearest

interface Ghost {
  root: LineSegments2;
  /** -1 is the one before the moment that is shown, 1 the one after it. */
  order: number;
}

export class OnionView {
  readonly root = new Group();
  private ghosts: Ghost[] = [];
  private trail = new Line2(new LineGeometry(), new LineMaterial({ color: selectedColor.getHex(), linewidth: 2.5, transparent: true, opacity: 0.85, depthTest: false }));
  private dots = new Points(new BufferGeometry(), new PointsMaterial({ color: selectedColor, size: 5, sizeAttenuation: false, depthTest: false, transparent: true }));
  private shown: { paths: Paths | null; selected: number | null } = { paths: null, selected: null };

  constructor() {
    for (let order = -each; order <= each; ++order) {
      if (order === 0) continue;
      const near = (each - Math.abs(order)) / (each - 1), color = order < 0 ? beforeColor : afterColor;
      const root = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({
        color: new Color(color).getHex(), linewidth: 3, transparent: true, opacity: faintest + near * (clearest - faintest), depthTest: false,
      }));
      this.ghosts.push({ root, order });
    }
    for (const part of [...this.ghosts.map(({ root }) => root), this.trail, this.dots]) {
      part.frustumCulled = false;
      part.renderOrder = 2;
      this.root.add(part);
    }
  }

  /** Draws anew what has changed. */
  show({ session, paths, ghosts, seconds, selected }: PageState) {
    const clip = session?.clips[session.clip ?? -1], joints = session?.joints.length ?? 0;
    const ready = ghosts && paths !== null && clip !== undefined && paths.places.length === 3 * joints * paths.moments.length && paths.moments.length > 1;
    this.root.visible = ready;
    if (!ready || !session || !clip) return;
    const keys = clip.recorded ? [] : clip.keys;
    for (const { root, order } of this.ghosts) {
      const moment = momentOf(order, seconds, clip.duration, keys);
      root.visible = moment !== null;
      if (moment === null) continue;
      const ends: number[] = [];
      const place = placesAt(paths, moment, joints);
      session.joints.forEach(({ parent }, joint) => {
        if (parent >= 0) ends.push(...place(parent), ...place(joint));
      });
      root.geometry.setPositions(ends);
    }
    if (paths !== this.shown.paths || selected !== this.shown.selected) this.drawTrail(paths, selected, joints);
    this.shown = { paths, selected };
  }

  private drawTrail({ moments, places }: Paths, joint: number | null, joints: number) {
    this.trail.visible = this.dots.visible = joint !== null;
    if (joint === null) return;
    const path = moments.flatMap((_, i) => [...places.subarray(3 * (i * joints + joint), 3 * (i * joints + joint) + 3)]);
    this.trail.geometry.dispose();
    this.trail.geometry = new LineGeometry();
    this.trail.geometry.setPositions(path);
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(path, 3));
  }
}

/** Clips made by hand show their keys, recorded motion even steps; null where the clip has no such moment. */
function momentOf(order: number, seconds: number, duration: number, keys: number[]): number | null {
  if (keys.length > 0) {
    const beside = order < 0 ? keys.filter((key) => key < seconds - 1e-3).reverse() : keys.filter((key) => key > seconds + 1e-3);
    return beside[Math.abs(order) - 1] ?? null;
  }
  const moment = seconds + order * apart;
  return moment >= 0 && moment <= duration ? moment : null;
}

/** Where each joint is at a moment between those that are known. */
function placesAt({ moments, places }: Paths, moment: number, joints: number) {
  const next = Math.max(1, Math.min(moments.length - 1, moments.findIndex((at) => at >= moment)));
  const from = moments[next - 1]!, weight = Math.max(0, Math.min(1, (moment - from) / (moments[next]! - from)));
  return (joint: number) => [0, 1, 2].map((i) => {
    const before = places[3 * ((next - 1) * joints + joint) + i]!, after = places[3 * (next * joints + joint) + i]!;
    return before + weight * (after - before);
  });
}
