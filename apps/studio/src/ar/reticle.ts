// A ring on the real surface, where the model will stand.
import { DoubleSide, Mesh, MeshBasicMaterial, RingGeometry, type Matrix4 } from 'three';
import { rootColor } from '../scene/palette';

const inner = 0.07, outer = 0.09; // metres

export class Reticle {
  readonly root: Mesh;

  constructor() {
    const geometry = new RingGeometry(inner, outer, 48).rotateX(-Math.PI / 2);
    this.root = new Mesh(geometry, new MeshBasicMaterial({ color: rootColor, side: DoubleSide, transparent: true, opacity: 0.9, depthTest: false }));
    this.root.matrixAutoUpdate = false;
    this.root.renderOrder = 3;
    this.root.visible = false;
  }

  /** In the room. */
  show(at: Matrix4 | null) {
    this.root.visible = at !== null;
    if (at) this.root.matrix.copy(at);
    this.root.updateMatrixWorld(true);
  }

  dispose() {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    (this.root.material as MeshBasicMaterial).dispose();
  }
}
