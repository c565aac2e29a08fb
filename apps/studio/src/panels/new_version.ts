// Says that another version of the studio waits. It is taken when the user says so, never by itself.
import type { TakeVersion } from '../app/installed';
import { button, element } from '../ui/dom';
import { say } from '../words/say';

export function newVersion(take: TakeVersion): HTMLElement {
  const detail = element('span', { class: 'detail' }, say('Reload to use it. What you have done is kept.'));
  const reload = button(say('Reload'), () => {
    void take().then((taken) => {
      if (!taken) detail.textContent = say('The studio is open in another tab, too: close that one first.');
    });
  }, { id: 'take-version', kind: 'primary' });
  const told: HTMLElement = element('div', { class: 'toast notice', role: 'status', id: 'new-version' },
    element('div', { class: 'text' }, element('strong', {}, say('There is a new version of the studio')), detail),
    reload, button(say('Later'), () => told.remove(), { id: 'later-version' }));
  return told;
}
