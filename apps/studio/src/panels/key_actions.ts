// Copy, paste, move and delete of the chosen keys; the sheet's keyboard does the same as the buttons.
import { extentOf, frame, keysOf, sameKey, type PoseKey } from '../app/keys';
import type { KeyPlace, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { SessionState } from '../engine/messages';

type Joints = SessionState['joints'];

/** Keys that were copied, with the clip that has them; for other clips and characters as poses. */
interface Copied {
  clip: string;
  keys: readonly KeyPlace[];
  joints: Joints;
  moments: number[];
  poses: Promise<string[] | null>;
}

/** Of which member, too: several may have one of that name. */
function clipOf(session: SessionState | null): string | null {
  const clip = session?.clips[session.clip ?? -1];
  return session && clip ? [session.members[session.member]?.name, session.name, clip.name].join('\n') : null;
}

/** The joint of another skeleton that is the same part of the body, of several the one in the same place; without a part, of that name. */
function counterpart(joint: number, from: Joints, to: Joints): number | null {
  const of = from[joint], alike = (joints: Joints) => joints.flatMap(({ part }, i) => (part === of?.part ? [i] : []));
  const found = !of ? -1 : of.part === null ? to.findIndex(({ name }) => name === of.name) : alike(to)[alike(from).indexOf(joint)] ?? -1;
  return found < 0 ? null : found;
}

export class KeyActions {
  private copied: Copied | null = null;

  constructor(private studio: Studio, private page: PageStore) {}

  get canPaste() { return this.pasted().length > 0 || this.counterparts().length > 0; }

  copy() {
    const { session, chosenKeys: keys } = this.page.now, clip = clipOf(session);
    if (!session || clip === null || keys.length === 0) return;
    const moments = [...new Set(keys.map(({ seconds }) => seconds))].sort((a, b) => a - b);
    this.copied = { clip, keys, joints: session.joints, moments, poses: this.studio.posesAt(moments) };
    this.page.set({});
  }

  /** The first of them comes to the moment that is shown. */
  async paste() {
    const keys = this.pasted(), others = this.counterparts(), { seconds } = this.page.now;
    if (keys.length > 0) return this.studio.editKeys(keys, { shift: seconds - extentOf(keys)[0], copy: true });
    const { moments, poses } = this.copied ?? { moments: [], poses: null }, texts = await poses;
    if (!texts) return;
    const first = extentOf(others)[0];
    const pasted = moments.map((moment, i): PoseKey => ({
      pose: texts[i]!, joints: others.filter((key) => key.seconds === moment).map(({ joint }) => joint), seconds: seconds + moment - first,
    }));
    await this.studio.pasteKeys(pasted.filter(({ joints }) => joints.length > 0));
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
    if (!session || this.copied?.clip !== clipOf(session)) return [];
    return keysOf(session).filter((key) => this.copied?.keys.some((known) => sameKey(key, known)));
  }

  /** For another clip that is shown: the copied keys, of its own joints. */
  private counterparts(): KeyPlace[] {
    const { session } = this.page.now, { copied } = this, clip = clipOf(session);
    if (!session || !copied || clip === null || clip === copied.clip) return [];
    return copied.keys.flatMap(({ joint, seconds }) => {
      const own = counterpart(joint, copied.joints, session.joints);
      return own === null ? [] : [{ joint: own, seconds }];
    });
  }
}
