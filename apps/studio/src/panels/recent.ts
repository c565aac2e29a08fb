// What there is to open: models of the engine's own, and what this browser kept.
import { samples } from '../app/samples';
import type { Journal, KeptDocument } from '../app/journal';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';

const when = new Intl.DateTimeFormat(undefined, { dateStyle: 'medium', timeStyle: 'short' });

export function recent(studio: Studio, journal: Journal): { button: HTMLElement; dialog: HTMLDialogElement } {
  const list = element('ul', { class: 'recent-list' });
  const none = element('p', { class: 'detail' }, 'What you open is kept here, in this browser alone.');
  const dialog = element('dialog', { id: 'recent', class: 'recent', 'aria-label': 'Recent' },
    element('h2', {}, 'Samples'),
    element('div', { class: 'row' }, ...samples.map(([name, text]) => button(text, () => {
      dialog.close();
      void studio.openSample(name);
    }))),
    element('h2', {}, 'Recent'), none, list, button('Close', () => dialog.close(), { id: 'close-recent' }));

  const row = (kept: KeptDocument) => {
    const pick = element('button', { type: 'button', class: 'button pick' },
      kept.picture === '' ? null : element('img', { src: kept.picture, alt: '', width: 96, height: 64 }),
      element('span', { class: 'text' }, kept.name), element('span', { class: 'detail' }, when.format(kept.changed)));
    pick.addEventListener('click', () => {
      dialog.close();
      void studio.openKept(kept);
    });
    const away = button('', () => void journal.forget(kept.id).then(show), { icon: 'erase', label: `Forget ${kept.name}` });
    return element('li', {}, pick, away);
  };
  const show = async () => {
    const others = (await journal.list()).filter(({ id }) => id !== journal.current);
    none.hidden = others.length > 0;
    list.replaceChildren(...others.map(row));
  };
  const opener = button('Recent', () => void show().then(() => dialog.showModal()), { icon: 'recent', id: 'open-recent', label: 'What was worked on before' });
  return { button: opener, dialog };
}
