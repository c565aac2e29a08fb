// While models are being placed: one that is pressed goes over the floor with the pointer.
import { Matrix4, Plane, Ray, Vector3 } from 'three';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Places } from './places';
import type { Viewport } from './viewport';

const steepest = 0.02; // of the pointer's ray against the floor: flatter ones would throw the model to the horizon

export class PlaceInput {
  private held: { member: number; pointer: number; from: Vector3; place: Matrix4; floor: Plane } | null = null;
  private moved = false;

  constructor(private viewport: Viewport, private places: Places, private onMove: () => void, private studio: Studio, private page: PageStore) {
    const { canvas } = viewport;
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event));
    canvas.addEventListener('pointercancel', () => this.cancel());
    addEventListener('keydown', (event) => { if (event.key === 'Escape') this.cancel(); });
  }

  /** In the world. */
  private ray(event: PointerEvent): Ray {
    const { ray } = this.viewport.ray(event.offsetX, event.offsetY);
    return new Ray(new Vector3(...ray.origin), new Vector3(...ray.direction)).applyMatrix4(new Matrix4().copy(this.viewport.world.matrix).invert());
  }

  private press(event: PointerEvent) {
    const { arranging, session } = this.page.now;
    if (!arranging || !session) return;
    if (this.held) return event.stopImmediatePropagation(); // a second finger
    const ray = this.ray(event);
    if (event.button !== 0 || !event.isPrimary) return;
    const met = session.members.flatMap((_, member) => {
      const at = ray.intersectBox(this.places.box(member, session.members), new Vector3());
      return at ? [{ member, at }] : [];
    }).sort((a, b) => a.at.distanceTo(ray.origin) - b.at.distanceTo(ray.origin))[0];
    if (!met) return;
    event.stopImmediatePropagation();
    this.viewport.canvas.setPointerCapture(event.pointerId);
    this.moved = false;
    this.held = {
      member: met.member, pointer: event.pointerId, from: met.at, place: this.places.of(met.member).clone(),
      floor: new Plane().setFromNormalAndCoplanarPoint(new Vector3(0, 1, 0), met.at),
    };
  }

  private move(event: PointerEvent) {
    const { held } = this, { session } = this.page.now;
    if (!held || !session || event.pointerId !== held.pointer) return;
    const ray = this.ray(event), to = Math.abs(ray.direction.y) < steepest ? null : ray.intersectPlane(held.floor, new Vector3());
    if (!to) return;
    this.moved = true;
    const by = to.sub(held.from);
    this.places.move(held.member, new Matrix4().makeTranslation(by.x, 0, by.z).multiply(held.place), session.members);
    this.onMove();
  }

  private release(event: PointerEvent) {
    const { held } = this, { session } = this.page.now;
    if (!held || !session || event.pointerId !== held.pointer) return;
    this.held = null;
    const position = new Vector3().setFromMatrixPosition(this.places.of(held.member)).toArray();
    if (this.moved) void this.studio.placeMember(held.member, { ...this.places.placement(held.member, session.members), position });
    else void this.studio.chooseMember(held.member);
  }

  private cancel() {
    const { held } = this, { session } = this.page.now;
    this.held = null;
    if (!held || !session) return;
    this.places.move(held.member, held.place, session.members);
    this.onMove();
  }
}
