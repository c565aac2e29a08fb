// Mouse, pen and fingers on the canvas: a handle under one is dragged, anything else moves the camera.
import { Vector3 } from 'three';
import { hasHandles, type PageState, type PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Gizmo } from './gizmo';
import type { HandleView } from './handle_view';
import type { Viewport } from './viewport';

/** Pixels round a handle's middle that count as it. */
export const slop = { mouse: 12, pen: 16, touch: 24 };
export const tapDistance = 6; // pixels that a tap may slide

const orbitStep = 10; // degrees of the view for a press of an arrow

export class PointerInput {
  private held: number | null = null;
  private heldPointer = -1;
  private before: Pick<PageState, 'selected' | 'also'> = { selected: null, also: new Set() };
  private down: { x: number; y: number; moved: boolean } | null = null;

  constructor(
    private viewport: Viewport, private handles: HandleView, private gizmo: Gizmo, private studio: Studio,
    private page: PageStore,
  ) {
    const { canvas } = viewport;
    // Before the camera's own listener, which then sees that it is not meant.
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event));
    canvas.addEventListener('pointercancel', () => this.cancel());
    canvas.addEventListener('pointerleave', () => this.page.set({ hovered: null }));
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** Ctrl turns the magnet round. */
  private snaps(event: PointerEvent) { return this.page.now.snapping !== (event.ctrlKey || event.metaKey); }

  private under(event: PointerEvent): number | null {
    if (!hasHandles(this.page.now.display) || this.page.now.placing) return null;
    const { width, height } = this.viewport.size;
    const near = slop[event.pointerType as keyof typeof slop] ?? slop.mouse;
    return this.handles.pick(event.offsetX, event.offsetY, this.viewport.camera, width, height, near);
  }

  private press(event: PointerEvent) {
    if (this.held !== null) return event.stopImmediatePropagation(); // a second finger during a drag
    this.down = { x: event.offsetX, y: event.offsetY, moved: false };
    if (this.gizmo.meant || this.page.now.selecting) return;
    const joint = event.button === 0 && event.isPrimary ? this.under(event) : null;
    if (joint === null) return;
    event.stopImmediatePropagation();
    this.viewport.canvas.focus({ preventScroll: true });
    this.viewport.canvas.setPointerCapture(event.pointerId);
    this.held = joint;
    this.heldPointer = event.pointerId;
    this.before = { selected: this.page.now.selected, also: this.page.now.also };
    const { ray, view } = this.viewport.ray(event.offsetX, event.offsetY);
    this.studio.beginDrag(joint, ray, view);
  }

  /** Selects alone or, with Shift, besides what was selected. */
  private tap(besides: boolean) {
    this.studio.cancelDrag();
    const { selected } = this.page.now;
    if (!besides || selected === null) return this.page.set({ also: new Set() });
    this.page.set(this.before);
    this.studio.selectAlso(selected);
  }

  private move(event: PointerEvent) {
    if (this.held !== null && event.pointerId !== this.heldPointer) return;
    if (this.down && Math.hypot(event.offsetX - this.down.x, event.offsetY - this.down.y) > tapDistance) this.down.moved = true;
    if (this.held !== null) {
      const { ray, view } = this.viewport.ray(event.offsetX, event.offsetY);
      if (this.down?.moved) this.studio.updateDrag(ray, view, this.snaps(event));
    } else if (event.buttons === 0 && event.pointerType !== 'touch') {
      const hovered = this.under(event);
      if (hovered !== this.page.now.hovered) this.page.set({ hovered });
      this.viewport.canvas.style.cursor = hovered === null ? '' : 'grab';
    }
  }

  private release(event: PointerEvent) {
    if (this.held !== null && event.pointerId !== this.heldPointer) return;
    const tapped = this.down && !this.down.moved;
    if (this.held !== null) {
      this.held = null;
      // A tap selects, and is no step to undo.
      if (tapped) this.tap(event.shiftKey);
      else this.studio.endDrag();
    } else if (tapped && event.isPrimary && !this.gizmo.meant && !this.page.now.selecting) {
      void this.studio.selectSurface(this.viewport.ray(event.offsetX, event.offsetY).ray, 0);
    }
    this.down = null;
  }

  cancel() {
    if (this.held === null) return;
    this.held = null;
    this.down = null;
    this.studio.cancelDrag();
  }

  /** Arrows move, turn or scale the selected joint as the camera sees it; where none is selected, the view. */
  private key(event: KeyboardEvent) {
    if (event.key === 'Escape') return this.cancel();
    const { selected, session, mode, snapping } = this.page.now;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!step || !session || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const [x = 0, y = 0] = step;
    if (selected === null) return this.viewport.orbit(orbitStep * x, orbitStep * y);
    const { right, up } = this.viewport.axes();
    if (mode === 'turn') {
      const axis = x === 0 ? right : up;
      this.studio.turn(selected, axis.toArray(), (x - y) * (snapping ? session.snap.degrees : event.shiftKey ? 1 : 5));
      return;
    }
    if (mode === 'scale') return this.studio.scale(selected, (snapping ? 1.1 : event.shiftKey ? 1.01 : 1.05) ** (x + y));
    const size = new Vector3(...session.box.max).distanceTo(new Vector3(...session.box.min));
    const length = snapping ? session.snap.step : size * (event.shiftKey ? 0.002 : 0.01);
    const offset = right.multiplyScalar(x).addScaledVector(up, y).multiplyScalar(length);
    this.studio.nudge(selected, offset.toArray());
  }
}
