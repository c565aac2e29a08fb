// Plays the chosen clip: a moment for each frame that the screen shows.
import type { PageStore } from './state';
import type { Studio } from './studio';

export function bindPlayer(studio: Studio, page: PageStore) {
  let before = 0, running = false;
  const step = (now: number) => {
    const { session, playing, speed, loop, seconds } = page.now;
    const clip = session?.clips[session.clip ?? -1];
    if (!playing || !clip || clip.duration <= 0) {
      running = false;
      if (playing) page.set({ playing: false });
      return;
    }
    // A page that was hidden goes on where it was; the first frame may have begun before it was asked for.
    let next = seconds + Math.min(0.25, Math.max(0, now - before) / 1000) * speed;
    before = now;
    if (next > clip.duration) next = loop ? next % clip.duration : clip.duration;
    studio.showMoment(next);
    if (next === clip.duration && !loop) page.set({ playing: false });
    requestAnimationFrame(step);
  };
  page.watch(({ playing }) => {
    if (!playing || running) return;
    running = true;
    before = performance.now();
    requestAnimationFrame(step);
  });
}

/** From the end it begins again. */
export function togglePlaying(studio: Studio, page: PageStore) {
  const { session, playing, seconds } = page.now;
  const clip = session?.clips[session.clip ?? -1];
  if (!clip || clip.duration <= 0) return;
  if (!playing && seconds >= clip.duration) studio.showMoment(0);
  page.set({ playing: !playing });
}
