// Parts of the page whose code it does without until they are first opened.
import type { PageState, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { partMissing } from '../engine/client';

/** What of the store shows such a part; where it is set to null or false it does not. */
type Opener = { [K in keyof PageState]: false extends PageState[K] ? K : null extends PageState[K] ? K : never }[keyof PageState];

/** The code of a part; where it does not come, that is told. */
export const arriving = <T>(code: Promise<T>): Promise<T> => code.catch(() => { throw partMissing(null); });

/** Puts the part into the page once its flag of the store is first set; where its code does not come, that is told, and
 *  the next opening asks again. */
export function loadedWhenOpened(studio: Studio, page: PageStore, opener: Opener, load: () => Promise<() => HTMLElement>, into: HTMLElement) {
  let asked = false;
  page.watch((now) => {
    if (!now[opener] || asked) return;
    asked = true;
    void studio.guard(() => arriving(load())).then((make) => {
      asked = make !== null;
      if (!make) return page.set({ [opener]: typeof page.now[opener] === 'boolean' ? false : null });
      into.append(make());
      page.set({}); // a dialog opens once it is in the page
    });
  });
}
