// The button that opens the keys below the timeline, as they were left; what it opens is loaded then (key_editor.ts).
import { remember, remembered } from '../app/remembered';
import type { KeyEditor, PageStore } from '../app/state';
import { button } from '../ui/dom';
import { say } from '../words/say';
import { chosenClip } from './moments';

const narrow = '(width <= 760px)';
const kept = ['sheet', 'curves', 'closed'] as const;

/** null: none. */
export function showKeys(page: PageStore, editor: KeyEditor | null) {
  remember('keys', editor ?? 'closed');
  page.set({ keyEditor: editor, chosenKeys: editor === null ? [] : page.now.chosenKeys });
}

export function keyToggle(page: PageStore): HTMLButtonElement {
  const stored = matchMedia(narrow).matches ? 'closed' : remembered('keys', kept, 'closed');
  if (stored !== 'closed') page.set({ keyEditor: stored });
  let last: KeyEditor = stored === 'curves' ? 'curves' : 'sheet';
  const toggle = button(say('Keys'), () => showKeys(page, page.now.keyEditor === null ? last : null), { icon: 'rows', label: say('Keys of each joint, and their curves'), id: 'open-keys' });
  toggle.setAttribute('aria-controls', 'key-editor');
  page.watch(({ session, keyEditor }) => {
    const clip = chosenClip(session);
    last = keyEditor ?? last;
    toggle.disabled = !clip;
    toggle.setAttribute('aria-expanded', String(keyEditor !== null && clip !== null));
  });
  return toggle;
}
