// The rear camera behind the models, and a printed card before it that says where the camera is: augmented reality without
// WebXR, in six degrees of freedom.
import { Matrix4 } from 'three';
import type { CameraSight, Glimpse } from './camera_sight';
import type { FromTracker, ToTracker } from './card/tracker_worker';
import { guessedFieldOfView, rearCamera } from './rear_camera';

const patience = 300; // milliseconds without the card in which the last place counts: a blurred picture ends no drag

export class CardSight implements CameraSight {
  readonly kind = 'card';
  onGlimpse: (glimpse: Glimpse) => void = () => {};
  private rear = rearCamera();
  private tracker: Worker | null = null;
  private asked = 0;
  private underWay = false;
  private seen = -Infinity;

  get video() { return this.rear.video; }

  async start() {
    await this.rear.open(1280, 720);
    this.tracker = new Worker(new URL('./card/tracker_worker.ts', import.meta.url), { type: 'module' });
    this.tracker.onmessage = ({ data }: MessageEvent<FromTracker>) => this.take(data);
    this.wait();
  }

  stop() {
    this.video.cancelVideoFrameCallback(this.asked);
    this.tracker?.terminate();
    this.tracker = null;
    this.rear.close();
  }

  /** Pictures that come while one is looked at are left out: the newest is worth more than each. */
  private wait() {
    this.asked = this.video.requestVideoFrameCallback(() => {
      this.wait();
      if (!this.underWay) void this.look();
    });
  }

  private async look() {
    this.underWay = true;
    // A phone that is being turned has moments without a picture.
    const picture = await createImageBitmap(this.video).catch(() => null);
    if (picture && this.tracker) this.tracker.postMessage({ picture, fieldOfView: guessedFieldOfView(this.video) } satisfies ToTracker, [picture]);
    else {
      picture?.close();
      this.underWay = false;
    }
  }

  private take({ camera, fieldOfView }: FromTracker) {
    this.underWay = false;
    if (camera) this.seen = performance.now();
    else if (performance.now() - this.seen < patience) return;
    this.onGlimpse({ camera: camera && new Matrix4().fromArray(camera), fieldOfView });
  }
}
