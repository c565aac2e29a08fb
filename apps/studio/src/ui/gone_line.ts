// In a dialog: what was taken out of a list of it, with a button that brings it back. Notices are behind dialogs.
import { say } from '../words/say';
import { button, element } from './dom';

export interface GoneLine {
  root: HTMLElement;
  tell(text: string, undo: () => Promise<void>): void;
  clear(): void;
}

export function goneLine(id: string): GoneLine {
  const text = element('span', { role: 'status' });
  let bringBack: (() => Promise<void>) | null = null;
  const root = element('div', { class: 'row spread gone', hidden: true }, text, button(say('Undo'), () => {
    const undo = bringBack;
    line.clear();
    void undo?.();
  }, { icon: 'undo', id }));
  const line: GoneLine = {
    root,
    tell(what, undo) {
      text.textContent = what;
      bringBack = undo;
      root.hidden = false;
    },
    clear() {
      root.hidden = true;
      bringBack = null;
    },
  };
  return line;
}
