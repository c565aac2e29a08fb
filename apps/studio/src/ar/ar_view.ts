// The models of the scene in a real place: frames, where they stand, what is on the screen, until all is put back.
import { Matrix4, MathUtils, Ray, Vector3 } from 'three';
import type { ArState } from '../app/state';
import { framesFrom, nextFrame } from '../app/frames';
import type { Ray as EngineRay } from '../engine/messages';
import { hasFloor } from './actions';
import { ArLight } from './ar_light';
import { takePicture } from './ar_picture';
import type { Desk } from './desk';
import { shareOfView, timesToFit } from './fit_view';
import { Reticle } from './reticle';
import { Room, turnTowards } from './room';
import type { Looker, Sight, Spot } from './sight';
import { Touch } from './touch';
import { TurnScale } from './turn_scale';

const patience = 5000; // milliseconds without a surface before help is offered
const ahead = 1.2; // metres before the device: there a model stands where no surface is known
export const markLayer = 3; // seen by both eyes of a headset; 1 and 2 are three's for one of them

export class ArView implements Looker {
  readonly room: Room['group'];
  readonly eye: Room['eye'];
  readonly renderer;
  /** Called before each frame is drawn. */
  readonly beforeFrame = new Set<() => void>();
  /** What is left over at the end. */
  onEnd: (byItself: boolean) => void = () => {};
  /** A headset's hands: what they hold is let go of as fingers let go, and what may trouble them. */
  alsoLetGo = () => {};
  ownTrouble: () => ArState['trouble'] = () => null;

  private place = new Room();
  private light: ArLight | null = null;
  /** Done within the next frame, once it is drawn. */
  private afterFrame: (() => void)[] = [];
  private steps: ((now: number) => void)[] = [];
  private stopWatching = () => {};
  private stopFrames = () => {};
  private reticle = new Reticle();
  private touch = new Touch(this);
  private stands = false; // the scene has a place in the room
  private at: Matrix4 | null = null; // of the surface that is met, in the room
  private lookedSince = performance.now();
  private leaving = false;
  private hidden = false;
  private width = 0; // pixels of what is looked through
  private giveBack: () => void;
  private before;
  private canvasPlace;

  constructor(readonly desk: Desk, readonly sight: Sight, readonly overlay: HTMLElement) {
    const { viewport, page } = desk;
    this.renderer = viewport.renderer;
    this.room = this.place.group;
    this.eye = this.place.eye;
    this.room.add(this.reticle.root);
    this.reticle.root.layers.set(markLayer);
    viewport.world.add(this.room);
    const { display, mode, bones, gizmo, arranging, selecting } = page.now;
    this.canvasPlace = { parent: viewport.canvas.parentElement!, next: viewport.canvas.nextSibling };
    this.before = { display, mode, bones, gizmo, arranging, selecting };
    this.giveBack = viewport.lend({ eye: this.eye, size: () => ({ width: overlay.clientWidth, height: overlay.clientHeight }) });
    this.listen();
  }

  /** Once the sight has started. */
  begin() {
    const { page, app } = this.desk;
    app.hidden = true;
    page.set({
      display: 'surface', gizmo: false, arranging: false, selecting: false, painting: false, placing: false, correcting: false, comparison: null, selected: null,
      notice: null, // of a way that failed before
      ar: { sight: this.sight.kind, step: 'placing', surface: false, trouble: null, realSize: true, large: false },
    });
    this.chooseMode();
    this.lookedSince = performance.now();
    this.width = this.desk.viewport.size.width;
    this.stopFrames = framesFrom((step) => this.steps.push(step));
    // What comes into the scene is looked for a place; undone, it needs none.
    this.stopWatching = page.watch(({ session }, { session: before }) => {
      if (!session || !before || !this.stands || session.members.length === before.members.length) return;
      if (session.members.length > before.members.length && session.redo === null) this.placeAgain();
      else this.tell({ step: 'placed' });
    });
  }

  get isPlacing() { return this.desk.page.now.ar?.step !== 'placed'; }

  // What the sight tells.

  frame(known: boolean) {
    const trouble = this.trouble(known);
    for (const step of this.steps.splice(0)) step(performance.now());
    this.noticeTurnedScreen();
    if (!known) {
      if (this.desk.page.now.ar?.trouble !== 'lost') this.letGo();
      return this.tell({ trouble });
    }
    if (this.sight.watched && this.stands) this.place.correct(this.sight.watched);
    if (this.isPlacing) this.preview();
    else this.touch.frame();
    const { ar } = this.desk.page.now;
    this.tell({ trouble, surface: this.at !== null, large: Boolean(ar?.large) && this.isLarge() });
    this.light?.follow();
    this.beforeFrame.forEach((act) => act());
    this.desk.viewport.drawNow();
    for (const act of this.afterFrame.splice(0)) act();
  }

