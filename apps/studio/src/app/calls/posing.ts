// Poses set at once: by numbers, whole, mirrored, undone. Drags are in drags.ts.
import { EngineError } from '../../engine/client';
import type { Command, MotionPreview, Vector } from '../../engine/messages';
import { say } from '../../words/say';
import type { Core } from './core';
import { withSkeleton } from './skeleton_first';

export type PosingCalls = ReturnType<typeof posingCalls>;

export function posingCalls(core: Core) {
  const { page, engine } = core;

  async function poseExactly(command: Command) {
    const { bothSides, session } = page.now;
    await core.run({ ...command, mirrored: bothSides });
    // A model without two sides has been told so.
    if (bothSides && page.now.session === session) page.set({ bothSides: false });
  }

  /** Whether a dragged handle takes its limb along, or stretches the surface alone. */
  async function setIk(on: boolean) {
    const { session } = page.now;
    if (session && session.ik !== on) await core.run({ do: 'set_ik', on, solver: session.solver });
  }

  return {
    async undo() { await core.run({ do: 'undo' }); },
    async redo() { await core.run({ do: 'redo' }); },
    async resetPose() { await core.run({ do: 'reset_pose' }); },
    async mirrorPose() { await core.run({ do: 'mirror_pose', from: 'both' }); },
    async setRestPose() { await core.run({ do: 'set_rest_pose' }); },

    setIk,
    async toggleIk() { await setIk(!page.now.session?.ik); },
    async chooseSolver(solver: string) { await core.run({ do: 'set_ik', on: page.now.session?.ik ?? false, solver }); },

    /** With all that are selected, as the ones below. */
    async resetJoint(joint: number) { await core.run({ do: 'reset_joint', ...core.namedWith(joint) }); },
    /** Degrees about x, y and z, from the rest pose. */
    async setTurn(joint: number, turn: Vector) { await poseExactly({ do: 'set_turn', ...core.namedWith(joint), turn }); },
    /** From the rest pose: 1 is as large as there. */
    async setScale(joint: number, scale: number) { await poseExactly({ do: 'set_scale', ...core.namedWith(joint), scale }); },
    /** In the world, in metres: the limb comes along where limbs follow. */
    async moveJointTo(joint: number, position: Vector) { await poseExactly({ do: 'place_joint', ...core.namedWith(joint), position }); },

    async togglePin(joint: number, position: Vector) {
      const pinned = page.now.pinned.includes(joint), names = core.namedWith(joint);
      await core.run(pinned ? { do: 'clear_target', ...names } : { do: 'set_target', ...names, position });
    },
    async clearTarget(joint: number) { await core.run({ do: 'clear_target', joint: core.jointName(joint) }); },

    /** All of them at once, each as docs/tasks.md has it; for balance the whole body may move. */
    async applyTasks(tasks: string[]) {
      if (page.now.playing) page.set({ playing: false });
      await core.run({ do: 'apply_tasks', tasks, root_moves: tasks.some((task) => task.startsWith('balance')) });
    },

    /** The pose that is shown, as the text of a file. */
    async copyPose(name: string): Promise<string | null> { return core.guard(() => engine.ask({ kind: 'pose', name })); },

    /** Joints: these alone. */
    async applyPose(pose: string, { joints = [], mirrored = false }: { joints?: readonly number[]; mirrored?: boolean } = {}) {
      if (page.now.playing) page.set({ playing: false });
      await core.guard(async () => {
        const names = joints.map((joint) => core.jointName(joint));
        await withSkeleton(core, say('The model needs a skeleton for this pose'),
          () => core.carryOut({ do: 'apply_pose', pose, joints: names, mirrored }), () => engine.ask({ kind: 'try-pose', pose }));
      });
    },

    /** How the model would look in that pose; null where the page is told to stop. */
    async previewPose(pose: string): Promise<MotionPreview | null> {
      try {
        return await engine.ask({ kind: 'preview-pose', pose });
      } catch (error) {
        if (!(error instanceof EngineError)) throw error;
        return error.cancelled ? null : { error: error.error, named: false, seconds: 0, frames: [] };
      }
    },
  };
}
