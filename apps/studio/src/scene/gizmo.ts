// Arrows, rings and boxes on the selected joint, for exact work.
import { Object3D, Quaternion } from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { hasHandles, type PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { HandleView } from './handle_view';
import type { Viewport } from './viewport';

const view: [number, number, number] = [0, 0, -1];
const controlModes = { move: 'translate', turn: 'rotate', scale: 'scale' } as const;
const minScale = 0.01;

export class Gizmo {
  readonly controls: TransformControls;
  private proxy = new Object3D();
  private turned: Quaternion = this.proxy.quaternion.clone();
  private held: number | null = null;
  private turns: Float32Array = new Float32Array();
  private control = false; // its key is down

  constructor(private viewport: Viewport, private handles: HandleView, private studio: Studio, private page: PageStore) {
    this.controls = new TransformControls(viewport.camera, viewport.canvas);
    this.controls.size = 0.8;
    this.controls.setSpace('local'); // of the proxy, which stands as the chosen space does
    viewport.scene.add(this.proxy, this.controls.getHelper());
    this.controls.addEventListener('change', () => viewport.draw());
    this.controls.addEventListener('dragging-changed', ({ value }) => {
      viewport.controls.enabled = !value;
      if (value) this.begin();
      else this.end();
    });
    this.controls.addEventListener('objectChange', () => this.change());
    viewport.controls.addEventListener('change', () => {
      if (page.now.gizmo && page.now.gizmoSpace === 'view') this.place();
    });
    const controlKey = (event: KeyboardEvent) => {
      this.control = event.ctrlKey || event.metaKey;
      this.snap();
    };
    addEventListener('keydown', controlKey);
    addEventListener('keyup', controlKey);
    page.watch(() => {
      this.place();
      this.snap();
    });
  }

  /** Whether the pointer is on an arrow, a ring or a box. */
  get axis() { return this.controls.object === undefined ? null : this.controls.axis; }
  get meant() { return this.controls.object !== undefined && this.controls.axis !== null; }

  /** How the joints are turned (Stance). */
  take(turns: Float32Array) { this.turns = turns; }

  place() {
    const { gizmo, gizmoSpace, selected, mode, display } = this.page.now;
    this.controls.camera = this.viewport.camera;
    if (!gizmo || selected === null || selected >= this.handles.count || !hasHandles(display)) {
      this.controls.detach();
      return;
    }
    this.controls.setMode(controlModes[mode]);
    this.controls.showZ = mode !== 'turn' || gizmoSpace !== 'view'; // the outer ring does the same
    if (this.held === null) {
      this.proxy.position.copy(this.handles.position(selected));
      this.axes(selected, this.proxy.quaternion);
      this.proxy.scale.setScalar(1);
    }
    if (this.controls.object !== this.proxy) this.controls.attach(this.proxy);
  }

  /** As the chosen space stands in the model's own. */
  private axes(joint: number, target: Quaternion): Quaternion {
    const { gizmoSpace, session } = this.page.now;
    if (gizmoSpace === 'view') return this.viewport.camera.getWorldQuaternion(target);
    const of = gizmoSpace === 'local' ? joint : gizmoSpace === 'parent' ? session?.joints[joint]?.parent ?? -1 : -1;
    return of < 0 || this.turns.length < 7 * (of + 1) ? this.viewport.world.getWorldQuaternion(target) : target.fromArray(this.turns, 7 * of + 3);
  }

  private snap() {
    const { snapping, session } = this.page.now, on = session !== null && snapping !== this.control;
    this.controls.setTranslationSnap(on ? session.snap.step : null);
    this.controls.setScaleSnap(on ? 0.1 : null);
    this.controls.setRotationSnap(on ? (session.snap.degrees * Math.PI) / 180 : null);
  }

  private begin() {
    const { selected, mode } = this.page.now;
    this.held = selected;
    if (selected === null) return;
    this.turned = this.proxy.quaternion.clone();
    // A camera that moves along takes the joint with it, wherever it goes: that is how the arrows' way is told.
    this.studio.beginDrag(selected, this.ray(), view, mode);
  }

  private change() {
    if (this.held === null) return;
    if (this.page.now.mode === 'move') return this.studio.updateDrag(this.ray(), view);
    if (this.page.now.mode === 'scale') return this.studio.scaleDrag(this.scaled());
    const { x, y, z, w } = this.proxy.quaternion.clone().multiply(this.turned.clone().invert());
    const sine = Math.hypot(x, y, z);
    const degrees = (2 * Math.atan2(sine, w) * 180) / Math.PI;
    this.studio.turnDrag(sine > 1e-6 ? [x / sine, y / sine, z / sine] : [0, 1, 0], sine > 1e-6 ? degrees : 0);
  }

  /** By whichever box is pulled: joints are scaled along all axes. */
  private scaled() {
    const [least, , most] = this.proxy.scale.toArray().sort((a, b) => a - b);
    return Math.max(minScale, most! > 1 ? most! : least!);
  }

  private ray() {
    const { x, y, z } = this.proxy.position;
    return { origin: [x, y, z + 1] as [number, number, number], direction: view };
  }

  private end() {
    if (this.held === null) return;
    this.held = null;
    this.studio.endDrag();
  }
}
