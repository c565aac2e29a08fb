// What a program that drives a headset (a test) can ask of what is drawn in the room.
import { Vector3 } from 'three';
import type { Vector } from '../../engine/messages';
import type { ArView } from '../ar_view';
import type { Hand } from './hand';
import type { SpacePanel } from './space_panel';

export interface HeadsetProbe {
  /** In the room, metres. */
  handle(joint: string): Vector;
  /** The middle of a member's box, that far up in it. */
  member(member: number, up?: number): Vector;
  /** The middle of a panel's cell; null where it is not shown. */
  cell(id: string): Vector | null;
  /** What a hand takes with, touches with, and what it holds goes along with. */
  hand(side: XRHandedness): { grip: Vector; tip: Vector; carrier: Vector } | null;
  /** The panel's cell that a hand is on. */
  over(side: XRHandedness): string | null;
  /** What the panel says. */
  says(): string;
  /** The joint that is highlighted. */
  hovered(): number | null;
}

declare global {
  var limberHeadset: HeadsetProbe | undefined;
}

export function exposeHeadset(ar: ArView, panel: SpacePanel, hands: ReadonlyMap<XRInputSource, Hand>) {
  const { page, handles, places } = ar.desk;
  const handOf = (side: XRHandedness) => [...hands.values()].find(({ source }) => source.handedness === side);
  globalThis.limberHeadset = {
    handle: (name) => {
      const joint = page.now.session?.joints.findIndex((known) => known.name === name) ?? -1;
      if (joint < 0) throw new Error(`no joint is called ${name}`);
      return handles.position(joint, new Vector3()).applyMatrix4(ar.room.matrixWorld.clone().invert()).toArray();
    },
    member: (member, up = 0.5) => {
      const box = places.box(member, page.now.session!.members), at = box.getCenter(new Vector3());
      at.y = box.min.y + up * (box.max.y - box.min.y);
      return at.applyMatrix4(ar.room.matrix.clone().invert()).toArray();
    },
    cell: (id) => panel.middleOf(id)?.toArray() ?? null,
    over: (side) => {
      const hand = handOf(side);
      return hand ? panel.over(hand) : null;
    },
    hand: (side) => {
      const hand = handOf(side);
      return hand ? { grip: hand.grip.toArray(), tip: hand.tip.toArray(), carrier: new Vector3().setFromMatrixPosition(hand.carrier).toArray() } : null;
    },
    hovered: () => page.now.hovered,
    says: () => panel.contents.of(page.now).title,
  };
}
