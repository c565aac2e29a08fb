// A question that has to be answered before something is replaced.
import { say } from '../words/say';
import { button, element } from './dom';

/** Whether the user agrees. Escape is a no. `within`: what is seen where not all of the page is. */
export function ask(title: string, detail: string, yes: string, within: HTMLElement = document.body): Promise<boolean> {
  return new Promise((resolve) => {
    const dialog = element('dialog', { class: 'ask', id: 'ask', 'aria-label': title }, element('h2', {}, title), element('p', {}, detail));
    const close = (agreed: boolean) => {
      dialog.remove();
      resolve(agreed);
    };
    dialog.append(element('div', { class: 'row' },
      button(say('Leave it as it is'), () => close(false), { id: 'ask-no' }), button(yes, () => close(true), { id: 'ask-yes', kind: 'primary' })));
    dialog.addEventListener('cancel', () => close(false));
    within.append(dialog);
    dialog.showModal();
  });
}
