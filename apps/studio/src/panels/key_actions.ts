// Copy, paste, move and delete of the chosen keys; the sheet's keyboard does the same as the buttons.
import { extentOf, frame, keysOf, sameKey } from '../app/keys';
import type { KeyPlace, PageStore } from '../app/state';
import type { Studio } from '../app/studio';

/** Keys that were copied, and the clip that has them. */
interface Copied {
  clip: string;
  keys: readonly KeyPlace[];
}

export class KeyActions {
  private copied: Copied | null = null;

  constructor(private studio: Studio, private page: PageStore) {}

  get canPaste() { return this.pasted().length > 0; }

  copy() {
    const { session, chosenKeys } = this.page.now;
    const clip = session?.clips[session.clip ?? -1]?.name;
    if (clip === undefined || chosenKeys.length === 0) return;
    this.copied = { clip, keys: chosenKeys };
    this.page.set({});
  }

  /** The first of them comes to the moment that is shown. */
  paste() {
    const keys = this.pasted();
    if (keys.length > 0) void this.studio.editKeys(keys, { shift: this.page.now.seconds - extentOf(keys)[0], copy: true });
  }

  remove() {
    const { chosenKeys } = this.page.now;
    if (chosenKeys.length > 0) void this.studio.deleteKeys(chosenKeys);
  }

  move(frames: number) {
    const { chosenKeys } = this.page.now;
    if (chosenKeys.length === 0) return;
    const shift = Math.max(frames * frame, -extentOf(chosenKeys)[0]);
    if (shift !== 0) void this.studio.editKeys(chosenKeys, { shift });
  }

  scale(times: number) {
    const { chosenKeys } = this.page.now;
    if (chosenKeys.length < 2) return;
    const pivot = extentOf(chosenKeys)[0];
    void this.studio.editKeys(chosenKeys, { scale: times, pivot });
  }

  chooseAll() { this.page.set({ chosenKeys: keysOf(this.page.now.session) }); }

  /** Of the clip that is shown, as far as they are still there. */
  private pasted(): KeyPlace[] {
    const { session } = this.page.now;
    if (!session || this.copied?.clip !== session.clips[session.clip ?? -1]?.name) return [];
    return keysOf(session).filter((key) => this.copied?.keys.some((known) => sameKey(key, known)));
  }
}
