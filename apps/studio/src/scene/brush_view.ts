// The brush as a ring on the surface.
import { BufferGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineLoop, Vector3 } from 'three';
import type { SurfaceHit } from '../engine/messages';

const sides = 64;
const up = new Vector3(0, 0, 1);

/** A dark and a light line beside each other are seen on every colour. */
export class BrushView {
  readonly root = new Group();

  constructor() {
    const circle: number[] = [];
    for (let i = 0; i < sides; ++i) circle.push(Math.cos((2 * Math.PI * i) / sides), Math.sin((2 * Math.PI * i) / sides), 0);
    const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(circle, 3));
    for (const [color, scale] of [['#111827', 1], ['#ffffff', 0.97]] as const) {
      const ring = new LineLoop(geometry, new LineBasicMaterial({ color, depthTest: false, transparent: true }));
      ring.scale.setScalar(scale);
      ring.renderOrder = 3;
      ring.frustumCulled = false;
      this.root.add(ring);
    }
    this.root.visible = false;
  }

  show(hit: SurfaceHit, radius: number) {
    this.root.visible = true;
    this.root.position.set(...hit.position);
    this.root.quaternion.setFromUnitVectors(up, new Vector3(...hit.normal));
    this.root.scale.setScalar(radius);
  }

  hide() { this.root.visible = false; }
}