  expectLight() { this.light = new ArLight(this.desk.viewport, this.place); }

  hide(hidden: boolean) {
    this.hidden = hidden;
    if (hidden) this.letGo();
    this.tell({ trouble: hidden ? 'hidden' : null });
    this.lookedSince = performance.now();
  }

  finger(id: number, spot: Spot | null, phase: 'down' | 'move' | 'up' | 'cancel') {
    if (phase === 'cancel') this.letGo();
    else if (phase === 'up') this.touch.up(id);
    else if (phase === 'down') this.touch.down(id, spot!);
    else this.touch.move(id, spot!);
  }

  ended() { this.close(!this.leaving); }

  // What a user does.

  async leave() {
    this.leaving = true;
    await this.sight.end();
    this.close(false);
  }

  /** The chosen model stands where it is shown now; where no surface is met, before the device, if there is a floor. */
  async settle() {
    const { page } = this.desk;
    if (!this.isPlacing || !page.now.session || !hasFloor(page.now)) return;
    const later = this.stands, at = this.at ?? this.spotAhead();
    if (!later) {
      this.standScene(at);
      this.place.hold(at);
      this.sight.watchOver(at);
    }
    this.stands = true;
    this.tell({ step: 'placed', trouble: null });
    this.reticle.show(null);
    if (later) await this.keepPlace(page.now.session.member);
    this.tell({ large: this.sight.hasOverlay && this.isLarge() }); // a headset is looked round in
  }

  /** The chosen model becomes small enough to be seen whole: one step to undo. */
  fitView() {
    const { places, page, viewport } = this.desk, { session } = page.now;
    if (!session) return;
    const model = new TurnScale(this), box = places.box(session.member, session.members);
    model.to(timesToFit(box, this.baseOf(session.member), viewport.world.matrix, this.eye), 0);
    model.keep();
  }

  /** The chosen model is to have another place: it goes along with the surface that is looked at. */
  placeAgain() {
    this.letGo();
    this.lookedSince = performance.now();
    this.desk.page.set({ display: 'surface' });
    this.tell({ step: 'placing' });
  }

  async tap(spot: Spot) {
    if (this.isPlacing) return this.settle();
    await this.tapAlong(this.desk.viewport.ray(spot.x, spot.y).ray);
  }

  /** In the chosen model's own space. */
  async tapAlong(ray: EngineRay) {
    const { studio, page } = this.desk, member = await studio.memberUnder(ray);
    if (member === null || !page.now.session) return;
    if (member !== page.now.session.member) {
      await studio.chooseMember(member);
      this.chooseMode();
    } else if (page.now.display === 'handles') await studio.selectSurface(ray, 0);
    else page.set({ display: 'handles' });
  }

  /** A PNG; null where no background is given and the browser keeps what the camera sees to itself. */
  async picture(background: string | null): Promise<Blob | null> {
    const { page } = this.desk, { display } = page.now;
    const screen = await new Promise<HTMLCanvasElement | null>((resolve) => this.afterFrame.push(() => {
      page.set({ display: 'surface' });
      resolve(takePicture(this, background));
      page.set({ display });
    }));
    return screen && new Promise((resolve) => screen.toBlob(resolve, 'image/png'));
  }

  /** Where it is shown, a member stays: one step to undo. A scale that is known is kept as it is. */
  async keepPlace(member: number, scale?: number) {
    const shown = this.desk.places.shown(member);
    await this.desk.studio.placeMember(member, scale === undefined ? shown : { ...shown, scale });
  }

  // What gestures ask.

  /** In the world: what is below the middle of its feet. */
  baseOf(member: number): Vector3 {
    const box = this.desk.places.box(member, this.desk.page.now.session!.members);
    return box.getCenter(new Vector3()).setY(box.min.y);
  }

  /** In the world, through a spot. */
  ray({ x, y }: Spot): Ray {
    const { viewport } = this.desk, { ray } = viewport.ray(x, y);
    return new Ray(new Vector3(...ray.origin), new Vector3(...ray.direction)).applyMatrix4(new Matrix4().copy(viewport.world.matrix).invert());
  }

  /** In the world, where something real is below a spot. */
  meets(spot: Spot): Vector3 | null {
    const at = this.sight.meets(spot);
    return at && this.place.toWorld(at);
  }

  showRealSize(realSize: boolean) { this.tell({ realSize }); }

  /** Turning with limbs that follow leaves fewer artefacts, where a skeleton's joints are known by name. */
  private chooseMode() {
    const { page } = this.desk, { session } = page.now;
    page.set({ mode: session && (session.own_rig || session.rigger === 'template') ? 'turn' : 'move' });
  }

