// Clips of the chosen model and the moment of them that is shown.
import type { Command } from '../../engine/messages';
import { say } from '../../words/say';
import { chosenClip, momentOf } from '../clips';
import type { Core } from './core';

export type ClipCalls = ReturnType<typeof clipCalls>;

export function clipCalls(core: Core) {
  const { page, engine } = core;
  let waiting: Command | null = null, underWay = false;

  /** Behind the end of its clip the chosen member is alone: there is nothing to repeat, there its next key will be. */
  function momentCommand(seconds: number, clock = seconds): Command {
    const { session } = page.now, repeats = momentOf(chosenClip(session), clock) === seconds;
    return (session?.members.length ?? 0) > 1 && repeats ? { do: 'set_clock', seconds: clock } : { do: 'set_time', seconds };
  }

  return {
    async chooseClip(clip: string) {
      waiting = null; // of the clip before
      await core.run({ do: 'choose_clip', clip });
    },
    async renameClip(clip: string, name: string) { await core.run({ do: 'rename_clip', clip, name }); },

    async addClip() {
      const names = new Set(page.now.session?.clips.map((clip) => clip.name));
      let number = 1;
      while (names.has(say('clip {number}', { number }))) ++number;
      await core.run({ do: 'add_clip', clip: say('clip {number}', { number }) });
    },

    /** At most one moment is on its way; the newest waits. In a scene all members show what the clock says, each of its own clip. */
    showMoment(seconds: number, clock = seconds) {
      page.set({ seconds });
      waiting = momentCommand(seconds, clock);
      if (underWay) return;
      underWay = true;
      void core.guard(async () => {
        while (waiting !== null) {
          const next: Command = waiting;
          waiting = null;
          const { stance } = await engine.run(next);
          core.showStance(stance, true);
        }
      }).finally(() => { underWay = false; });
    },
    forgetMoment() { waiting = null; },

    /** Pictures of a clip at even moments, each once the scene stands there and the camera has walked along: to its end, or to
     *  the one before it, where what comes of them repeats. */
    async eachMoment(count: number, draw: (seconds: number) => void | Promise<void>, { repeats = false } = {}) {
      const { session, seconds } = page.now, clip = chosenClip(session);
      if (!clip) return;
      page.set({ playing: false });
      await core.guard(async () => {
        const show = async (moment: number) => {
          const { stance } = await engine.run(momentCommand(moment));
          core.onStance(stance, true);
        };
        for (let i = 0; i < count; ++i) {
          const moment = (clip.duration * i) / Math.max(1, repeats ? count : count - 1);
          await show(moment);
          await draw(moment);
        }
        await show(seconds);
      });
    },
  };
}
