// What a program that drives the page can ask of augmented reality (app/probe.ts).
import { Vector3 } from 'three';
import type { Vector } from '../engine/messages';
import type { ArView } from './ar_view';

/** All in the room, in metres. */
export interface ArProbe {
  /** Below the middle of a member's feet. */
  base(member: number): Vector;
  joint(name: string): Vector;
  /** Where a point of the room is on the screen, in pixels. */
  spot(at: Vector): { x: number; y: number };
}

export function arProbe(view: ArView): ArProbe {
  const { handles, viewport, page } = view.desk;
  const inRoom = (at: Vector3) => view.room.worldToLocal(at).toArray();
  return {
    base: (member) => inRoom(view.baseOf(member).applyMatrix4(viewport.world.matrix)),
    joint: (name) => inRoom(handles.position(page.now.session!.joints.findIndex((joint) => joint.name === name), new Vector3())),
    spot(at) {
      const { width, height } = viewport.size, { x, y } = view.room.localToWorld(new Vector3(...at)).project(viewport.camera);
      return { x: ((x + 1) / 2) * width, y: ((1 - y) / 2) * height };
    },
  };
}
