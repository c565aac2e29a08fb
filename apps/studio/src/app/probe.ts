// What a program that drives the page (a test, a script that makes pictures) can ask of it.
import { Vector3 } from 'three';
import type { ArProbe } from '../ar/ar_probe';
import type { Curve, SessionState, Vector } from '../engine/messages';
import type { Gizmo } from '../scene/gizmo';
import { pixelSize, type HandleView } from '../scene/handle_view';
import type { Places } from '../scene/places';
import type { Viewport } from '../scene/viewport';
import type { PageStore } from './state';
import type { Studio } from './studio';

export interface StudioProbe {
  /** Nothing is asked of the engine that it has not answered. */
  idle(): boolean;
  /** Every change is kept in the browser. */
  kept(): boolean;
  state(): SessionState | null;
  /** Of the selected joint, where curves are drawn. */
  curve(): Curve | null;
  /** How many requests made the document. */
  steps(): number;
  selected(): number | null;
  /** Metres. */
  position(joint: string): Vector;
  /** Degrees about x, y and z from the rest pose, and the rotation in the world as x, y, z, w. */
  turned(joint: string): { turn: Vector; rotation: number[] };
  /** What of the gizmo is under the pointer. */
  gizmoAxis(): string | null;
  /** Where a member of the scene has its origin, in metres; where the middle of its box is drawn, that far up in it, in pixels. */
  memberAt(member: number): Vector;
  memberPlace(member: number, up?: number): { x: number; y: number };
  /** Pixels of the page. */
  place(joint: string): { x: number; y: number };
  /** Of a point in the chosen model's own space. */
  placeOf(position: Vector): { x: number; y: number };
  /** With which its handle is drawn, in pixels. */
  radius(joint: string): number;
  /** While models are seen in a real place. */
  ar?: ArProbe;
}

declare global {
  var limberStudio: StudioProbe | undefined;
}

export function exposeStage(
  studio: Studio, page: PageStore, viewport: Viewport, handles: HandleView, gizmo: Gizmo, places: Places, kept: () => boolean,
) {
  const jointOf = (name: string) => {
    const joint = page.now.session?.joints.findIndex((known) => known.name === name) ?? -1;
    if (joint < 0) throw new Error(`no joint is called ${name}`);
    return joint;
  };
  const onPage = (at: Vector3) => {
    viewport.camera.updateMatrixWorld();
    const { x, y } = at.project(viewport.camera);
    const { width, height } = viewport.size, { left, top } = page.now.ar ? { left: 0, top: 0 } : viewport.canvas.getBoundingClientRect();
    return { x: left + ((x + 1) / 2) * width, y: top + ((1 - y) / 2) * height };
  };
  const position = (name: string) => handles.position(jointOf(name), new Vector3());
  let turns: Float32Array = new Float32Array();
  studio.readStance((stance) => { turns = stance.turns; });
  globalThis.limberStudio = {
    idle: () => studio.idle,
    kept,
    state: () => page.now.session,
    curve: () => page.now.curve,
    steps: () => studio.stepCount(),
    selected: () => page.now.selected,
    gizmoAxis: () => gizmo.axis,
    position: (name) => position(name).toArray(),
    memberPlace: (member, up = 0.5) => {
      const box = places.box(member, page.now.session!.members), at = box.getCenter(new Vector3());
      at.y = box.min.y + up * (box.max.y - box.min.y);
      return onPage(at.applyMatrix4(viewport.world.matrix));
    },
    turned: (name) => {
      const [x = 0, y = 0, z = 0, ...rotation] = turns.slice(7 * jointOf(name), 7 * jointOf(name) + 7);
      return { turn: [x, y, z], rotation };
    },
    memberAt: (member) => new Vector3().setFromMatrixPosition(places.of(member)).toArray(),
    place: (name) => onPage(position(name)),
    placeOf: (at) => onPage(new Vector3(...at)),
    radius: (name) => {
      const { camera, size: { height } } = viewport;
      return handles.drawnRadius(jointOf(name), camera, height) / pixelSize(position(name), camera, height);
    },
  };
}
