// The light of the real place where the device estimates it; the desk's soft light until then and otherwise.
import { LightProbe, Matrix3, Matrix4, Quaternion, SphericalHarmonics3, Vector3 } from 'three';
import { XREstimatedLight } from 'three/examples/jsm/webxr/XREstimatedLight.js';
import type { Viewport } from '../scene/viewport';
import type { Room } from './room';

export class ArLight {
  private estimated: XREstimatedLight;
  /** In the directions of what is drawn: three takes a probe's to be those of its scene. */
  private probe = new LightProbe();
  private known = false;

  /** Before the session begins. */
  constructor(private viewport: Viewport, private room: Room) {
    this.estimated = new XREstimatedLight(viewport.renderer, false);
    this.estimated.addEventListener('estimationstart', () => this.use(true));
    this.estimated.addEventListener('estimationend', () => this.use(false));
  }

  /** With each frame. */
  follow() {
    if (!this.known) return;
    const turn = new Quaternion();
    this.room.group.matrixWorld.decompose(new Vector3(), turn, new Vector3());
    this.probe.sh.copy(turned(this.estimated.lightProbe.sh, turn));
    this.probe.intensity = this.estimated.lightProbe.intensity;
  }

  dispose() {
    this.use(false);
    this.estimated.dispose();
  }

  private use(known: boolean) {
    this.known = known;
    this.viewport.lights.visible = !known;
    const { directionalLight } = this.estimated;
    if (known) {
      this.room.group.add(directionalLight, directionalLight.target);
      this.viewport.scene.add(this.probe);
    } else for (const part of [directionalLight, directionalLight.target, this.probe]) part.removeFromParent();
  }
}

// Factors of the second order's functions: Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance
// Environment Maps, 2001, eq. 3.
const xy = 1.092548, zz = 0.315392, xxyy = 0.546274;

/** What comes from one side comes from the turned side: the first order is a vector, the second a symmetric matrix without
 *  a trace. */
export function turned(light: SphericalHarmonics3, turn: Quaternion): SphericalHarmonics3 {
  const result = light.clone(), r = new Matrix3().setFromMatrix4(new Matrix4().makeRotationFromQuaternion(turn)), back = r.clone().transpose();
  for (const channel of ['x', 'y', 'z'] as const) {
    const c = light.coefficients.map((coefficient) => coefficient[channel]) as Nine;
    const first = new Vector3(c[3], c[1], c[2]).applyMatrix3(r);
    const second = r.clone().multiply(new Matrix3().set(
      xxyy * c[8] - zz * c[6], (xy * c[4]) / 2, (xy * c[7]) / 2,
      (xy * c[4]) / 2, -xxyy * c[8] - zz * c[6], (xy * c[5]) / 2,
      (xy * c[7]) / 2, (xy * c[5]) / 2, 2 * zz * c[6],
    )).multiply(back).transpose().elements as unknown as Nine; // three keeps columns
    const now = [
      c[0], first.y, first.z, first.x, (2 * second[1]) / xy, (2 * second[5]) / xy, second[8] / (2 * zz), (2 * second[2]) / xy, (second[0] - second[4]) / (2 * xxyy),
    ];
    now.forEach((value, i) => { result.coefficients[i]![channel] = value; });
  }
  return result;
}

type Nine = [number, number, number, number, number, number, number, number, number];
