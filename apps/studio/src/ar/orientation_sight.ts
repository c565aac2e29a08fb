// The camera behind the model, held in place by the device's orientation: it turns with the device, and walking does not
// move it. For a camera without a card, and a browser without WebXR.
import { Euler, MathUtils, Matrix4, Quaternion, Vector3 } from 'three';
import type { CameraSight, Glimpse } from './camera_sight';
import { guessedFieldOfView, rearCamera } from './rear_camera';

/** Metres above the floor: a phone in front of the chest of who stands. Nothing measures it. */
const held = 1.4;
const patience = 1500; // milliseconds until the first word of the sensors

export interface Turns { alpha: number; beta: number; gamma: number }

/** Thrown by `start` where the device keeps to itself how it is turned, or has no sensors. */
export class NoOrientation extends Error {
  constructor(readonly refused: boolean) { super(refused ? 'motion sensors are not allowed' : 'no orientation is given'); }
}

/** Safari asks the user, and only within a tap. */
type Asking = typeof DeviceOrientationEvent & { requestPermission?: () => Promise<'granted' | 'denied'> };

export class OrientationSight implements CameraSight {
  readonly kind = 'camera';
  onGlimpse: (glimpse: Glimpse) => void = () => {};
  private camera = rearCamera();
  private turns: Turns | null = null;

  get video() { return this.camera.video; }

  async start() {
    // Both are asked for within the tap, the sensors first: their question needs it.
    await allowed();
    await this.camera.open(1280, 720);
    await this.firstTurns();
    screen.orientation?.addEventListener('change', this.tell);
    this.tell();
  }

  stop() {
    removeEventListener('deviceorientation', this.take);
    screen.orientation?.removeEventListener('change', this.tell);
    this.camera.close();
  }

  private firstTurns(): Promise<void> {
    return new Promise((resolve, reject) => {
      const late = setTimeout(() => {
        removeEventListener('deviceorientation', first);
        reject(new NoOrientation(false));
      }, patience);
      const first = () => {
        if (!this.turns) return;
        removeEventListener('deviceorientation', first);
        clearTimeout(late);
        resolve();
      };
      addEventListener('deviceorientation', this.take);
      addEventListener('deviceorientation', first);
    });
  }

  /** A device without sensors sends one event with nothing in it. */
  private take = ({ alpha, beta, gamma }: DeviceOrientationEvent) => {
    if (alpha === null || beta === null || gamma === null) return;
    this.turns = { alpha, beta, gamma };
    this.tell();
  };

  private tell = () => {
    if (this.turns) this.onGlimpse({ camera: cameraTurned(this.turns, screenTurn()), fieldOfView: guessedFieldOfView(this.video) });
  };
}

async function allowed() {
  const events = globalThis.DeviceOrientationEvent as Asking | undefined;
  if (!events) throw new NoOrientation(false);
  const answer = await events.requestPermission?.().catch(() => 'denied');
  if (answer === 'denied') throw new NoOrientation(true);
}

/** Degrees by which what is shown is turned against the device. */
const screenTurn = () => screen.orientation?.angle ?? (globalThis as { orientation?: number }).orientation ?? 0;

/** The camera in a room with y up. The angles are those of the W3C's Device Orientation: about z (up), x (right) and y (to
 *  the screen's top), in this order, the earth's z up; the camera looks out of the device's back. */
export function cameraTurned({ alpha, beta, gamma }: Turns, screenAngle: number): Matrix4 {
  const radians = MathUtils.degToRad;
  const device = new Quaternion().setFromEuler(new Euler(radians(beta), radians(alpha), -radians(gamma), 'YXZ'));
  const outOfTheBack = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), -Math.PI / 2);
  const asShown = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), -radians(screenAngle));
  return new Matrix4().makeRotationFromQuaternion(device.multiply(outOfTheBack).multiply(asShown)).setPosition(0, held, 0);
}
