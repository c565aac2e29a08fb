// How the rig is made: handles, methods, limits, and joints of a named skeleton put right.
import type { RigCheck, Vector } from '../../engine/messages';
import { counted } from '../../ui/counted';
import { say } from '../../words/say';
import type { Core } from './core';

export type RigCalls = ReturnType<typeof rigCalls>;

/** `told`: says that something is gone, with a way to bring it back. */
export function rigCalls(core: Core, told: (title: string) => void) {
  const { page, engine } = core;
  let wantedHandles: number | null = null, askedHandles = 0;

  /** Whether what is asked for may replace the rig that the model came with. */
  async function mayReplaceRig(): Promise<boolean> {
    const { session } = page.now;
    if (session && !session.own_rig && session.edited_rig) {
      return core.ask(say('Replace the rig that you changed?'), say('Painted weights and joints changed by hand go. Undo brings them back.'), say('Replace it'));
    }
    if (!session?.own_rig) return true;
    return core.ask(say('Replace the rig of this model?'),
      say('It came with {joints} that have names; they go, and its clips move to the new ones. Undo brings them back.', { joints: counted(session.joints.length, 'joint') }),
      say('Replace it'));
  }

  /** Whether there is something in the rig that no method makes again. */
  const isPrecious = () => page.now.session?.own_rig === true || page.now.session?.edited_rig === true;
  const tellReplaced = (before: boolean) => { if (before && !isPrecious()) told(say('The rig was replaced')); };

  const mayFitAnew = async () => !page.now.session?.edited_rig || await mayReplaceRig();

  return {
    /** The last count asked for counts; those that a slider passes on its way are left out. */
    async setHandles(count: number) {
      const underWay = wantedHandles !== null;
      wantedHandles = count;
      if (underWay) return;
      await core.guard(async () => {
        const before = isPrecious();
        if (!await mayReplaceRig()) return;
        for (let next = count; ; next = wantedHandles ?? next) {
          core.take(await engine.run({ do: 'set_handles', count: next }));
          askedHandles = next;
          if (wantedHandles === next) break;
        }
        tellReplaced(before);
      });
      wantedHandles = null;
      page.set({});
    },

    /** Whether a count is on its way. */
    settingHandles: () => wantedHandles !== null,

    /** What was asked for: a rig can have a handle more, where two come at once. */
    handleCount() {
      if (wantedHandles !== null) return wantedHandles;
      const joints = page.now.session?.joints.length ?? 0;
      return joints === askedHandles + 1 ? askedHandles : joints;
    },

    /** Behind the first model: what lists show can wait for it. */
    async loadMethods(first: Promise<unknown>) {
      await core.guard(async () => {
        await first;
        page.set({
          methods: await engine.ask({ kind: 'methods' }), sampleMotions: await engine.ask({ kind: 'sample-motions' }),
          samplePoses: await engine.ask({ kind: 'sample-poses' }),
        });
      });
    },

    async chooseDeformer(deformer: string) { await core.run({ do: 'set_deformer', deformer }); },
    async chooseMethods(change: { rigger?: string; skinning?: string }) {
      const { session } = page.now;
      if (!session) return;
      const { rigger, skinning } = { ...session, ...change };
      await core.guard(async () => {
        const before = isPrecious();
        if (!await mayReplaceRig()) return;
        core.take(await engine.run({ do: 'choose_methods', rigger, skinning }));
        tellReplaced(before);
      });
      page.set({}); // lists show again what is chosen
    },

    /** The rig of another model, or of a body in SMPL's layout. */
    async takeRig(file: File) {
      await core.guard(async () => {
        if (!await mayReplaceRig()) return;
        const { rigFile } = await import('../import_rig');
        core.take(await engine.ask({ kind: 'transfer', ...await rigFile(file) }));
        page.set({ display: 'handles' });
      });
    },

    /** Bones, weights and clips that move the model as its file does. */
    async rigFromAnimation() {
      await core.guard(async () => {
        if (!await mayReplaceRig()) return;
        core.take(await engine.run({ do: 'rig_from_animation' }));
        page.set({ display: 'handles' });
      });
    },

    /** How far joints may turn: a file of limits, for this model's joints. */
    async openLimits(file: File) {
      await core.guard(async () => {
        core.take(await engine.run({ do: 'set_limits', limits: await file.text() }));
        page.set({ limits: true, display: 'handles' });
      });
    },

    /** Whether a named skeleton suits the model; null where that cannot be found out now, which is told nowhere else. */
    async checkRig(): Promise<RigCheck | null> {
      return core.counted(() => engine.ask({ kind: 'rig-check' }).catch(() => null));
    },

    /** Joints are corrected on the model as it is bound, so it stands at rest. */
    async correct(on: boolean) {
      if (!on) return page.set({ correcting: false });
      await core.guard(async () => {
        page.set({ playing: false });
        if (page.now.session?.clip != null) core.take(await engine.run({ do: 'choose_clip', clip: '' }));
        if (page.now.session?.posed) core.take(await engine.run({ do: 'reset_pose' }));
        page.set({ correcting: true, mode: 'move', display: 'handles' });
      });
    },

    async pinJoint(joint: number, position: Vector) {
      if (await mayFitAnew()) await core.run({ do: 'pin_joint', joint: core.jointName(joint), position });
    },
    async unpinJoint(joint: string) {
      if (await mayFitAnew()) await core.run({ do: 'unpin_joint', joint });
    },
  };
}
