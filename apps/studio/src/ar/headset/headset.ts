// A headset's hands and controllers: what each points at, what they take hold of, and the panel that they press.
import { Group, Matrix4, Ray, Vector3 } from 'three';
import type { ArView } from '../ar_view';
import { BodyDrag } from '../body_drag';
import type { Gesture } from '../gesture';
import type { WebXrSight } from '../webxr_sight';
import { BodyInHand, BodyInTwoHands, memberAround, nearestBox, pointingBy } from './body_hold';
import { Hand } from './hand';
import { Halo } from './halo';
import { HandleInHand, HandleOnRay, HandleSwing } from './handle_hold';
import { exposeHeadset } from './headset_probe';
import { SpacePanel } from './space_panel';

const reach = 0.05; // metres between a hand and the surface of a handle that it can take
const slop = 0.045; // radians beside a ray that count as on it: what a steady hand trembles, three times
const either = 0.012; // radians between two of which the nearer one is meant
const restRay = 1.2; // metres of a ray that meets nothing
const farthest = 12; // metres along a ray that the floor is looked for

/** What a hand could take now. */
interface Aimed { joint: number; near: boolean; distance: number }

/** Until the session ends. */
export function beginHeadset(ar: ArView, sight: WebXrSight) {
  const { session } = sight;
  if (session) new Headset(ar, sight, session);
}

class Headset {
  /** What the user sees and pictures do not show. */
  private readonly aids = new Group();
  private readonly panel: SpacePanel;
  private readonly halo = new Halo();
  private hands = new Map<XRInputSource, Hand>();
  private aimed = new Map<Hand, Aimed>();
  private gesture: Gesture | null = null;
  private holding: Hand[] = [];
  /** The hand that did something last: its ray says where a model goes. */
  private leading: Hand | null = null;
  private handLost = false;
  private over = false;

  constructor(private ar: ArView, private sight: WebXrSight, private session: XRSession) {
    const { studio } = ar.desk;
    this.panel = new SpacePanel(ar);
    this.aids.add(this.halo.root, this.panel.root);
    ar.room.add(this.aids);
    ar.desk.viewport.tools.push(this.aids);
    // The desk has its own again at the end.
    studio.ask = (title, detail, yes) => this.panel.contents.ask(title, detail, yes);
    ar.beforeFrame.add(this.frame);
    ar.alsoLetGo = () => this.letGo();
    ar.ownTrouble = () => (this.handLost ? 'hand' : null);
    sight.ahead = () => this.placeAhead();
    const listen = (type: 'selectstart' | 'selectend' | 'squeezestart' | 'squeezeend', act: (hand: Hand) => void) => session.addEventListener(type, ({ inputSource, frame }) => {
      const hand = this.handOf(inputSource), space = ar.renderer.xr.getReferenceSpace();
      if (!hand) return;
      if (space) hand.update(frame, space);
      act(hand);
    });
    listen('selectstart', (hand) => this.down(hand, false));
    listen('selectend', (hand) => this.up(hand));
    listen('squeezestart', (hand) => this.down(hand, true));
    listen('squeezeend', (hand) => this.up(hand));
    session.addEventListener('inputsourceschange', ({ removed }) => removed.forEach((source) => this.lose(source)));
    session.addEventListener('end', () => this.end());
    exposeHeadset(ar, this.panel, this.hands);
  }

  private frame = () => {
    const { ar } = this, { xr } = ar.renderer, frame = xr.getFrame(), space = xr.getReferenceSpace();
    if (!frame || !space) return;
    for (const source of this.session.inputSources) this.handOf(source)?.update(frame, space);
    const hands = [...this.hands.values()].filter(({ tracked }) => tracked);
    this.panel.frame(hands, performance.now());
    for (const hand of hands) this.look(hand);
    this.gesture?.frame();
    this.highlight();
    for (const hand of hands) hand.draw();
  };

