// What a surface looks like: a material of three.js for each of the model's, and the pictures on it.
import { Color, DoubleSide, MeshStandardMaterial, RepeatWrapping, SRGBColorSpace, Texture } from 'three';
import type { SurfaceModel } from '../engine/messages';

const unpainted = '#b9c0ca';

/** Of a part's material, null where it has none; without its picture. */
export function plainMaterial(source: SurfaceModel['materials'][number] | null): MeshStandardMaterial {
  const color = source ? new Color(...source.color.slice(0, 3) as [number, number, number]) : new Color(unpainted);
  return new MeshStandardMaterial({ color, roughness: 0.75, metalness: 0, side: DoubleSide });
}

/** Rejects where the browser cannot read the picture. */
export async function loadTexture(bytes: Uint8Array): Promise<Texture> {
  const bitmap = await createImageBitmap(new Blob([bytes as BlobPart]), { imageOrientation: 'flipY' });
  const texture = new Texture(bitmap);
  texture.flipY = false;
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}
