// From where the model is seen, and what to do first.
import { hintFor } from '../app/hints';
import type { PageStore } from '../app/state';
import type { Viewport, ViewName } from '../scene/viewport';
import { button, element } from '../ui/dom';
import { say, type Words } from '../words/say';

const sides: [ViewName, Words, string][] = [['front', 'Front', '1'], ['right', 'Side', '3'], ['top', 'Top', '7']];

export function views(viewport: Viewport): HTMLElement {
  const root = element('div', { class: 'views', role: 'group', 'aria-label': say('Views') },
    button('', () => viewport.look('start'), { icon: 'frame', label: say('Whole model'), keys: 'Home', id: 'whole-model' }),
    ...sides.map(([name, text, keys]) => button(say(text), () => viewport.look(name), { keys, id: `view-${name}` })),
    button(say('Flat'), () => viewport.toggleOrthographic(), { keys: '5', label: say('Without or with perspective'), id: 'view-flat' }));
  viewport.coveredAbove = () => (root.checkVisibility() ? root.getBoundingClientRect().bottom - viewport.canvas.getBoundingClientRect().top : 0);
  return root;
}

/** What to do next, for whoever has not done it yet. */
export function hint(page: PageStore, viewport: Viewport): HTMLElement {
  const line = element('p', { class: 'hint', id: 'hint', role: 'status' });
  viewport.controls.addEventListener('start', () => { if (!page.now.looked) page.set({ looked: true }); });
  page.watch((now, before) => {
    const text = hintFor(now, before);
    line.hidden = text === null;
    if (text !== null) line.textContent = say(text);
  });
  return line;
}
