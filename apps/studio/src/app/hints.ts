// Hints: each is shown in place until it was followed, and never again in this browser.
import type { Words } from '../words/say';
import { remember, rememberedText } from './remembered';
import { hasHandles, type PageState } from './state';

interface Hint {
  id: string;
  text: Words;
  /** It would help now. */
  helps(now: PageState): boolean;
  /** It was followed, or is known anyway. */
  known(now: PageState, before: PageState): boolean;
}

const posing = ({ session, display }: PageState) => session !== null && session.clip === null && session.dragged === null && hasHandles(display);

const hints: Hint[] = [
  {
    id: 'drag', text: 'Drag a red ball',
    helps: (now) => posing(now) && now.session!.undo === null && now.session!.clips.length === 0 && now.selected === null,
    known: ({ session }, { session: before }) => before?.dragged != null && session?.dragged === null && session.undo !== null,
  },
  {
    id: 'look', text: 'Drag beside the model to look from elsewhere',
    helps: (now) => posing(now) && now.session!.undo !== null && now.session!.members.length === 1,
    known: (now) => now.looked,
  },
  {
    id: 'choose', text: 'Click or tap a model to choose it',
    helps: ({ session }) => session !== null && session.members.length > 1 && session.dragged === null,
    known: ({ session }, { session: before }) => before !== null && session?.members.length === before.members.length && session.member !== before.member,
  },
  {
    id: 'key', text: 'Drag a joint: it becomes a key of the clip',
    helps: ({ session, playing, autoKey, display }) => session?.clip != null && !playing && autoKey && hasHandles(display) && session.dragged === null,
    known: ({ session }) => session?.undo === 'set_key',
  },
];

const store = 'hints';
const known = new Set(rememberedText(store).split(' '));

/** The hint that helps now; null where there is none, or none is needed any more. */
export function hintFor(now: PageState, before: PageState): Words | null {
  for (const hint of hints) {
    if (known.has(hint.id) || !hint.known(now, before)) continue;
    known.add(hint.id);
    remember(store, [...known].join(' ').trim());
  }
  return hints.find((hint) => !known.has(hint.id) && hint.helps(now))?.text ?? null;
}
