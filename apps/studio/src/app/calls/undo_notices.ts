// What was taken away is told, with a button that brings it back: a finger has no Ctrl+Z at hand, and a look at the top
// of the page is far from where it was lost.
import type { SessionState } from '../../engine/messages';
import { say, type Words } from '../../words/say';
import type { Core } from './core';

/** Commands after which something is gone, and what is said then. */
const losses: Record<string, Words> = {
  remove_member: 'The model was taken out of the scene', delete_joint: 'The joint was deleted', remove_clip: 'The clip was removed',
  delete_keys: 'The keys were taken out',
};

/** It is shown until it is closed, or something else is done. */
export function undoNotices(core: Core, undo: () => Promise<void>) {
  const { page } = core;
  let of: SessionState | null = null;
  const told = (title: string) => {
    of = page.now.session;
    page.set({ notice: { kind: 'note', title, detail: '', undo } });
  };
  core.followCommands(async ({ do: name }) => {
    const title = losses[name];
    if (title) told(say(title));
  });
  page.watch(({ session, notice }) => {
    if (notice?.undo && session !== of) page.set({ notice: null });
  });
  return { told };
}
