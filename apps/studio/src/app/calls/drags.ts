// Joints dragged by the pointer or moved by keys, which is a drag as well.
import type { Command, Ray, Vector } from '../../engine/messages';
import type { DragMode } from '../state';
import type { Core } from './core';
import type { RigCalls } from './rig';

const nudgePause = 1000; // milliseconds: presses of keys that follow each other sooner are one step to undo
const ahead: Vector = [0, 0, -1];

type DragUpdate =
  | { do: 'update_drag'; ray: Ray; view: Vector; snap: boolean }
  | { do: 'turn_drag'; axis: Vector; degrees: number }
  | { do: 'scale_drag'; scale: number }
  | { do: 'move_drag'; offset: Vector; turn: Vector };

export type DragCalls = ReturnType<typeof dragCalls>;

export function dragCalls(core: Core, { pinJoint }: RigCalls) {
  const { page } = core;
  let waiting: DragUpdate | null = null, asked: DragUpdate | null = null;
  let dragging: Promise<void> = Promise.resolve();
  let lastNudge = { of: '', at: -Infinity };

  /** The steps of a drag go one after the other. */
  const then = (step: () => Promise<void>) => void core.counted(() => (dragging = dragging.then(step)));
  const isDragging = () => page.now.session?.dragged != null;

  function beginDrag(joint: number, ray: Ray, view: Vector, mode = page.now.mode) {
    const { bothSides, correcting, playing } = page.now;
    const together = core.besides(joint);
    const command = {
      do: 'begin_drag', joint: core.jointName(joint), mode: correcting ? 'move' : mode, ray, view,
      with: correcting ? [] : together.map((other) => core.jointName(other)), mirrored: bothSides && !correcting,
    };
    if (playing) page.set({ playing: false });
    page.set({ selected: joint, also: new Set(together) });
    then(async () => {
      await core.run(command);
      // A model without two sides has been told so.
      if (!isDragging() && bothSides) page.set({ bothSides: false });
    });
  }

  /** At most one update is on its way; the newest waits. */
  function dragTo(command: DragUpdate) {
    const underWay = waiting !== null;
    waiting = command;
    if (underWay) return;
    then(async () => {
      const command = waiting;
      waiting = null;
      if (!command || !isDragging()) return;
      asked = command;
      await core.run(command);
    });
  }

  function endDrag(goesOn = false) {
    then(async () => {
      if (isDragging()) await (page.now.correcting ? pinDragged() : core.run({ do: 'end_drag', goes_on: goesOn }));
    });
  }

  /** Where the dragged joint is becomes where the rig has it. */
  async function pinDragged() {
    const joint = page.now.session?.dragged ?? null, handles = core.stance?.handles;
    await core.run({ do: 'cancel_drag' });
    if (joint === null || !handles) return;
    await pinJoint(joint, [handles[4 * joint]!, handles[4 * joint + 1]!, handles[4 * joint + 2]!]);
  }

  function dragByKey(joint: number, mode: DragMode, update: Command) {
    const of = [mode, joint, ...core.besides(joint)].join(), at = performance.now();
    const goesOn = lastNudge.of === of && at - lastNudge.at < nudgePause;
    lastNudge = { of, at };
    beginDrag(joint, { origin: [0, 0, 0], direction: ahead }, ahead, mode);
    then(async () => {
      if (isDragging()) await core.run(update);
    });
    endDrag(goesOn);
  }

  return {
    beginDrag,
    updateDrag(ray: Ray, view: Vector, snap = false) { dragTo({ do: 'update_drag', ray, view, snap }); },
    /** About the dragged joint's own place, from how it stood when the drag began. */
    turnDrag(axis: Vector, degrees: number) { dragTo({ do: 'turn_drag', axis, degrees }); },
    /** So many times as large as when the drag, one that scales, began. */
    scaleDrag(scale: number) { dragTo({ do: 'scale_drag', scale }); },
    /** As a hand carries it, from where it was when the drag, one that moves, began: metres, and degrees about an axis as one vector. */
    moveDrag(offset: Vector, turn: Vector) { dragTo({ do: 'move_drag', offset, turn }); },
    /** What the joints that are shown during a drag answer to. */
    shownDrag: (): DragUpdate | null => asked,
    endDrag,
    cancelDrag() {
      waiting = null;
      then(async () => {
        if (isDragging()) await core.run({ do: 'cancel_drag' });
      });
    },

    /** What a drag that far does. */
    nudge(joint: number, offset: Vector) {
      dragByKey(joint, 'move', { do: 'update_drag', ray: { origin: offset, direction: ahead }, view: ahead });
    },
    turn(joint: number, axis: Vector, degrees: number) { dragByKey(joint, 'turn', { do: 'turn_drag', axis, degrees }); },
    scale(joint: number, scale: number) { dragByKey(joint, 'scale', { do: 'scale_drag', scale }); },
  };
}
