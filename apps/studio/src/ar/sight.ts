// What augmented reality looks through: WebXR on a phone or a headset, or a camera behind the page (CameraSight).
import type { Group, Matrix4, PerspectiveCamera, Texture, WebGLRenderer } from 'three';
import type { ArState } from '../app/state';

/** Where a finger is on what is looked through, in pixels of the page. */
export interface Spot { x: number; y: number }

/** What a sight works with, and tells. The room is the real place: metres, y up. */
export interface Looker {
  readonly renderer: WebGLRenderer;
  readonly room: Group;
  /** Child of the room. */
  readonly eye: PerspectiveCamera;
  /** All that is shown on the screen beside what is drawn. */
  readonly overlay: HTMLElement;
  /** The eye stands where the device does, its projection is the device's: the frame is drawn now. Where the place is not
   *  known (`known` false) the last one stays. */
  frame(known: boolean): void;
  /** The session about to begin estimates the real light. */
  expectLight(): void;
  /** Nobody sees it, or again somebody does. */
  hide(hidden: boolean): void;
  /** Fingers where no DOM overlay hears them: `null` is lifted. */
  finger(id: number, spot: Spot | null, phase: 'down' | 'move' | 'up' | 'cancel'): void;
  /** It has ended by itself. */
  ended(): void;
}

export interface Sight {
  readonly kind: ArState['sight'];
  /** Whether pointer events of the overlay say what fingers do. */
  readonly hasOverlay: boolean;
  /** Looks from then on. Throws what the browser throws where it may not. */
  start(looker: Looker): Promise<void>;
  /** In this frame, in the room: where something real is met on which a model can stand, below the spot or, without one,
   *  in the middle of the view. */
  meets(spot: Spot | null): Matrix4 | null;
  /** Keeps an eye on a place of the room, where the device can: where that is as far as it knows by now, frame by frame. */
  watchOver(at: Matrix4): void;
  readonly watched: Matrix4 | null;
  /** In this frame: what the camera sees, where the browser gives it. */
  seen(): Texture | HTMLVideoElement | null;
  end(): Promise<void>;
}
