// How motions would look on the model: tried one after the other beside the document, what is looked at first.
import type { MotionPreview, PreviewRig, SampleMotion, SurfaceModel } from '../engine/messages';
import type { PageStore } from './state';
import type { Studio } from './studio';

/** One that the engine makes, or a file of the user's. */
export type Motion = SampleMotion | File;

export class MotionTrials {
  onResult: (motion: Motion, preview: MotionPreview) => void = () => {};
  /** All that was wanted is tried. */
  onRest: () => void = () => {};

  private waiting = new Set<Motion>();
  private first: Motion | null = null;
  private underWay = false;
  private model: SurfaceModel | null = null; // what the results are of
  private namedRig: PreviewRig | null = null;

  constructor(private studio: Studio, private page: PageStore) {}

  want(motion: Motion) {
    this.waiting.add(motion);
    void this.go();
  }
  /** Before all others. */
  wantFirst(motion: Motion) {
    this.first = motion;
    this.want(motion);
  }
  leave(motion: Motion) { this.waiting.delete(motion); }
  leaveAll() { this.waiting.clear(); }

  /** Whether the model has another rig than the results so far were made with: they are worth nothing then. */
  renew(): boolean {
    if (this.model === this.page.now.model) return false;
    this.model = this.page.now.model;
    this.namedRig = null;
    return true;
  }

  /** What a preview moves. */
  rigOf({ named }: MotionPreview): PreviewRig | null {
    const { session, model } = this.page.now;
    return named ? this.namedRig : session && model ? { model, joints: session.joints.length } : null;
  }

  /** The engine does what the user asks for in between. */
  private async go() {
    if (this.underWay) return;
    this.underWay = true;
    for (let next = this.next(); next; next = this.next()) {
      this.waiting.delete(next);
      const of = this.model, preview = await this.studio.previewMotion(next);
      if (preview?.named && !this.namedRig) this.namedRig = await this.studio.previewRig();
      if (preview && of === this.model) this.onResult(next, preview);
    }
    this.underWay = false;
    this.onRest();
  }

  private next(): Motion | undefined {
    return this.first && this.waiting.has(this.first) ? this.first : this.waiting.values().next().value;
  }
}
