// Parts of the page whose code it does without until they are first opened.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { partMissing } from '../engine/client';
import type { Flag } from './shown_while';

/** Puts the part into the page once its flag of the store is first set; where its code does not come, that is told, and
 *  the next opening asks again. */
export function loadedWhenOpened(studio: Studio, page: PageStore, flag: Flag, load: () => Promise<() => HTMLElement>, into: HTMLElement) {
  let asked = false;
  page.watch((now) => {
    if (!now[flag] || asked) return;
    asked = true;
    void studio.guard(() => load().catch(() => { throw partMissing(null); })).then((make) => {
      asked = make !== null;
      if (make) into.append(make());
      page.set({ [flag]: make !== null && page.now[flag] }); // a dialog opens once it is in the page
    });
  });
}
