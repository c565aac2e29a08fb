// One finger on a handle: it stays under the finger, at its distance from the device. So it moves in the plane that faces
// the camera, and walking with it pushes and pulls.
import { Vector3 } from 'three';
import { pixelSize } from '../scene/handle_view';
import { tapDistance } from '../scene/pointer';
import type { Desk } from './desk';
import type { Finger, Gesture } from './gesture';

export class HandleDrag implements Gesture {
  begun = false;
  private readonly from: Vector3;
  private readonly offset: { x: number; y: number }; // of the handle's middle from the finger, pixels
  private readonly depth: number; // of the handle before the camera, metres of the model's own space
  private readonly mode;
  private asked = '';
  private rest = new Vector3(); // between where the finger wants the handle and where its limb reaches
  private readonly stopReading: () => void;

  constructor(private desk: Desk, private joint: number, private finger: Finger) {
    const { studio, page, viewport, handles } = desk, { width, height } = viewport.size;
    this.mode = page.now.mode;
    this.from = handles.position(joint);
    const seen = this.from.clone().project(viewport.camera);
    this.offset = { x: ((seen.x + 1) / 2) * width - finger.x, y: ((1 - seen.y) / 2) * height - finger.y };
    const { ray, view } = this.ray();
    this.depth = this.from.clone().sub(new Vector3(...ray.origin)).dot(new Vector3(...view));
    this.stopReading = studio.readStance(({ handles: stood }) => {
      const shown = studio.shownDrag();
      if (this.begun && shown?.do === 'update_drag') this.rest.fromArray(stood, 4 * joint).sub(this.wanted(shown));
    });
    // Through its middle: the screen's plane turns with the device, and an offset within it would turn away.
    studio.beginDrag(joint, ray, view);
  }

  frame() {
    const { studio, viewport, handles } = this.desk, to = this.ray(), wanted = this.wanted(to);
    if (!this.begun) {
      const { camera, size } = viewport;
      this.begun = wanted.distanceTo(this.from) > tapDistance * pixelSize(this.from, camera, size.height);
    }
    if (!this.begun) return;
    const asked = JSON.stringify(to);
    if (asked !== this.asked) studio.updateDrag(to.ray, to.view); // else neither finger nor device has moved
    this.asked = asked;
    // The engine answers a frame or two later, and the device has moved on by then.
    if (this.mode === 'move') handles.hold(this.joint, wanted.add(this.rest));
  }

  end() {
    this.stopReading();
    if (this.begun) this.desk.studio.endDrag();
    else this.desk.studio.cancelDrag(); // a tap selects, and is no step to undo
  }

  private ray() { return this.desk.viewport.ray(this.finger.x + this.offset.x, this.finger.y + this.offset.y); }

  private wanted({ ray, view }: { ray: { origin: number[]; direction: number[] }; view: number[] }): Vector3 {
    const direction = new Vector3().fromArray(ray.direction).normalize(), ahead = direction.dot(new Vector3().fromArray(view).normalize());
    return new Vector3().fromArray(ray.origin).addScaledVector(direction, this.depth / ahead);
  }
}
