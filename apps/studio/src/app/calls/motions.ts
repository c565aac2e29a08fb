// Motions of others put on the model: tried, shown on the shelf, retargeted.
import { EngineError, refusal } from '../../engine/client';
import type { MotionPreview, MotionRequest, PreviewRig } from '../../engine/messages';
import { say } from '../../words/say';
import { chosenClip } from '../clips';
import type { Motion } from '../trials';
import type { Core } from './core';
import { withSkeleton } from './skeleton_first';

const previewRate = 12; // frames a second of a motion on the shelf; between them it is blended
const previewSeconds = 5; // of a user's motion

const sampleMotion = (name: string, retarget = false): MotionRequest => ({ kind: 'run', command: { do: 'add_sample_motion', name, retarget } });
const motionOf = async (file: File, retarget = false): Promise<MotionRequest> =>
  ({ kind: 'motion', bytes: new Uint8Array(await file.arrayBuffer()), name: file.name, retarget });

export type MotionCalls = ReturnType<typeof motionCalls>;

export function motionCalls(core: Core) {
  const { page, engine } = core;
  let shownSource = '';
  core.followSteps(() => void core.guard(showSource));

  /** The model that the chosen clip's motion came with. */
  async function showSource() {
    const motion = chosenClip(page.now.session)?.source?.motion ?? '';
    if (motion === shownSource) return;
    shownSource = motion;
    const sourceModel = motion === '' ? null : await engine.ask({ kind: 'source-model' });
    if (shownSource !== motion) return;
    page.set({ sourceModel });
    if (core.stance) core.onStance(core.stance, false);
  }

  async function play(motion: MotionRequest) {
    if (!page.now.session) return;
    const before = page.now.session.clips.length;
    await withSkeleton(core, say('The model needs a skeleton for this motion'),
      async () => core.take(await engine.ask(motion)), () => engine.ask({ kind: 'try-motion', motion }));
    if ((page.now.session?.clips.length ?? 0) > before) page.set({ playing: true, display: 'surface', correcting: false });
  }

  /** Plays what moves in the file on the model. */
  async function openMotion(file: File) { await core.guard(async () => play(await motionOf(file, true))); }

  return {
    openMotion,

    /** One is put on the model at once; of several the user chooses on the shelf, where they stay while the page lives. */
    async openMotions(files: File[]) {
      if (files.length === 0) return;
      if (files.length === 1) {
        page.set({ shelf: false });
        return openMotion(files[0]!);
      }
      const before = page.now.ownMotions.filter(({ name }) => !files.some((file) => file.name === name));
      page.set({ ownMotions: [...before, ...files], shelf: true });
    },

    /** One that the engine makes itself. */
    async openSampleMotion(name: string) { await core.guard(() => play(sampleMotion(name, true))); },

    /** How a motion would look on the model as it is; null where the page is told to stop. */
    async previewMotion(of: Motion): Promise<MotionPreview | null> {
      try {
        const motion = of instanceof File ? await motionOf(of) : sampleMotion(of.name);
        return await engine.ask({ kind: 'preview-motion', motion, most: of instanceof File ? previewSeconds : of.seconds, rate: previewRate });
      } catch (error) {
        const known = error instanceof EngineError ? error : refusal(say('The file cannot be read'));
        return known.cancelled ? null : { error: known.error, named: false, seconds: 0, frames: [] };
      }
    },

    /** What previews with a named skeleton move. */
    previewRig: (): Promise<PreviewRig | null> => engine.ask({ kind: 'preview-rig' }).catch(() => null),

    /** With another method, map, or how far hands reach; the clip stays in its place. */
    async retarget(change: { method?: string; reach?: number; contacts?: boolean; map?: string }) {
      const { session } = page.now, source = chosenClip(session)?.source;
      if (!session || !source) return;
      const map = change.map ?? JSON.stringify({ matches: session.match });
      await core.run({ do: 'retarget', ...source, ...change, map });
      page.set({}); // what was refused is not shown any more
    },
  };
}