  /** Null for fingers on a screen, which are not of a headset. */
  private handOf(source: XRInputSource): Hand | null {
    const known = this.hands.get(source);
    if (known || this.over || source.targetRayMode === 'screen') return known ?? null;
    const hand = new Hand(source);
    this.hands.set(source, hand);
    this.aids.add(hand.root);
    void this.session.requestHitTestSource?.({ space: source.targetRaySpace })?.then((hits) => {
      if (this.hands.get(source) === hand) hand.hits = hits;
      else hits.cancel();
    }, () => { /* then the floor is all that it meets */ });
    return hand;
  }

  // What they point at.

  private look(hand: Hand) {
    this.aimed.delete(hand);
    hand.rayLength = null;
    if (this.holding.includes(hand)) {
      if (!(this.gesture instanceof HandleInHand)) hand.rayLength = this.pointedLength(hand);
      return;
    }
    const panel = this.panel.point(hand);
    if (panel !== null) {
      hand.rayLength = panel > 0 ? panel : null;
      return;
    }
    const { display } = this.ar.desk.page.now, found = !this.ar.isPlacing && display === 'handles' ? this.nearestHandle(hand) : null;
    if (found) this.aimed.set(hand, found);
    hand.rayLength = found?.near ? null : found?.distance ?? this.pointedLength(hand);
  }

  private pointedLength(hand: Hand): number {
    const at = this.ar.isPlacing ? this.meets(hand) : null;
    if (at) return new Vector3().setFromMatrixPosition(at).distanceTo(hand.ray().origin);
    return nearestBox(this.ar, hand.ray().applyMatrix4(this.ar.room.matrix)) ?? restRay;
  }

  /** Within reach, else along the ray: to the ray, then to the hand where it could be either. */
  private nearestHandle(hand: Hand): Aimed | null {
    const { handles, viewport } = this.ar.desk, { room, eye } = this.ar, toRoom = room.matrixWorld.clone().invert(), scale = toRoom.getMaxScaleOnAxis();
    const ray = hand.ray(), at = new Vector3(), { height } = viewport.size;
    let near: Aimed | null = null;
    const far: (Aimed & { beside: number })[] = [];
    for (let joint = 0; joint < handles.count; ++joint) {
      handles.position(joint, at).applyMatrix4(toRoom);
      const radius = scale * handles.drawnRadius(joint, eye, height), away = hand.grip.distanceTo(at);
      if (hand.reaches && away - radius < reach && away < (near?.distance ?? Infinity)) near = { joint, near: true, distance: away };
      const distance = ray.origin.distanceTo(at), beside = at.sub(ray.origin).angleTo(ray.direction);
      if (beside < Math.max(slop, Math.asin(Math.min(1, radius / distance)))) far.push({ joint, near: false, distance, beside });
    }
    if (near) return near;
    const nearest = Math.min(...far.map(({ beside }) => beside));
    return far.filter(({ beside }) => beside <= nearest + either).sort((a, b) => a.distance - b.distance)[0] ?? null;
  }

  /** What would be taken is shown before it moves; of two hands the nearer one's. */
  private highlight() {
    const { page, handles, viewport } = this.ar.desk, { room, eye } = this.ar, found = [...this.aimed.values()].sort((a, b) => a.distance - b.distance)[0];
    const hovered = this.gesture ? null : found?.joint ?? null;
    if (hovered !== page.now.hovered) page.set({ hovered });
    if (hovered === null) return this.halo.show(null);
    const toRoom = room.matrixWorld.clone().invert(), radius = handles.drawnRadius(hovered, eye, viewport.size.height) * toRoom.getMaxScaleOnAxis();
    this.halo.show(handles.position(hovered, new Vector3()).applyMatrix4(toRoom), radius);
  }

  // What they do.

  private down(hand: Hand, squeezed: boolean) {
    this.leading = hand;
    this.handLost = false;
    if (this.panel.press(hand)) return;
    this.panel.forget(hand);
    if (this.ar.isPlacing) return void this.ar.settle();
    if (!this.ar.desk.page.now.session || this.holding.includes(hand)) return;
    if (!this.gesture) {
      this.holding = [hand];
      this.gesture = this.take(hand, squeezed);
    } else if (this.holding.length === 1 && (this.gesture instanceof BodyInHand || this.gesture instanceof BodyDrag || this.gesture instanceof Hold)) {
      this.gesture.end();
      this.holding = [this.holding[0]!, hand];
      this.gesture = new BodyInTwoHands(this.ar, [this.holding[0]!, hand]);
    }
  }

