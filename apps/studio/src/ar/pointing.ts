// What holds a model from afar: a finger on the screen, or the ray of a hand.
import type { Ray, Vector3 } from 'three';
import { tapDistance } from '../scene/pointer';
import type { ArView } from './ar_view';
import type { Finger } from './gesture';
import { onLevel } from './room';

/** Everything in the world. */
export interface Pointing {
  /** More than a tap. */
  readonly moved: boolean;
  ray(): Ray;
  /** Where something real is met. */
  meets(): Vector3 | null;
  /** Where a point goes that was held there and stays at its height. */
  carry(held: Vector3): Vector3 | null;
}

export const pointingOf = (ar: ArView, finger: Finger): Pointing => ({
  get moved() { return Math.hypot(finger.x - finger.from.x, finger.y - finger.from.y) > tapDistance; },
  ray: () => ar.ray(finger),
  meets: () => ar.meets(finger),
  carry: (held) => onLevel(ar.ray(finger), held),
});
