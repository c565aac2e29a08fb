// Grips at a key of a curve that say how steep it runs through it.
import { svg } from '../ui/dom';

const reach = 42; // pixels from the key to a grip
const least = 3; // pixels to the side, so that nothing is infinitely steep

/** Pixels to the right for a second, and upwards for a degree or a metre. */
export interface CurveScale {
  second: number;
  unit: number;
}
export interface Place {
  x: number;
  y: number;
}

/** A line through the key with a grip at each end. `take`: one is pressed, the right (1) or the left (-1). */
export function tangentGrips({ x, y }: Place, slope: number, scale: CurveScale, axis: string, take: (event: PointerEvent, side: 1 | -1) => void): SVGElement[] {
  const angle = Math.atan2(slope * scale.unit, scale.second), [dx, dy] = [reach * Math.cos(angle), -reach * Math.sin(angle)];
  const grips = ([-1, 1] as const).map((side) => {
    const grip = svg('circle', { class: `tangent ${axis}`, r: 4, cx: x + side * dx, cy: y + side * dy, 'data-side': side });
    grip.addEventListener('pointerdown', (event) => take(event, side));
    return grip;
  });
  return [svg('line', { class: `tangent ${axis}`, x1: x - dx, y1: y - dy, x2: x + dx, y2: y + dy }), ...grips];
}

/** How steep the curve is with that grip at the pointer, so far from the key. */
export const slopeTo = (across: number, down: number, side: 1 | -1, scale: CurveScale) =>
  (-side * down / scale.unit) / (Math.max(least, side * across) / scale.second);
