// What a hand would take is ringed by light before it moves.
import { Mesh, MeshBasicMaterial, SphereGeometry, type Vector3 } from 'three';
import { selectedColor } from '../../scene/palette';

const larger = 1.5; // than the handle

export class Halo {
  readonly root = new Mesh(new SphereGeometry(1, 24, 16), new MeshBasicMaterial({ color: selectedColor, transparent: true, opacity: 0.35, depthWrite: false, toneMapped: false }));

  constructor() {
    this.root.renderOrder = 3;
    this.root.visible = false;
  }

  /** In the room. */
  show(at: Vector3 | null, radius = 0) {
    this.root.visible = at !== null;
    if (at) this.root.position.copy(at);
    this.root.scale.setScalar(larger * radius);
  }

  dispose() {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }
}
