// Ghosts: the character some moments before and after the one that is shown, and the path of the selected joint.
import { Group, Points, BufferGeometry, Float32BufferAttribute, MeshLambertMaterial, PointsMaterial } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import type { PageState } from '../app/state';
import type { Paths, SurfaceModel } from '../engine/messages';
import type { Likeness, ModelView } from './model_view';
import { afterColor, beforeColor, selectedColor } from './palette';

const clearest = 0.28, fading = 0.6; // opacity of the nearest ghost, and of each further one times this

export class OnionView {
  readonly root = new Group();
  /** By their order; made once each is asked for. */
  private ghosts = new Map<number, Likeness>();
  private trail = new Line2(new LineGeometry(), new LineMaterial({ color: selectedColor.getHex(), linewidth: 2.5, transparent: true, opacity: 0.85, depthTest: false }));
  private dots = new Points(new BufferGeometry(), new PointsMaterial({ color: selectedColor, size: 5, sizeAttenuation: false, depthTest: false, transparent: true }));
  private shown: { model: SurfaceModel | null; paths: Paths | null; selected: number | null } = { model: null, paths: null, selected: null };

  constructor(private model: ModelView) {
    for (const part of [this.trail, this.dots]) {
      part.frustumCulled = false;
      part.renderOrder = 2;
      part.visible = false;
      this.root.add(part);
    }
  }

  /** Draws anew what has changed; the model is shown already. */
  show({ session, model, paths, ghosts, ghostsShown, selected, hiddenParts }: PageState) {
    if (model !== this.shown.model) this.forget();
    this.ghosts.forEach(({ root }) => { root.visible = false; });
    for (const { order, skin } of ghosts ? ghostsShown : []) {
      const ghost = this.ghosts.get(order) ?? this.make(order);
      if (skin.length !== 16 * ghost.joints) continue; // of the model before
      ghost.root.visible = true;
      ghost.root.children.forEach((part, number) => { part.visible = !hiddenParts.has(number); });
      ghost.take(skin);
    }
    const joints = session?.joints.length ?? 0;
    const drawn = ghosts && paths !== null && selected !== null && paths.moments.length > 1 && paths.places.length === 3 * joints * paths.moments.length;
    if (drawn && (paths !== this.shown.paths || selected !== this.shown.selected)) this.drawTrail(paths, selected, joints);
    this.trail.visible = this.dots.visible = drawn;
    this.shown = { model, paths: drawn ? paths : null, selected };
  }

  private make(order: number): Likeness {
    const ghost = this.model.likeness(new MeshLambertMaterial({
      color: order < 0 ? beforeColor : afterColor, transparent: true, opacity: clearest * fading ** (Math.abs(order) - 1), depthWrite: false,
    }));
    this.ghosts.set(order, ghost);
    this.root.add(ghost.root);
    return ghost;
  }

  private forget() {
    this.ghosts.forEach((ghost) => {
      ghost.root.removeFromParent();
      ghost.dispose();
    });
    this.ghosts.clear();
  }

  private drawTrail({ moments, places }: Paths, joint: number, joints: number) {
    const path = moments.flatMap((_, i) => [...places.subarray(3 * (i * joints + joint), 3 * (i * joints + joint) + 3)]);
    this.trail.geometry.dispose();
    this.trail.geometry = new LineGeometry();
    this.trail.geometry.setPositions(path);
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(path, 3));
  }
}
