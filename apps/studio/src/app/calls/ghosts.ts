// Ghosts: the character some moments before and after the one that is shown, asked of the engine as the moment goes on.
import { chosenClip, type Clip } from '../clips';
import type { Ghost, PageState } from '../state';
import type { Core } from './core';

const each = 3; // ghosts before, and as many after
const apart = 0.1; // seconds between ghosts of recorded motion

export function ghostCalls(core: Core) {
  const { page, engine } = core;
  let underWay = false, drawn: Pick<PageState, 'session' | 'ghosts' | 'seconds'> | null = null;
  const isDrawn = ({ session, ghosts, seconds }: PageState) =>
    drawn?.session === session && drawn.ghosts === ghosts && drawn.seconds === seconds;

  /** One question at a time; the newest moment is the next. */
  async function draw() {
    underWay = true;
    await core.guard(async () => {
      while (!isDrawn(page.now) && page.now.session?.dragged == null) {
        const { session, ghosts, seconds } = page.now, clip = chosenClip(session);
        drawn = { session, ghosts, seconds };
        const wanted = ghosts && clip ? momentsOf(clip, seconds) : [];
        const skins = wanted.length === 0 ? [] : await engine.ask({ kind: 'preview-moments', moments: wanted.map(({ moment }) => moment) });
        page.set({ ghostsShown: wanted.map(({ order }, i): Ghost => ({ order, skin: skins[i]! })) });
      }
    });
    underWay = false;
  }

  page.watch((now) => {
    if ((now.ghosts || now.ghostsShown.length > 0) && !underWay && !isDrawn(now)) void draw();
  });

  return {
    showGhosts(on: boolean) { page.set({ ghosts: on }); },
  };
}

/** Clips made by hand show their keys, recorded motion even steps, as far as the clip has them. */
function momentsOf({ recorded, keys, duration }: Clip, seconds: number): { order: number; moment: number }[] {
  const before = keys.filter((key) => key < seconds - 1e-3).reverse(), after = keys.filter((key) => key > seconds + 1e-3);
  const found = [];
  for (let order = -each; order <= each; ++order) {
    if (order === 0) continue;
    const moment = recorded || keys.length === 0 ? seconds + order * apart : (order < 0 ? before : after)[Math.abs(order) - 1];
    if (moment !== undefined && moment >= 0 && moment <= duration) found.push({ order, moment });
  }
  return found;
}
