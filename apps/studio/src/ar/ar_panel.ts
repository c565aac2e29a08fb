// What is on the screen in augmented reality, beside the models: a line that helps, and what fingers need at hand.
import type { DragMode } from '../app/state';
import { addDialog } from '../panels/add_dialog';
import { handleCount } from '../panels/pose_panel';
import { status } from '../panels/status';
import { button, choice, element, setIcon } from '../ui/dom';
import { say } from '../words/say';
import { arActions, dragModes, isPlacing, isPosing, type ArAction } from './actions';
import type { ArView } from './ar_view';
import type { Desk } from './desk';
import { helpLine } from './help_line';

export interface ArPanel {
  root: HTMLElement;
  show(view: ArView): void;
  close(): void;
}

export function arPanel(desk: Desk): ArPanel {
  const { studio, page } = desk;
  let view: ArView | null = null;
  const actions = arActions(desk, () => view), buttons: { action: ArAction; made: HTMLButtonElement }[] = [];
  const make = (action: ArAction, kind: 'plain' | 'primary' = 'plain') => {
    const { text, act, icon, label, id } = action, made = button(text, act, { label, id, kind, ...(icon ? { icon: icon(page.now) } : {}) });
    buttons.push({ action, made });
    return made;
  };
  const line = element('p', { class: 'ar-line', id: 'ar-line', role: 'status' });
  const mode = choice<DragMode>(say('What dragging a handle does'), dragModes(), (value) => page.set({ mode: value }));
  const handles = handleCount(studio, page);
  const adding = addDialog(studio);
  const posing = element('div', { class: 'ar-posing' }, handles, mode.root);
  const tools = element('div', { class: 'row ar-tools' }, ...actions.tools.map((action) => make(action)), adding.button);
  const root = element('main', { class: 'ar', id: 'ar' },
    element('div', { class: 'ar-surface', role: 'application', 'aria-label': say('The models in the real place. Buttons do what can be done without pointing.') }),
    element('div', { class: 'ar-top' }, make(actions.leave), line, element('div', { class: 'group' }, ...actions.history.map((action) => make(action)))),
    status(studio, page),
    element('div', { class: 'ar-bottom' }, posing, make(actions.place, 'primary'), tools), adding.dialog);

  const stop = page.watch((now) => {
    line.textContent = helpLine(now, false);
    for (const { action, made } of buttons) {
      made.hidden = !action.shown(now);
      made.disabled = !(action.enabled?.(now) ?? true);
      if (action.pressed) made.setAttribute('aria-pressed', String(action.pressed(now)));
      if (action.icon) setIcon(made, action.icon(now));
    }
    tools.hidden = isPlacing(now);
    posing.hidden = !isPosing(now);
    mode.show(now.mode);
  });
  return {
    root,
    show(of) { view = of; },
    close() {
      stop();
      root.remove();
    },
  };
}
