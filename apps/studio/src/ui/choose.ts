// A question that is answered by one of a list.
import { button, element } from './dom';
import { say } from '../words/say';

/** What was chosen; null where the user thought better of it. */
export function choose(title: string, label: string, options: string[], yes: string): Promise<string | null> {
  return new Promise((resolve) => {
    const select = element('select', { class: 'select', id: 'choose-from' }, ...options.map((name) => element('option', { value: name }, name)));
    const dialog = element('dialog', { class: 'ask', id: 'choose', 'aria-label': title }, element('h2', {}, title));
    const close = (chosen: string | null) => {
      dialog.remove();
      resolve(chosen);
    };
    dialog.append(
      element('div', { class: 'field' }, element('label', { for: 'choose-from' }, label), select),
      element('div', { class: 'row' }, button(say('Cancel'), () => close(null), { id: 'choose-no' }),
        button(yes, () => close(select.value), { id: 'choose-yes', kind: 'primary' })));
    dialog.addEventListener('cancel', () => close(null));
    document.body.append(dialog);
    dialog.showModal();
  });
}
