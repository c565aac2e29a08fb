// The panel in space: before the left hand or, without two hands, beside the model. It follows lazily, keeps still while
// it is pointed at, and is pressed by a ray or a finger tip.
import { Matrix4, Mesh, MeshBasicMaterial, PlaneGeometry, Quaternion, Vector3 } from 'three';
import { markLayer, type ArView } from '../ar_view';
import type { Hand } from './hand';
import { PanelContents } from './panel_content';
import { panelSize, PanelPicture } from './panel_picture';

const { width, height } = { width: panelSize.width / 1000, height: panelSize.height / 1000 }; // metres

const aboveHand = 0.19, beforeHand = 0.06; // metres to its middle: up, and away from the user
const besideModel = 0.25, armLength = 0.6, belowEyes = 0.2; // metres
const follows = 0.1, arrived = 0.01; // metres from where it should be: begins to go there, is there
const delay = 0.18; // seconds in which two thirds of the distance are gone
const touching = 0.06, through = 0.05, back = 0.012; // metres of a finger tip before and behind it; after a press it has to come back this far
const up = new Vector3(0, 1, 0);

/** What a hand does to it: which cell it is on, and which it has pressed; whether its finger tip is near, and is before it and may press. */
interface Touch { over: string | null; down: string | null; near: boolean; before: boolean }

export class SpacePanel {
  readonly contents: PanelContents;
  readonly root: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly picture = new PanelPicture();
  private touches = new Map<Hand, Touch>();
  private going = true;
  /** The hand that it is before. */
  private carrier: Hand | null = null;
  private placed = false;
  private stale = true;
  private last = 0;
  private readonly stopWatching: () => void;

  constructor(private ar: ArView) {
    this.contents = new PanelContents(ar);
    this.contents.onChange = () => { this.stale = true; };
    this.root = new Mesh(new PlaneGeometry(width, height), new MeshBasicMaterial({ map: this.picture.texture, transparent: true, toneMapped: false }));
    this.root.renderOrder = 5; // over translucent models
    this.root.visible = false;
    this.root.layers.enable(markLayer);
    this.stopWatching = ar.desk.page.watch(() => { this.stale = true; });
  }

  /** With each frame. */
  frame(hands: readonly Hand[], now: number) {
    const seconds = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    this.root.visible = hands.length > 0;
    if (!this.root.visible) return;
    for (const hand of this.touches.keys()) if (!hands.includes(hand)) this.forget(hand);
    if (![...this.touches.values()].some(({ over, down }) => over !== null || down !== null)) this.follow(hands, seconds);
    if (this.stale) this.draw();
  }

  /** How far along its ray a hand meets it, null beside it; 0 where a finger is at it. Presses what a finger tip goes through. */
  point(hand: Hand): number | null {
    if (hand === this.carrier) return null; // what moves with it cannot be pressed by it
    const touch = this.touchOf(hand), tip = this.root.worldToLocal(hand.tip.clone().applyMatrix4(this.ar.room.matrixWorld));
    touch.near = hand.reaches && inside(tip) && tip.z < touching && tip.z > -through;
    if (touch.near) {
      this.hover(touch, hand, this.cellAt(tip));
      if (tip.z > back) touch.before = true;
      else if (tip.z <= 0 && touch.before) {
        touch.before = false;
        this.act(touch.over, hand);
      }
      return 0;
    }
    touch.before = false;
    const ray = hand.ray().applyMatrix4(new Matrix4().copy(this.root.matrix).invert()); // the room's, and so the panel's
    const along = -ray.origin.z / ray.direction.z, at = ray.at(along, new Vector3());
    const met = ray.origin.z > 0 && along > 0 && inside(at);
    this.hover(touch, hand, met ? this.cellAt(at) : null);
    return met ? along : null;
  }

  /** Whether the hand's trigger or pinch is meant for the panel. */
  press(hand: Hand): boolean {
    const touch = this.touchOf(hand);
    if (hand === this.carrier) return false;
    if (touch.near) return true; // fingers press by going through
    if (this.point(hand) === null) return false;
    this.setDown(touch, touch.over);
    return true;
  }

  release(hand: Hand): boolean {
    const touch = this.touches.get(hand);
    if (!touch?.down) return false;
    const { down } = touch, stays = touch.over === down;
    this.setDown(touch, null);
    if (stays) this.act(down, hand);
    return true;
  }

