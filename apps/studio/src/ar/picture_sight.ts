// A camera that the page looks through itself (CameraSight) as a sight: its picture behind the models, its surface at y = 0.
import { MathUtils, Matrix4, Vector3 } from 'three';
import type { CameraSight, Glimpse } from './camera_sight';
import type { Looker, Sight, Spot } from './sight';

const farthest = 20; // metres: beyond, the surface's horizon is near

export class PictureSight implements Sight {
  readonly kind;
  readonly hasOverlay = true;
  private looker: Looker | null = null;
  private glimpse: Glimpse = { camera: null, fieldOfView: 60 };
  private asked = 0;

  constructor(private camera: CameraSight) { this.kind = camera.kind; }

  async start(looker: Looker) {
    const { video } = this.camera, { overlay, renderer } = looker;
    this.camera.onGlimpse = (glimpse) => { this.glimpse = glimpse; };
    try {
      await this.camera.start();
    } catch (error) {
      this.camera.stop();
      throw error;
    }
    this.looker = looker;
    // Unplugged, or taken by the device for something else.
    if (video.srcObject instanceof MediaStream) video.srcObject.getTracks().forEach((track) => track.addEventListener('ended', () => void this.lose()));
    overlay.prepend(video, renderer.domElement);
    const step = () => {
      this.asked = requestAnimationFrame(step);
      this.look(looker);
    };
    step();
  }

  meets(spot: Spot | null): Matrix4 | null {
    const { looker } = this;
    if (!looker) return null;
    const { eye, overlay } = looker, { clientWidth: width, clientHeight: height } = overlay;
    const through = new Vector3(spot ? (2 * spot.x) / width - 1 : 0, spot ? 1 - (2 * spot.y) / height : 0, 0.5);
    const direction = through.applyMatrix4(eye.projectionMatrixInverse).applyMatrix4(eye.matrix).sub(eye.position).normalize();
    const distance = -eye.position.y / direction.y;
    return distance > 0 && distance < farthest ? new Matrix4().setPosition(direction.multiplyScalar(distance).add(eye.position)) : null;
  }

  /** The surface is the card's, and goes with it. */
  watchOver() {}
  readonly watched = null;

  seen() { return this.camera.video.videoWidth > 0 ? this.camera.video : null; }

  async end() {
    cancelAnimationFrame(this.asked);
    this.camera.stop();
    this.camera.video.remove();
    this.looker = null;
  }

  private async lose() {
    const { looker } = this;
    await this.end();
    looker?.ended();
  }

  private look(looker: Looker) {
    const { eye, overlay, renderer } = looker, { camera, fieldOfView } = this.glimpse, { video } = this.camera;
    const width = overlay.clientWidth, height = overlay.clientHeight, ratio = renderer.getPixelRatio();
    if (renderer.domElement.width !== Math.floor(width * ratio) || renderer.domElement.height !== Math.floor(height * ratio)) {
      renderer.setSize(width, height, false);
    }
    if (camera) {
      camera.decompose(eye.position, eye.quaternion, eye.scale);
      eye.updateMatrix();
      // The picture fills the screen, which cuts off some of it.
      const drawn = video.videoHeight * Math.max(width / Math.max(1, video.videoWidth), height / Math.max(1, video.videoHeight));
      const half = Math.tan(MathUtils.degToRad(fieldOfView) / 2) * (drawn > 0 ? height / drawn : 1);
      eye.fov = 2 * MathUtils.radToDeg(Math.atan(half));
      eye.aspect = width / height;
      eye.updateProjectionMatrix();
    }
    looker.frame(camera !== null);
  }
}
