// A clip at a glance: its moments as small pictures on one sheet.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Viewport } from '../scene/viewport';
import { button, element, offer } from '../ui/dom';
import { inSeconds, say } from '../words/say';
import { chosenClip } from './moments';

const across = 4, down = 3;
const width = 320, height = 240, margin = 8; // pixels

export interface ContactSheet {
  dialog: HTMLDialogElement;
  open(): Promise<void>;
}

export function contactSheet(studio: Studio, page: PageStore, viewport: Viewport): ContactSheet {
  const sheet = element('canvas', {
    width: across * (width + margin) + margin, height: down * (height + margin) + margin, id: 'sheet', role: 'img',
  });
  const title = element('h2', {}, '');
  const save = async () => {
    const picture = await new Promise<Blob | null>((resolve) => sheet.toBlob(resolve, 'image/png'));
    if (picture) offer(picture, 'image/png', `${chosenClip(page.now.session)?.name ?? 'clip'}_sheet.png`);
  };
  const dialog = element('dialog', { class: 'sheet', 'aria-label': say('Contact sheet'), id: 'contact-sheet' }, title, sheet,
    element('div', { class: 'row' }, button(say('Save picture'), () => void save(), { icon: 'save', id: 'save-sheet' }),
      button(say('Close'), () => dialog.close(), { kind: 'primary' })));
  return {
    dialog,
    async open() {
      const clip = chosenClip(page.now.session), context = sheet.getContext('2d');
      if (!clip || !context) return;
      title.textContent = clip.name;
      sheet.setAttribute('aria-label', say('{count} moments of {clip}', { count: across * down, clip: clip.name }));
      context.fillStyle = '#fff';
      context.fillRect(0, 0, sheet.width, sheet.height);
      let next = 0;
      await studio.eachMoment(across * down, (seconds) => {
        const x = margin + (next % across) * (width + margin), y = margin + Math.floor(next / across) * (height + margin);
        ++next;
        context.fillStyle = '#eef0f3';
        context.fillRect(x, y, width, height);
        viewport.drawInto(context, x, y, width, height);
        context.fillStyle = '#1f2733';
        context.font = '13px system-ui, sans-serif';
        context.fillText(inSeconds(seconds, 2), x + 8, y + height - 9);
      });
      dialog.showModal();
    },
  };
}
