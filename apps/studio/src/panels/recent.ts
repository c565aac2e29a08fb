// What there is to open: models of the engine's own, and what this browser kept.
import { samples, scenes } from '../app/samples';
import type { Journal, KeptDocument } from '../app/journal';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { goneLine } from '../ui/gone_line';
import { language, say } from '../words/say';

const when = new Intl.DateTimeFormat(language, { dateStyle: 'medium', timeStyle: 'short' });

export function recent(studio: Studio, journal: Journal): { button: HTMLElement; dialog: HTMLDialogElement } {
  const list = element('ul', { class: 'recent-list' });
  const gone = goneLine('undo-forget');
  const none = element('p', { class: 'detail' }, say('What you open is kept here, in this browser alone.'));
  const offered = (text: string, open: () => void) => button(text, () => {
    dialog.close();
    open();
  });
  const dialog: HTMLDialogElement = element('dialog', { id: 'recent', class: 'recent', 'aria-label': say('Recent') },
    element('h2', {}, say('Samples')),
    element('div', { class: 'row' }, ...samples.map(([name, text]) => offered(say(text), () => void studio.openSample(name)))),
    element('h2', {}, say('Scenes')),
    element('div', { class: 'row' }, ...scenes.map(([name, text]) => offered(say(text), () => void studio.openScene(name, say(text))))),
    element('h2', {}, say('Recent')), none, list, gone.root, button(say('Close'), () => dialog.close(), { id: 'close-recent' }));

  const row = (kept: KeptDocument) => {
    const pick = element('button', { type: 'button', class: 'button pick' },
      kept.picture === '' ? null : element('img', { src: kept.picture, alt: '', width: 96, height: 64 }),
      element('span', { class: 'text' }, kept.name), element('span', { class: 'detail' }, when.format(kept.changed)));
    pick.addEventListener('click', () => {
      dialog.close();
      void studio.openKept(kept);
    });
    const away = button('', () => void journal.forget(kept).then((bringBack) => {
      gone.tell(say('{name} is forgotten', { name: kept.name }), () => bringBack().then(show));
      return show();
    }), { icon: 'erase', label: say('Forget {name}', { name: kept.name }) });
    return element('li', {}, pick, away);
  };
  const show = async () => {
    const others = (await journal.list()).filter(({ id }) => id !== journal.current);
    none.hidden = others.length > 0;
    list.replaceChildren(...others.map(row));
  };
  const opener = button(say('Recent'), () => {
    gone.clear();
    void show().then(() => dialog.showModal());
  }, { icon: 'recent', id: 'open-recent', label: say('What was worked on before') });
  return { button: opener, dialog };
}
