// WebXR's immersive-ar: the device tells where it is, and where real surfaces are.
import { Matrix4, Quaternion, Vector3 } from 'three';
import type { Looker, Sight, Spot } from './sight';

/** All that is asked for can be missing. */
const wished = ['local-floor', 'hit-test', 'dom-overlay', 'anchors', 'light-estimation', 'camera-access', 'hand-tracking'];
const level = 0.7; // of a surface's normal along up: below it nothing stands there

export class WebXrSight implements Sight {
  readonly kind = 'webxr';
  session: XRSession | null = null;
  /** Asked in place of the middle of the view, where something else points. */
  ahead: (() => Matrix4 | null) | null = null;
  private looker: Looker | null = null;
  private frame: XRFrame | null = null;
  private inView: XRHitTestSource | undefined;
  private touched: XRTransientInputHitTestSource | undefined;
  /** Inputs that touch the screen now. */
  private touches = new Map<XRInputSource, number>();
  private touchCount = 0;
  private toWatch: Matrix4 | null = null;
  private anchor: XRAnchor | null = null;
  watched: Matrix4 | null = null;

  get hasOverlay() { return this.session?.domOverlayState != null; }

  async start(looker: Looker) {
    const session = await navigator.xr!.requestSession('immersive-ar', { optionalFeatures: wished, domOverlay: { root: looker.overlay } });
    this.session = session;
    this.looker = looker;
    session.addEventListener('end', () => this.ended());
    session.addEventListener('visibilitychange', () => looker.hide(session.visibilityState !== 'visible'));
    this.listenForTouches(session);
    const { xr } = looker.renderer;
    try {
      // Without a floor of its own the surfaces that are met tell where it is.
      const floor = await session.requestReferenceSpace('local-floor').then(() => true, () => false);
      xr.setReferenceSpaceType(floor ? 'local-floor' : 'local');
      xr.enabled = true;
      if (session.enabledFeatures?.includes('light-estimation')) looker.expectLight();
      await xr.setSession(session);
      await this.askForHits(session);
    } catch (error) {
      await session.end().catch(() => {});
      throw error;
    }
    looker.renderer.setAnimationLoop((_, frame) => { if (frame) this.see(frame, looker); });
  }

  meets(spot: Spot | null): Matrix4 | null {
    const { frame } = this;
    if (!frame) return null;
    if (spot) return this.level(this.hitsOf(frame, spot));
    return this.ahead?.() ?? (this.inView ? this.met(this.inView) : null);
  }

  /** In this frame, in the room: where a model can stand. */
  met(source: XRHitTestSource): Matrix4 | null { return this.frame && this.level(this.frame.getHitTestResults(source)); }

  private level(results: readonly XRHitTestResult[]): Matrix4 | null {
    const space = this.looker?.renderer.xr.getReferenceSpace();
    if (!space) return null;
    for (const result of results) {
      const pose = result.getPose(space);
      if (!pose) continue;
      const at = new Matrix4().fromArray(pose.transform.matrix);
      if (new Vector3().setFromMatrixColumn(at, 1).y > level) return at;
    }
    return null;
  }

  /** An anchor, made within the next frame. */
  watchOver(at: Matrix4) { this.toWatch = at.clone(); }

  seen() {
    const { frame, looker } = this, { xr } = looker!.renderer, space = xr.getReferenceSpace();
    const view = frame && space ? frame.getViewerPose(space)?.views[0] as (XRView & { camera?: object }) | undefined : undefined;
    // Its declared type is that of three's own cameras.
    return view?.camera ? xr.getCameraTexture(view.camera as never) ?? null : null;
  }

  async end() { await this.session?.end().catch(() => {}); }

  private async askForHits(session: XRSession) {
    const viewer = await session.requestReferenceSpace('viewer');
    this.inView = await session.requestHitTestSource?.({ space: viewer })?.catch(() => undefined);
    this.touched = await session.requestHitTestSourceForTransientInput?.({ profile: 'generic-touchscreen' })?.catch(() => undefined);
  }