  /** It points elsewhere, or is gone. */
  forget(hand: Hand) {
    if (this.touches.delete(hand)) this.stale = true;
  }

  over(hand: Hand): string | null { return this.touches.get(hand)?.over ?? null; }

  /** In the room: the middle of a cell. */
  middleOf(id: string): Vector3 | null {
    const at = this.picture.middleOf(id);
    return at && new Vector3(at.x / 1000 - width / 2, height / 2 - at.y / 1000, 0).applyMatrix4(this.root.matrix);
  }

  dispose() {
    this.stopWatching();
    this.contents.close();
    this.picture.texture.dispose();
    this.root.geometry.dispose();
    this.root.material.dispose();
    this.root.removeFromParent();
  }

  private draw() {
    this.stale = false;
    const touches = [...this.touches.values()], names = (of: (touch: Touch) => string | null) => new Set(touches.flatMap((touch) => of(touch) ?? []));
    this.picture.draw(this.contents.of(this.ar.desk.page.now), names(({ over }) => over), names(({ down }) => down));
  }

  private touchOf(hand: Hand): Touch {
    const known = this.touches.get(hand) ?? { over: null, down: null, near: false, before: false };
    this.touches.set(hand, known);
    return known;
  }

  private cellAt({ x, y }: Vector3) { return this.picture.cellAt(1000 * (x + width / 2), 1000 * (height / 2 - y))?.id ?? null; }

  private hover(touch: Touch, hand: Hand, over: string | null) {
    if (touch.over === over) return;
    touch.over = over;
    this.stale = true;
    if (over) hand.pulse();
  }

  private setDown(touch: Touch, down: string | null) {
    touch.down = down;
    this.stale = true;
  }

  private act(id: string | null, hand: Hand) {
    const cell = this.contents.of(this.ar.desk.page.now).rows.flat().find((one) => one.id === id);
    if (!cell?.enabled) return;
    hand.pulse();
    cell.act();
    this.stale = true;
  }

  private follow(hands: readonly Hand[], seconds: number) {
    const { position } = this.root, goal = this.goal(hands), away = goal.distanceTo(position);
    if (away > follows) this.going = true;
    else if (away < arrived) this.going = false;
    if (!this.placed) position.copy(goal);
    else if (this.going) position.lerp(goal, 1 - Math.exp(-seconds / delay));
    // It always faces the eyes: text that is seen from the side cannot be read.
    const facing = new Matrix4().lookAt(this.ar.eye.position, position, up);
    this.root.quaternion.slerp(new Quaternion().setFromRotationMatrix(facing), this.placed ? 1 - Math.exp(-seconds / delay) : 1);
    this.root.updateMatrix();
    this.root.updateMatrixWorld(true);
    this.placed = true;
  }

  /** In the room. One hand cannot press what it holds. */
  private goal(hands: readonly Hand[]): Vector3 {
    const left = hands.find((hand) => hand.isLeft && hand.reaches), { eye } = this.ar;
    this.carrier = left && hands.length > 1 ? left : null;
    if (this.carrier) {
      const hand = this.carrier.grip.clone(), away = hand.clone().sub(eye.position).setY(0);
      return hand.addScaledVector(away.normalize(), beforeHand).addScaledVector(up, aboveHand);
    }
    return this.besideModel();
  }

  /** Within reach: to the right of the model as it is seen, no further than an arm. */
  private besideModel(): Vector3 {
    const { ar } = this, { places, page } = ar.desk, { session } = page.now, { position, quaternion } = ar.eye;
    const ahead = new Vector3(0, 0, -1).applyQuaternion(quaternion).setY(0);
    if (session && !ar.isPlacing) {
      const box = places.box(session.member, session.members), size = box.getSize(new Vector3()), back = ar.room.matrix.clone().invert();
      const to = box.getCenter(new Vector3()).applyMatrix4(back).sub(position).setY(0), side = new Vector3().crossVectors(to, up).normalize();
      ahead.copy(to).addScaledVector(side, Math.max(size.x, size.z) / 2 + besideModel);
    }
    if (ahead.lengthSq() < 1e-6) ahead.set(0, 0, -1);
    return ahead.setLength(armLength).add(position).addScaledVector(up, -belowEyes);
  }
}

const inside = ({ x, y }: Vector3) => Math.abs(x) <= width / 2 && Math.abs(y) <= height / 2;
