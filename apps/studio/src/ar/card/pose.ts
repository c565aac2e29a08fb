// Where the card is before the camera, from its four corners in the picture. Pinhole camera: x to the right, y down, z forward,
// metres. Card: its middle at the origin, x to its right, y up out of it, z to its lower edge, so that a card on a table has
// the room's axes. Zhang 2000 (start from the homography); the mirrored start for the second minimum as in Schweighofer and Pinz 2006.
import { Matrix4, Quaternion, Vector3 } from 'three';
import type { Corner, Corners } from './card';

/** Focal length and the middle of the picture, in pixels. */
export interface Lens { focal: number; x: number; y: number }
export interface Pose {
  /** Of the card before the camera. */
  rotation: Quaternion;
  position: Vector3;
  /** Root mean square between the corners seen and those of this pose, in pixels. */
  error: number;
}

export const lensOf = (width: number, height: number, degreesHigh: number): Lens =>
  ({ focal: height / 2 / Math.tan((degreesHigh * Math.PI) / 360), x: width / 2, y: height / 2 });

/** The card's corners in metres. */
export const cardCorners = (side: number) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, z]) => new Vector3((x! * side) / 2, 0, (z! * side) / 2));

/** Null where no card can look like this. */
export function poseOf(corners: Corners, side: number, lens: Lens): Pose | null {
  const start = fromHomography(corners, side, lens);
  if (!start) return null;
  const sight = start.position.clone().normalize(), normal = new Vector3(0, 1, 0).applyQuaternion(start.rotation);
  const mirrored = sight.clone().multiplyScalar(2 * normal.dot(sight)).sub(normal);
  const other = { rotation: new Quaternion().setFromUnitVectors(normal, mirrored).multiply(start.rotation), position: start.position.clone() };
  const poses = [start, other].map((pose) => fitted(pose, corners, cardCorners(side), lens)).filter((pose) => pose !== null);
  return poses.length ? poses.reduce((best, pose) => (pose.error < best.error ? pose : best)) : null;
}

/** From a pose that is near, in a fraction of the time. */
export const poseFrom = (start: Pose, corners: Corners, side: number, lens: Lens) => fitted(start, corners, cardCorners(side), lens);

export function seenAt(point: Vector3, { rotation, position }: Pick<Pose, 'rotation' | 'position'>, lens: Lens): Corner {
  const { x, y, z } = point.clone().applyQuaternion(rotation).add(position);
  return { x: lens.x + (lens.focal * x) / z, y: lens.y + (lens.focal * y) / z };
}

/** Of three's camera (y up, looking along -z) in the room whose origin is the card. */
export function cameraOf({ rotation, position }: Pick<Pose, 'rotation' | 'position'>): Matrix4 {
  return new Matrix4().compose(position, rotation, new Vector3(1, 1, 1)).premultiply(new Matrix4().makeScale(1, -1, -1)).invert();
}

function fromHomography(corners: Corners, side: number, lens: Lens) {
  const rows: number[][] = [], right: number[] = [];
  cardCorners(side).forEach(({ x, z }, i) => {
    const u = (corners[i]!.x - lens.x) / lens.focal, v = (corners[i]!.y - lens.y) / lens.focal;
    rows.push([x, z, 1, 0, 0, 0, -u * x, -u * z], [0, 0, 0, x, z, 1, -v * x, -v * z]);
    right.push(u, v);
  });
  const h = solved(rows, right);
  if (!h) return null;
  const a = new Vector3(h[0], h[3], h[6]), b = new Vector3(h[1], h[4], h[7]), position = new Vector3(h[2], h[5], 1);
  position.multiplyScalar(2 / (a.length() + b.length()));
  const middle = a.normalize().clone().add(b.normalize()).normalize(), across = a.clone().sub(b).normalize();
  const x = middle.clone().add(across).normalize(), z = middle.sub(across).normalize(), y = z.clone().cross(x);
  return { rotation: new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, z)), position };
}

/** Gauss-Newton on the distances in the picture, damped only where a step makes them larger. */
function fitted(start: Pick<Pose, 'rotation' | 'position'>, corners: Corners, points: Vector3[], lens: Lens): Pose | null {
  const errorOf = (pose: Pick<Pose, 'rotation' | 'position'>) =>
    Math.sqrt(points.reduce((sum, point, i) => {
      const { x, y } = seenAt(point, pose, lens);
      return sum + (x - corners[i]!.x) ** 2 + (y - corners[i]!.y) ** 2;
    }, 0) / points.length);
  let pose: Pose = { rotation: start.rotation.clone(), position: start.position.clone(), error: errorOf(start) }, damping = 1e-6;
  for (let round = 0; round < 20; ++round) {
    const square = Array.from({ length: 6 }, () => new Array<number>(6).fill(0)), right = new Array<number>(6).fill(0);
    points.forEach((point, i) => {
      const turned = point.clone().applyQuaternion(pose.rotation), { x, y, z } = turned.clone().add(pose.position), f = lens.focal / z;
      const seen = { x: lens.x + f * x, y: lens.y + f * y };
      // Of a point that turns by w and moves by t: w x turned + t.
      for (const [du, off] of [[new Vector3(f, 0, (-f * x) / z), corners[i]!.x - seen.x], [new Vector3(0, f, (-f * y) / z), corners[i]!.y - seen.y]] as const) {
        const turn = turned.clone().cross(du), slope = [turn.x, turn.y, turn.z, du.x, du.y, du.z];
        for (let r = 0; r < 6; ++r) {
          right[r]! += slope[r]! * off;
          for (let c = 0; c < 6; ++c) square[r]![c]! += slope[r]! * slope[c]!;
        }
      }
    });
    for (let r = 0; r < 6; ++r) square[r]![r]! *= 1 + damping;
    const by = solved(square, right);
    if (!by) return null;
    const turn = new Vector3(by[0], by[1], by[2]), angle = turn.length();
    const next = {
      rotation: new Quaternion().setFromAxisAngle(angle > 0 ? turn.divideScalar(angle) : turn.set(1, 0, 0), angle).multiply(pose.rotation),
      position: new Vector3(by[3], by[4], by[5]).add(pose.position),
    };
    const error = errorOf(next);
    if (error < pose.error && next.position.z > 0) {
      const gain = pose.error - error;
      pose = { ...next, error };
      damping /= 10;
      if (gain < 1e-4 * error + 1e-7) break;
    } else if ((damping = Math.max(damping, 1e-6) * 100) > 1e3) break;
  }
  return new Vector3(0, 1, 0).applyQuaternion(pose.rotation).dot(pose.position) < 0 ? pose : null; // its back is not printed
}

/** Gaussian elimination; null where the rows depend on each other. */
function solved(rows: number[][], right: number[]): number[] | null {
  const n = right.length, m = rows.map((row, i) => [...row, right[i]!]);
  for (let k = 0; k < n; ++k) {
    let pivot = k;
    for (let r = k + 1; r < n; ++r) if (Math.abs(m[r]![k]!) > Math.abs(m[pivot]![k]!)) pivot = r;
    [m[k], m[pivot]] = [m[pivot]!, m[k]!];
    if (!(Math.abs(m[k]![k]!) > 1e-14)) return null;
    for (let r = 0; r < n; ++r) {
      if (r === k) continue;
      const by = m[r]![k]! / m[k]![k]!;
      for (let c = k; c <= n; ++c) m[r]![c]! -= by * m[k]![c]!;
    }
  }
  return m.map((row, k) => row[n]! / row[k]!);
}
