// Whether a model is larger than what is looked through, and how small it has to be to be seen whole.
import { MathUtils, Vector3, type Box3, type Matrix4, type PerspectiveCamera } from 'three';

const whole = 0.7; // of the view: buttons cover its edges
const smallest = 0.01; // times its size
const halvings = 12;

/** Of the view's width or height, whichever is more: infinite where a part is behind the eye. `world`: of the box's space. */
export function shareOfView(box: Box3, world: Matrix4, eye: PerspectiveCamera): number {
  let left = Infinity, right = -Infinity, low = Infinity, high = -Infinity;
  for (let corner = 0; corner < 8; ++corner) {
    const at = new Vector3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z);
    at.applyMatrix4(world).applyMatrix4(eye.matrixWorldInverse);
    if (at.z >= -eye.near) return Infinity;
    at.applyMatrix4(eye.projectionMatrix);
    left = Math.min(left, at.x), right = Math.max(right, at.x), low = Math.min(low, at.y), high = Math.max(high, at.y);
  }
  return Math.max(right - left, high - low) / 2;
}

/** Times its size, about a point that stays. */
export function timesToFit(box: Box3, about: Vector3, world: Matrix4, eye: PerspectiveCamera): number {
  const fits = (times: number) => {
    const scaled = box.clone();
    for (const end of [scaled.min, scaled.max]) end.sub(about).multiplyScalar(times).add(about);
    return shareOfView(scaled, world, eye) <= whole;
  };
  let low = Math.log(smallest), high = 0;
  for (let i = 0; i < halvings; ++i) {
    const middle = MathUtils.lerp(low, high, 0.5);
    if (fits(Math.exp(middle))) low = middle;
    else high = middle;
  }
  return Math.exp(low);
}