  private take(hand: Hand, squeezed: boolean): Gesture {
    const { ar } = this, { page, studio } = ar.desk, aimed = this.aimed.get(hand);
    if (!squeezed && aimed) {
      hand.pulse();
      if (aimed.near) return new HandleInHand(ar, aimed.joint, hand);
      return page.now.mode === 'move' ? new HandleOnRay(ar, aimed.joint, hand) : new HandleSwing(ar, aimed.joint, hand);
    }
    if (!squeezed && page.now.display === 'handles') return new Hold(); // a body is not moved by missing a handle
    const grip = hand.grip.clone().applyMatrix4(ar.room.matrix), around = hand.reaches ? memberAround(ar, grip) : null;
    if (around !== null) return new BodyInHand(ar, around, hand);
    return new BodyDrag(ar, pointingBy(ar, hand, () => this.surfaceMet(hand)), studio.memberUnder(this.engineRay(hand)));
  }

  private up(hand: Hand) {
    if (this.panel.release(hand) || !this.holding.includes(hand)) return;
    const { gesture } = this;
    gesture?.frame();
    const tapped = this.holding.length === 1 && !gesture?.begun && (gesture instanceof BodyDrag || gesture instanceof BodyInHand || gesture instanceof Hold);
    this.finish();
    if (tapped) void this.ar.tapAlong(this.engineRay(hand));
  }

  /** It is not seen any more. What it held stays as it was then. */
  private lose(source: XRInputSource) {
    const hand = this.hands.get(source);
    if (!hand) return;
    if (this.holding.includes(hand)) {
      this.finish();
      this.handLost = true;
    }
    this.panel.forget(hand);
    this.aimed.delete(hand);
    this.hands.delete(source);
    if (this.leading === hand) this.leading = null;
    hand.dispose();
  }

  private letGo() {
    for (const hand of this.hands.values()) this.panel.forget(hand);
    this.finish();
  }

  private finish() {
    const { gesture } = this;
    this.gesture = null;
    this.holding = [];
    gesture?.end();
  }

  private end() {
    this.over = true;
    this.letGo();
    this.ar.beforeFrame.delete(this.frame);
    this.ar.desk.page.set({ hovered: null });
    for (const source of [...this.hands.keys()]) this.lose(source);
    this.panel.dispose();
    this.halo.dispose();
    this.aids.removeFromParent();
    const { tools } = this.ar.desk.viewport;
    tools.splice(tools.indexOf(this.aids), 1);
  }

  // What is real there.

  private placeAhead(): Matrix4 | null {
    const hand = this.leading ?? [...this.hands.values()].find(({ tracked, isLeft }) => tracked && !isLeft) ?? [...this.hands.values()].find(({ tracked }) => tracked);
    return hand ? this.meets(hand) : null;
  }

  /** A surface that the device knows, else the floor. */
  private meets(hand: Hand): Matrix4 | null { return this.surfaceMet(hand) ?? floorMet(hand.ray()); }
  private surfaceMet(hand: Hand) { return hand.hits && this.sight.met(hand.hits); }

  private engineRay(hand: Hand) {
    const { origin, direction } = hand.ray().applyMatrix4(this.ar.room.matrixWorld);
    return { origin: origin.toArray(), direction: direction.toArray() };
  }
}

/** A press beside everything. */
class Hold implements Gesture {
  readonly begun = false;
  frame() { /* nothing goes along */ }
  end() { /* nothing was done */ }
}

function floorMet({ origin, direction }: Ray): Matrix4 | null {
  const along = -origin.y / direction.y;
  return along > 0 && along < farthest ? new Matrix4().setPosition(direction.clone().multiplyScalar(along).add(origin)) : null;
}
