// From where the model is seen, and what to do first.
import type { PageStore } from '../app/state';
import type { Viewport, ViewName } from '../scene/viewport';
import { button, element } from '../ui/dom';
import { say, type Words } from '../words/say';

const sides: [ViewName, Words, string][] = [['front', 'Front', '1'], ['right', 'Side', '3'], ['top', 'Top', '7']];

export function views(viewport: Viewport): HTMLElement {
  return element('div', { class: 'views', role: 'group', 'aria-label': say('Views') },
    button('', () => viewport.look('start'), { icon: 'frame', label: say('Whole model'), keys: 'Home', id: 'whole-model' }),
    ...sides.map(([name, text, keys]) => button(say(text), () => viewport.look(name), { keys, id: `view-${name}` })),
    button(say('Flat'), () => viewport.toggleOrthographic(), { keys: '5', label: say('Without or with perspective'), id: 'view-flat' }));
}

/** Until something has been done. */
export function hint(page: PageStore): HTMLElement {
  const line = element('p', { class: 'hint', id: 'hint' }, say('Drag a red ball'));
  page.watch(({ session, display, selected }) => {
    line.hidden = !session || session.undo !== null || session.clips.length > 0 || display !== 'handles' || selected !== null;
  });
  return line;
}
