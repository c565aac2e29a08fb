// From where the model is seen, and what to do first.
import type { PageStore } from '../app/state';
import type { Viewport, ViewName } from '../scene/viewport';
import { button, element } from '../ui/dom';

const sides: [ViewName, string, string][] = [['front', 'Front', '1'], ['right', 'Side', '3'], ['top', 'Top', '7']];

export function views(viewport: Viewport): HTMLElement {
  return element('div', { class: 'views', role: 'group', 'aria-label': 'Views' },
    button('', () => viewport.look('start'), { icon: 'frame', label: 'Whole model', keys: 'Home', id: 'whole-model' }),
    ...sides.map(([name, text, keys]) => button(text, () => viewport.look(name), { keys, id: `view-${name}` })));
}

/** Until something has been done. */
export function hint(page: PageStore): HTMLElement {
  const line = element('p', { class: 'hint', id: 'hint' }, 'Drag a red ball');
  page.watch(({ session, display, selected }) => {
    line.hidden = !session || session.undo !== null || session.clips.length > 0 || display !== 'handles' || selected !== null;
  });
  return line;
}
