// The real place among the models of the scene: metres, y up. A metre of the scene is a metre there.
import { Group, Matrix4, PerspectiveCamera, Plane, Quaternion, Ray, Vector3 } from 'three';

const up = new Vector3(0, 1, 0);
const nearest = 0.05, farthest = 100; // metres that are drawn
const steepest = 0.02; // of a ray against the floor: flatter ones meet it at the horizon

/** Degrees of freedom of what stands: which way it faces, in radians about y. */
const heading = ({ x, z }: Vector3) => Math.atan2(x, z);

export class Room {
  /** Its matrix: the scene's world from the room. */
  readonly group = new Group();
  readonly eye = new PerspectiveCamera(60, 1, nearest, farthest);

  private held: { at: Matrix4; point: Vector3; turn: Quaternion } | null = null;

  constructor() {
    this.group.matrixAutoUpdate = false;
    this.group.add(this.eye);
  }

  /** In the world. */
  toWorld(at: Matrix4): Vector3 { return new Vector3().setFromMatrixPosition(at).applyMatrix4(this.group.matrix); }

  /** Where the device is, in the world. */
  get eyeInWorld(): Vector3 { return this.eye.position.clone().applyMatrix4(this.group.matrix); }

  /** Goes round the scene so that a point of the world, with what looks to that side of it, stands at a place of the room
   *  and looks at the eye. */
  standAt(point: Vector3, front: Vector3, at: Matrix4) {
    const place = new Vector3().setFromMatrixPosition(at);
    const turn = new Quaternion().setFromAxisAngle(up, heading(front) - heading(this.eye.position.clone().sub(place)));
    this.put(turn, point, place);
  }

  /** What is watched over stands where the scene was put on it. */
  hold(at: Matrix4) { this.held = { at: at.clone(), point: this.toWorld(at), turn: new Quaternion().setFromRotationMatrix(this.group.matrix) }; }

  /** By now it is known to be there; upright all the same. */
  correct(now: Matrix4) {
    if (!this.held) return;
    const z = (of: Matrix4) => heading(new Vector3().setFromMatrixColumn(of, 2)), turn = new Quaternion().setFromAxisAngle(up, z(this.held.at) - z(now));
    this.put(turn.premultiply(this.held.turn), this.held.point, new Vector3().setFromMatrixPosition(now));
  }

  /** So turned, with a place of the room on a point of the world. */
  private put(turn: Quaternion, point: Vector3, place: Vector3) {
    this.group.matrix.makeRotationFromQuaternion(turn).setPosition(point.clone().sub(place.clone().applyQuaternion(turn)));
    this.group.updateMatrixWorld(true);
  }
}

/** Where a ray meets the level plane through a point. */
export function onLevel(ray: Ray, through: Vector3): Vector3 | null {
  if (Math.abs(ray.direction.y) < steepest) return null;
  return ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(up, through), new Vector3());
}

/** How something that faces front turns to look from there at the eye, in radians about y. */
export const turnTowards = (front: Vector3, from: Vector3, eye: Vector3) => heading(eye.clone().sub(from)) - heading(front);
