// What the page asks of a rear camera that it looks through itself, without WebXR.
import type { Matrix4 } from 'three';

/** One picture of the camera. */
export interface Glimpse {
  /** Of the camera in the real place: metres, y up, the surface that is stood on at y = 0; it looks along -z, its y is
   *  up in the picture. Null while the place is not known. */
  camera: Matrix4 | null;
  /** Degrees from the picture's lower to its upper edge. */
  fieldOfView: number;
}

export interface CameraSight {
  /** Card: six degrees of freedom from a printed card. Camera: turns only, by the device's sensors. */
  readonly kind: 'card' | 'camera';
  /** The camera's picture, shown behind the model. */
  readonly video: HTMLVideoElement;
  /** Asks for the camera; throws what `getUserMedia` throws where it is refused or there is none. Stopped then, too. */
  start(): Promise<void>;
  /** Called for each picture of the camera, and with `camera: null` where the place was lost. */
  onGlimpse: (glimpse: Glimpse) => void;
  /** The camera is free again. */
  stop(): void;
}
