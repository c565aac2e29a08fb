// Several joints at once: a box drawn with Shift beside them or, as touch has no Shift, while joints are being selected
// (state.ts, `selecting`): taps add one or take it back, and two fingers still move the camera.
import { MOUSE, TOUCH } from 'three';
import { hasHandles, type PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { element } from '../ui/dom';
import type { Gizmo } from './gizmo';
import type { HandleView } from './handle_view';
import { slop, tapDistance } from './pointer';
import type { Viewport } from './viewport';

interface Point {
  x: number;
  y: number;
}

export class BoxSelect {
  private from: Point | null = null;
  private pointer = -1;
  private drawn: HTMLElement | null = null;

  constructor(
    private viewport: Viewport, private handles: HandleView, private gizmo: Gizmo, private studio: Studio,
    private page: PageStore,
  ) {
    const { canvas, controls } = viewport;
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event));
    canvas.addEventListener('pointercancel', () => this.cancel());
    addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      if (this.from) this.cancel();
      else if (page.now.selecting) page.set({ selecting: false });
    });
    page.watch(({ selecting }, before) => {
      if (selecting === before.selecting) return;
      controls.mouseButtons.LEFT = selecting ? null : MOUSE.ROTATE;
      controls.touches.ONE = selecting ? null : TOUCH.ROTATE;
      canvas.classList.toggle('selecting', selecting);
    });
  }

  private under(event: PointerEvent): number | null {
    const { width, height } = this.viewport.size;
    return this.handles.pick(event.offsetX, event.offsetY, this.viewport.camera, width, height, slop[event.pointerType as keyof typeof slop] ?? slop.mouse);
  }

  private press(event: PointerEvent) {
    if (this.from) return this.cancel(); // a second finger: the camera is meant
    const { display, placing, selecting, session } = this.page.now;
    if (!session || !hasHandles(display) || placing || this.gizmo.meant || event.button !== 0 || !event.isPrimary) return;
    if (!selecting && !(event.shiftKey && this.under(event) === null)) return;
    if (!selecting) event.stopImmediatePropagation(); // the camera would be shifted
    this.viewport.canvas.focus({ preventScroll: true });
    this.viewport.canvas.setPointerCapture(event.pointerId);
    this.from = { x: event.offsetX, y: event.offsetY };
    this.pointer = event.pointerId;
  }

  private move(event: PointerEvent) {
    if (!this.from || event.pointerId !== this.pointer) return;
    const { x, y } = this.from, to = { x: event.offsetX, y: event.offsetY };
    if (!this.drawn && Math.hypot(to.x - x, to.y - y) <= tapDistance) return;
    this.drawn ??= this.begun();
    const { left, top, right, bottom } = this.box(to);
    Object.assign(this.drawn.style, { left: `${left}px`, top: `${top}px`, width: `${right - left}px`, height: `${bottom - top}px` });
  }

  private begun(): HTMLElement {
    const drawn = element('div', { class: 'select-box' });
    this.viewport.canvas.after(drawn);
    return drawn;
  }

  private box(to: Point) {
    const from = this.from!;
    return { left: Math.min(from.x, to.x), top: Math.min(from.y, to.y), right: Math.max(from.x, to.x), bottom: Math.max(from.y, to.y) };
  }

  private release(event: PointerEvent) {
    if (!this.from || event.pointerId !== this.pointer) return;
    if (this.drawn) this.add(this.box({ x: event.offsetX, y: event.offsetY }));
    else this.tap(event);
    this.cancel();
  }

  private add(box: ReturnType<BoxSelect['box']>) {
    const { width, height } = this.viewport.size, { selected, also } = this.page.now;
    const inside = this.handles.within(box, this.viewport.camera, width, height);
    const first = selected ?? inside[0];
    if (first === undefined) return;
    this.page.set({ selected: first, also: new Set([...also, ...inside].filter((joint) => joint !== first)) });
  }

  private tap(event: PointerEvent) {
    const joint = this.under(event);
    if (joint !== null) this.studio.selectAlso(joint);
    else void this.studio.selectSurface(this.viewport.ray(event.offsetX, event.offsetY).ray, 0, true);
  }

  private cancel() {
    this.from = null;
    this.drawn?.remove();
    this.drawn = null;
  }
}
