// Colours of the scene.
import { Color, SRGBColorSpace } from 'three';

export const handleColor = new Color('#dc2f3c');
export const rootColor = new Color('#e8a317');
export const hoverColor = new Color('#ff6b76');
export const selectedColor = new Color('#2563eb');
export const pinColor = new Color('#0f9d6b');
export const doubtColor = new Color('#c026d3');
export const limitColor = new Color('#7c3aed');
export const beforeColor = new Color('#2b7de0');
export const afterColor = new Color('#e07b1a');
export const boneColor = new Color('#374151');

/** Well apart for neighbours in number: steps of the golden angle round the hues. */
export function jointColor(joint: number): Color {
  const hue = (joint * 0.61803398875) % 1;
  return new Color().setHSL(hue, 0.62, joint % 2 === 0 ? 0.55 : 0.66);
}

/** From hue, saturation and value as the engine has them. */
export function partColor([hue, saturation, value]: [number, number, number]): Color {
  const light = value * (1 - saturation / 2), room = Math.min(light, 1 - light);
  return new Color().setHSL(hue, room > 0 ? (value - light) / room : 0, light, SRGBColorSpace);
}

/** From cold, 0, to hot, 1. */
export function heatColor(weight: number): Color {
  return new Color().setHSL(0.62 * (1 - weight), 0.75, 0.42 + 0.1 * weight);
}
