// The posed surface as USDZ, which phones show in augmented reality. Loaded when it is first asked for.
import type { Object3D } from 'three';
import { USDZExporter } from 'three/examples/jsm/exporters/USDZExporter.js';

export async function toUsdz(model: Object3D): Promise<Uint8Array> {
  return new USDZExporter().parseAsync(model);
}
