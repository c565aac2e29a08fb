// Motion that other programs send through `limber studio --live`, on the model as it comes.
import { EngineError } from '../../engine/client';
import { noticeOf } from '../state';
import type { Core } from './core';
import type { MotionCalls } from './motions';

export type LiveState = 'waiting' | 'following' | 'paused';

/** Until a drag is over or a model is there, frames pass by. */
const passing = new Set(['joint-dragged', 'no-model']);

interface Frame { pose: Float32Array; seconds: number }

function frameOf(text: string): Frame | null {
  const [seconds, ...pose] = JSON.parse(text) as number[];
  return seconds === undefined ? null : { pose: new Float32Array(pose), seconds };
}

export function liveCalls(core: Core, { openMotions }: MotionCalls) {
  const { engine } = core;
  let state: LiveState = 'waiting', tell: (state: LiveState) => void = () => {};
  let skeleton = '', begun = '', latest: Frame | null = null, busy = false;

  const become = (next: LiveState) => {
    if (next === state) return;
    state = next;
    tell(state);
  };

  const isPaused = () => state === 'paused';

  async function show({ pose, seconds }: Frame) {
    try {
      if (begun !== skeleton) {
        core.page.set({ playing: false }); // the clock of a clip would end it with every frame
        await engine.ask({ kind: 'live-begin', skeleton });
      }
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      if (passing.has(error.error.kind ?? '')) return;
      become('paused');
      core.page.set({ notice: noticeOf(error.error) });
      return;
    }
    begun = skeleton;
    if (isPaused()) return pauseLive(); // meanwhile
    try {
      const stance = await engine.ask({ kind: 'live-frame', pose, seconds });
      if (isPaused()) return; // meanwhile
      core.showStance(stance, true);
      core.isCarried = true;
      become('following');
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      begun = ''; // something else was done, which ended it: the next frame begins anew
    }
  }

  /** One at a time, always the latest; what the user does goes before. */
  async function showLatest() {
    if (busy) return;
    busy = true;
    try {
      while (latest && state !== 'paused' && skeleton !== '' && !engine.changing) {
        const frame = latest;
        latest = null;
        await show(frame);
      }
    } finally {
      busy = false;
    }
  }

  /** The model stands as it did before. */
  async function pauseLive() {
    become('paused');
    if (begun === '') return;
    begun = '';
    await core.guard(async () => core.showStance(await engine.ask({ kind: 'live-end' }), core.isCarried));
    core.isCarried = false;
  }

  // Whatever is done ends it in the engine; the next frame begins anew.
  core.followSteps(() => {
    begun = '';
    if (state === 'following') become('waiting');
  });

  return {
    pauseLive,

    listenLive(told: (state: LiveState) => void) {
      tell = told;
      tell(state);
      const events = new EventSource('/live');
      events.addEventListener('skeleton', ({ data }: MessageEvent<string>) => { skeleton = data; });
      events.addEventListener('frame', ({ data }: MessageEvent<string>) => {
        latest = frameOf(data);
        void showLatest();
      });
    },

    followLive() { become('waiting'); },

    /** What has come since it began, as a clip of the model. */
    async keepLive() {
      if (begun === '') return;
      const bytes = await core.guard(() => engine.ask({ kind: 'live-recorded' }));
      await pauseLive();
      if (bytes) await openMotions([new File([bytes as BlobPart], 'live.bvh')]);
    },
  };
}
