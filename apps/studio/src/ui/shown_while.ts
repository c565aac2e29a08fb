// Dialogs that are open while a flag of the store is set.
import type { PageState, PageStore } from '../app/state';

export type Flag = 'help' | 'poseLibrary' | 'shelf';

interface Shown {
  opens(): void;
  closes?(): void;
  /** Whether what it shows is there; until then it waits. */
  ready?(now: Readonly<PageState>): boolean;
}

/** It is closed by the store alone. A dialog is closed at once, but its close event comes in a later task: a flag that waits
 *  for the event is wrong meanwhile, so that any change opened the dialog again, or the event closed one opened anew. */
export function shownWhile(dialog: HTMLDialogElement, page: PageStore, flag: Flag, { opens, closes, ready = () => true }: Shown) {
  let shown = false;
  const hide = () => { if (page.now[flag]) page.set({ [flag]: false }); };
  dialog.addEventListener('cancel', ({ target }) => { if (target === dialog) hide(); }); // a field of files in it has such an event, too
  dialog.addEventListener('close', () => { if (!dialog.open) hide(); }); // by the browser itself
  page.watch((now) => {
    if (now[flag] === shown || (now[flag] && !(dialog.isConnected && ready(now)))) return;
    shown = now[flag];
    if (shown) return opens();
    dialog.close();
    closes?.();
  });
}
