// Plays the clips of the scene on one clock: a moment for each frame that the screen shows.
import { chosenClip, momentOf, sceneDuration } from './clips';
import { nextFrame } from './frames';
import type { PageStore } from './state';
import type { Studio } from './studio';

export function bindPlayer(studio: Studio, page: PageStore) {
  let before = 0, clock = 0, running = false;
  const step = (now: number) => {
    const { session, playing, speed, loop } = page.now, duration = sceneDuration(session);
    if (!playing || duration <= 0) {
      running = false;
      if (playing) page.set({ playing: false });
      return;
    }
    // A page that was hidden goes on where it was; the first frame may have begun before it was asked for.
    let next = clockNow() + Math.min(0.25, Math.max(0, now - before) / 1000) * speed;
    before = now;
    // Clips of several lengths go on, each for itself.
    if (next > duration) next = !loop ? duration : session?.members.length === 1 ? next % duration : next;
    clock = next;
    studio.showMoment(momentOf(chosenClip(session), next), next);
    if (next === duration && !loop) page.set({ playing: false });
    nextFrame(step);
  };
  /** Where it was, unless the moment that is shown is another one. */
  const clockNow = () => {
    const { session, seconds } = page.now;
    return Math.abs(momentOf(chosenClip(session), clock) - seconds) < 1e-6 ? clock : seconds;
  };
  page.watch(({ playing }) => {
    if (!playing || running) return;
    running = true;
    before = performance.now();
    nextFrame(step);
  });
}

/** From the end it begins again. */
export function togglePlaying(studio: Studio, page: PageStore) {
  const { session, playing, seconds } = page.now, duration = sceneDuration(session);
  if (duration <= 0) return;
  if (!playing && seconds >= duration) studio.showMoment(0);
  page.set({ playing: !playing });
}