  /** Along with the surface in the middle of the view. */
  private preview() {
    const { session } = this.desk.page.now;
    this.at = this.sight.meets(null);
    this.reticle.show(this.at);
    if (this.at) this.lookedSince = performance.now();
    if (this.at && !this.stands) this.standScene(this.at);
    else if (this.at && session) this.standMember(session.member, this.at);
    // Without a place there is nothing to see but where it could be.
    if (this.at || this.stands) this.eye.layers.enableAll();
    else this.eye.layers.set(markLayer);
  }

  private standScene(at: Matrix4) {
    const { page, places } = this.desk, { member } = page.now.session!;
    this.eye.layers.enableAll();
    this.place.standAt(this.baseOf(member), frontOf(places.of(member)), at);
  }

  private standMember(member: number, at: Matrix4) {
    const { page, places, arrange } = this.desk, base = this.baseOf(member), to = this.place.toWorld(at);
    const turn = turnTowards(frontOf(places.of(member)), to, this.place.eyeInWorld);
    const moved = new Matrix4().makeTranslation(to).multiply(new Matrix4().makeRotationY(turn)).multiply(new Matrix4().makeTranslation(base.negate()));
    places.move(member, moved.multiply(places.of(member)), page.now.session!.members);
    arrange();
  }

  /** On the floor, as far as it is known. */
  private spotAhead(): Matrix4 {
    const { position, quaternion } = this.eye, to = new Vector3(0, 0, -1).applyQuaternion(quaternion).setY(0);
    if (to.length() < MathUtils.DEG2RAD) to.set(0, 1, 0).applyQuaternion(quaternion).setY(0); // it looks down
    return new Matrix4().setPosition(to.setLength(ahead).add(position).setY(0));
  }

  private isLarge(): boolean {
    const { places, page, viewport } = this.desk, { session } = page.now;
    return session !== null && shareOfView(places.box(session.member, session.members), viewport.world.matrix, this.eye) > 1;
  }

  /** Fingers that were down are elsewhere on the model by then. */
  private noticeTurnedScreen() {
    const { width } = this.desk.viewport.size;
    if (width !== this.width) this.letGo();
    this.width = width;
  }

  private letGo() {
    this.touch.letGo();
    this.alsoLetGo();
  }

  private trouble(known: boolean): ArState['trouble'] {
    if (!known) return 'lost';
    if (this.hidden) return 'hidden'; // blurred, a headset goes on asking for frames
    return this.ownTrouble() ?? (this.isPlacing && !this.at && performance.now() - this.lookedSince > patience ? 'no-surface' : null);
  }

  private tell(change: Partial<ArState>) {
    const { page } = this.desk, { ar } = page.now;
    if (ar && Object.entries(change).some(([key, value]) => ar[key as keyof ArState] !== value)) page.set({ ar: { ...ar, ...change } });
  }

  /** Fingers of the overlay. */
  private listen() {
    const surface = this.overlay.querySelector<HTMLElement>('.ar-surface')!;
    const spot = (event: PointerEvent): Spot => {
      const { left, top } = this.overlay.getBoundingClientRect();
      return { x: event.clientX - left, y: event.clientY - top };
    };
    surface.addEventListener('pointerdown', (event) => {
      if (!this.sight.hasOverlay || event.button !== 0) return;
      surface.setPointerCapture(event.pointerId);
      this.finger(event.pointerId, spot(event), 'down');
    });
    surface.addEventListener('pointermove', (event) => this.finger(event.pointerId, spot(event), 'move'));
    surface.addEventListener('pointerup', (event) => this.finger(event.pointerId, null, 'up'));
    surface.addEventListener('pointercancel', (event) => this.finger(event.pointerId, null, 'cancel'));
    addEventListener('visibilitychange', this.onVisibility);
  }

  private onVisibility = () => this.hide(document.visibilityState === 'hidden');

  /** The desk as it was, with the scene as it is now. */
  close(byItself: boolean) {
    const { page, app, viewport } = this.desk;
    if (!this.room.parent) return;
    this.letGo();
    removeEventListener('visibilitychange', this.onVisibility);
    this.stopWatching();
    this.stopFrames();
    this.steps.splice(0).forEach(nextFrame);
    this.light?.dispose();
    this.reticle.dispose();
    this.room.removeFromParent();
    app.hidden = false;
    page.set({ ar: null, ...this.before });
    this.canvasPlace.parent.insertBefore(viewport.canvas, this.canvasPlace.next);
    this.giveBack();
    viewport.canvas.focus({ preventScroll: true });
    this.onEnd(byItself);
  }
}

/** Which way a model looks that stands there: its own z. */
const frontOf = (place: Matrix4) => new Vector3().setFromMatrixColumn(place, 2);