  /** Below the finger that is nearest to the spot. */
  private hitsOf(frame: XRFrame, spot: Spot): readonly XRHitTestResult[] {
    if (!this.touched) return [];
    const away = ({ inputSource }: XRTransientInputHitTestResult) => {
      const at = this.spotOf(inputSource, frame);
      return at ? Math.hypot(at.x - spot.x, at.y - spot.y) : Infinity;
    };
    const found = [...frame.getHitTestResultsForTransientInput(this.touched)].sort((a, b) => away(a) - away(b));
    return found[0]?.results ?? [];
  }

  private see(frame: XRFrame, looker: Looker) {
    this.frame = frame;
    const { xr } = looker.renderer, known = frame.getViewerPose(xr.getReferenceSpace()!) != null;
    this.watch(frame, xr.getReferenceSpace()!);
    if (known) {
      looker.room.updateWorldMatrix(true, true);
      xr.updateCamera(looker.eye);
    }
    this.followTouches(frame, looker);
    looker.frame(known);
    this.frame = null;
  }

  private watch(frame: XRFrame, space: XRReferenceSpace) {
    const at = this.toWatch;
    this.toWatch = null;
    if (at && frame.createAnchor) {
      const position = new Vector3(), turn = new Quaternion();
      at.decompose(position, turn, new Vector3());
      this.anchor?.delete();
      this.anchor = null;
      void frame.createAnchor(new XRRigidTransform(position, turn), space)?.then((anchor) => { this.anchor = anchor; }, () => { /* it has none: the place is as good as the device's */ });
    }
    const pose = this.anchor && frame.getPose(this.anchor.anchorSpace, space);
    this.watched = pose ? new Matrix4().fromArray(pose.transform.matrix) : null;
  }

  private ended() {
    const { looker } = this;
    this.session = this.looker = this.anchor = this.watched = this.ahead = null;
    this.inView = this.touched = undefined;
    if (!looker) return;
    looker.renderer.setAnimationLoop(null);
    looker.renderer.xr.enabled = false;
    looker.ended();
  }

  /** Where there is no overlay, touches are rays. */
  private listenForTouches(session: XRSession) {
    const onScreen = (source: XRInputSource) => source.targetRayMode === 'screen' && !this.hasOverlay;
    session.addEventListener('selectstart', ({ inputSource, frame }) => {
      const spot = onScreen(inputSource) ? this.spotOf(inputSource, frame) : null;
      if (!spot) return;
      this.touches.set(inputSource, ++this.touchCount);
      this.looker?.finger(this.touchCount, spot, 'down');
    });
    const lift = (source: XRInputSource, phase: 'up' | 'cancel') => {
      const id = this.touches.get(source);
      this.touches.delete(source);
      if (id !== undefined) this.looker?.finger(id, null, phase);
    };
    session.addEventListener('selectend', ({ inputSource }) => lift(inputSource, 'up'));
    session.addEventListener('inputsourceschange', ({ removed }) => removed.forEach((source) => lift(source, 'cancel')));
  }

  private followTouches(frame: XRFrame, looker: Looker) {
    this.touches.forEach((id, source) => {
      const spot = this.spotOf(source, frame);
      if (spot) looker.finger(id, spot, 'move');
    });
  }

  /** Where the ray of a touch leaves the screen. */
  private spotOf({ targetRaySpace, targetRayMode }: XRInputSource, frame: XRFrame): Spot | null {
    const { looker } = this, space = looker?.renderer.xr.getReferenceSpace();
    const pose = space && targetRayMode === 'screen' ? frame.getPose(targetRaySpace, space) : undefined;
    if (!looker || !pose) return null;
    const { clientWidth, clientHeight } = looker.overlay, ray = new Matrix4().fromArray(pose.transform.matrix);
    const at = new Vector3(0, 0, -1).applyMatrix4(ray).applyMatrix4(looker.room.matrixWorld).project(looker.eye);
    return { x: ((at.x + 1) / 2) * clientWidth, y: ((1 - at.y) / 2) * clientHeight };
  }
}
