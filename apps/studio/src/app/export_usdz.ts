// The posed surfaces of the scene as USDZ, which phones show in augmented reality. Loaded when it is first asked for.
import { Group, Matrix4, type Object3D } from 'three';
import { USDZExporter } from 'three/examples/jsm/exporters/USDZExporter.js';
import type { Stage } from '../scene/stage';

export async function posedUsdz({ model, others, viewport }: Pick<Stage, 'model' | 'others' | 'viewport'>): Promise<Uint8Array> {
  const scene: Object3D = new Group(), chosen = model.posed();
  chosen.applyMatrix4(new Matrix4().copy(viewport.world.matrix).invert());
  scene.add(chosen, ...others.posed());
  return new USDZExporter().parseAsync(scene);
}
