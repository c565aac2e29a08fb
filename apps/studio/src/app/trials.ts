// How motions and poses would look on the model: tried one after the other beside the document, what is looked at first.
import type { MotionPreview, PreviewRig, SampleMotion, SurfaceModel } from '../engine/messages';
import type { PageStore } from './state';

/** One that the engine makes, or a file of the user's. */
export type Motion = SampleMotion | File;

export class Trials<Of> {
  onResult: (of: Of, preview: MotionPreview) => void = () => {};
  /** All that was wanted is tried. */
  onRest: () => void = () => {};

  private waiting = new Set<Of>();
  private first: Of | null = null;
  private underWay = false;
  private model: SurfaceModel | null = null; // what the results are of
  private namedRig: PreviewRig | null = null;

  /** `attempt` gives null where the page is told to stop; `loadNamedRig` gives what previews with a named skeleton move. */
  constructor(
    private page: PageStore, private attempt: (of: Of) => Promise<MotionPreview | null>, private loadNamedRig: () => Promise<PreviewRig | null>,
  ) {}

  want(of: Of) {
    this.waiting.add(of);
    void this.go();
  }
  /** Before all others. */
  wantFirst(of: Of) {
    this.first = of;
    this.want(of);
  }
  leave(of: Of) { this.waiting.delete(of); }
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
      const of = this.model, preview = await this.attempt(next);
      if (preview?.named && !this.namedRig) this.namedRig = await this.loadNamedRig();
      if (preview && of === this.model) this.onResult(next, preview);
    }
    this.underWay = false;
    this.onRest();
  }

  private next(): Of | undefined {
    return this.first && this.waiting.has(this.first) ? this.first : this.waiting.values().next().value;
  }
}
