// Mouse, pen and fingers while weights are painted: on the surface they paint, beside it and with two fingers they turn the
// view. Alt and the right button go on to the camera.
import { MOUSE } from 'three';
import type { PaintMode, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Command, SurfaceHit } from '../engine/messages';
import type { BrushView } from './brush_view';
import type { Viewport } from './viewport';

const spacing = 5; // pixels between two dabs
const mostRays = 24; // asked for at once, so that the picture keeps up
const turnSpeed = 0.4; // degrees of the view for a pixel

type Point = { x: number; y: number };

/** From press to release. What the pointer does is not known until the surface has been asked for. */
interface Gesture {
  does: 'ask' | 'paint' | 'turn';
  command: Command;
  dabs: SurfaceHit['dab'][];
  /** Where the pointer went and nobody has asked for the surface yet. */
  path: Point[];
  ended: boolean;
  dropped: boolean;
  wake: () => void;
}

export class PaintInput {
  private gesture: Gesture | null = null;
  private gestures: Promise<void> = Promise.resolve(); // one after the other
  private pointer = -1;
  private fingers = new Map<number, Point>();
  private last: Point = { x: 0, y: 0 };
  private hovered: Point | null = null;
  private hovering = false;
  private under: SurfaceHit | null = null;

  constructor(private viewport: Viewport, private brush: BrushView, private studio: Studio, private page: PageStore) {
    const { canvas } = viewport;
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event));
    canvas.addEventListener('pointercancel', (event) => this.release(event));
    canvas.addEventListener('pointerleave', () => this.hide());
    addEventListener('keydown', (event) => { if (event.key === 'Escape') this.drop(); });
    page.watch((now, before) => {
      if (now.painting !== before.painting) {
        this.drop();
        this.hide();
        viewport.controls.mouseButtons.RIGHT = now.painting ? MOUSE.ROTATE : MOUSE.PAN;
        canvas.classList.toggle('painting', now.painting);
      } else if (now.brush !== before.brush) this.showRing();
    });
  }

  private get radius() {
    const { session, brush } = this.page.now;
    return session ? brush.size * Math.max(...session.box.max.map((most, i) => most - session.box.min[i]!)) : 0;
  }

  private press(event: PointerEvent) {
    if (!this.page.now.painting || event.altKey || event.button !== 0) return;
    event.stopImmediatePropagation();
    const { canvas } = this.viewport, at = { x: event.offsetX, y: event.offsetY };
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    if (event.pointerType === 'touch') this.fingers.set(event.pointerId, at);
    if (this.fingers.size > 1) return this.drop();
    this.pointer = event.pointerId;
    this.last = at;
    const mode = event.shiftKey ? 'smooth' : event.ctrlKey || event.metaKey ? 'subtract' : this.page.now.brush.mode;
    const gesture: Gesture = { does: 'ask', command: this.commandOf(mode), dabs: [], path: [at], ended: false, dropped: false, wake: () => {} };
    this.gesture = gesture;
    this.gestures = this.gestures.then(() => this.follow(gesture));
  }

  private move(event: PointerEvent) {
    if (!this.page.now.painting) return;
    const at = { x: event.offsetX, y: event.offsetY };
    if (this.fingers.size === 2 && this.fingers.has(event.pointerId)) return this.twoFingers(event.pointerId, at);
    const { gesture } = this;
    if (gesture === null) {
      if (event.buttons === 0 && event.pointerType !== 'touch') this.hover(at);
      return;
    }
    if (event.pointerId !== this.pointer) return;
    if (gesture.does === 'turn') {
      this.viewport.orbit(turnSpeed * (this.last.x - at.x), turnSpeed * (at.y - this.last.y));
      this.last = at;
      return;
    }
    const steps = Math.ceil(Math.hypot(at.x - this.last.x, at.y - this.last.y) / spacing);
    for (let i = 1; i <= steps; ++i) {
      gesture.path.push({ x: this.last.x + ((at.x - this.last.x) * i) / steps, y: this.last.y + ((at.y - this.last.y) * i) / steps });
    }
    if (steps > 0) this.last = at;
    gesture.wake();
  }

  /** They turn the view together, and come nearer by moving apart. */
  private twoFingers(id: number, at: Point) {
    const before = this.fingers.get(id)!, other = [...this.fingers].find(([known]) => known !== id)![1];
    this.viewport.orbit((turnSpeed * (before.x - at.x)) / 2, (turnSpeed * (at.y - before.y)) / 2);
    const apart = Math.hypot(at.x - other.x, at.y - other.y), was = Math.hypot(before.x - other.x, before.y - other.y);
    if (apart > 1 && was > 1) this.viewport.zoom(apart / was);
    this.fingers.set(id, at);
  }

  private release(event: PointerEvent) {
    this.fingers.delete(event.pointerId);
    if (event.pointerType === 'touch') this.hide();
    if (!this.gesture || event.pointerId !== this.pointer) return;
    if (event.type === 'pointercancel') return this.drop();
    this.gesture.ended = true;
    this.gesture.wake();
    this.gesture = null;
  }

  private commandOf(mode: PaintMode): Command {
    const { session, selected, brush } = this.page.now;
    return {
      do: 'paint_weights', joint: session?.joints[selected ?? 0]?.name ?? '', mode, strength: brush.strength, radius: this.radius,
      mirrored: this.page.now.bothSides,
    };
  }

  /** The path goes to the engine a piece at a time; what gathers meanwhile, next. */
  private async follow(gesture: Gesture) {
    const { dabs, path } = gesture;
    const stroke = () => ({ ...gesture.command, dabs });
    while (!gesture.dropped && (path.length > 0 || !gesture.ended)) {
      const points = path.splice(0, mostRays);
      if (points.length === 0) {
        await new Promise<void>((resolve) => { gesture.wake = resolve; });
        continue;
      }
      const hits = await this.studio.surface(points.map(({ x, y }) => this.viewport.ray(x, y).ray));
      if (gesture.does === 'ask') gesture.does = hits[0] ? 'paint' : 'turn';
      if (gesture.does === 'turn') return;
      for (const hit of hits) if (hit) dabs.push(hit.dab);
      this.under = hits.at(-1) ?? null;
      this.showRing();
      if (!gesture.dropped) await this.studio.previewStroke(stroke());
    }
    if (dabs.length === 0) return;
    if (gesture.dropped) await this.studio.previewStroke(null);
    else await this.studio.run(stroke());
  }

  /** As if the stroke had not begun. */
  private drop() {
    if (!this.gesture) return;
    this.gesture.dropped = true;
    this.gesture.wake();
    this.gesture = null;
  }

  /** At most one place is asked for at a time; the newest waits. */
  private hover(at: Point) {
    this.hovered = at;
    if (this.hovering) return;
    this.hovering = true;
    void (async () => {
      while (this.hovered) {
        const { x, y } = this.hovered;
        this.hovered = null;
        [this.under = null] = await this.studio.surface([this.viewport.ray(x, y).ray]);
        this.showRing();
      }
    })().finally(() => { this.hovering = false; });
  }

  private showRing() {
    if (this.under && this.page.now.painting) this.brush.show(this.under, this.radius);
    else this.brush.hide();
    this.viewport.draw();
  }

  private hide() {
    this.hovered = null;
    this.under = null;
    this.brush.hide();
    this.viewport.draw();
  }
}
