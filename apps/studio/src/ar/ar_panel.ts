// What is on the screen in augmented reality, beside the models: a line that helps, and what fingers need at hand.
import type { DragMode } from '../app/state';
import { addDialog } from '../panels/add_dialog';
import { followSwitch } from '../panels/follow_switch';
import { handleCount } from '../panels/pose_panel';
import { status } from '../panels/status';
import { button, choice, element, offer, setIcon } from '../ui/dom';
import { say } from '../words/say';
import { arActions, dragModes, isPlacing, isPosing, type ArAction } from './actions';
import { plainBackground } from './ar_picture';
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
  const take = async (background: string | null) => {
    const picture = await view?.picture(background);
    if (picture) offer(picture, 'image/png', `${say('AR picture')}.png`);
    return picture != null;
  };
  const backdrop = backgroundDialog((color) => void take(color));
  const picture = button(say('Picture'), () => void take(null).then((taken) => { if (!taken) backdrop.showModal(); }), { icon: 'camera', id: 'ar-picture' });
  const members = element('select', { class: 'select', id: 'ar-members', 'aria-label': say('The model that is posed') });
  members.addEventListener('change', () => void studio.chooseMember(Number(members.value)));
  const mode = choice<DragMode>(say('What dragging a handle does'), dragModes(), (value) => page.set({ mode: value }));
  const follow = followSwitch(studio, 'ar-follow');
  const handles = handleCount(studio, page);
  const adding = addDialog(studio);
  const posing = element('div', { class: 'ar-posing' }, handles, element('div', { class: 'row' }, mode.root, follow.root));
  const tools = element('div', { class: 'row ar-tools' }, members, ...actions.tools.map((action) => make(action)), adding.button, picture);
  const root = element('main', { class: 'ar', id: 'ar' },
    element('div', { class: 'ar-surface', role: 'application', 'aria-label': say('The models in the real place. Buttons do what can be done without pointing.') }),
    element('div', { class: 'ar-top' }, make(actions.leave), line, element('div', { class: 'group' }, ...actions.history.map((action) => make(action)))),
    status(studio, page),
    element('div', { class: 'ar-bottom' }, posing, make(actions.place, 'primary'), tools), adding.dialog, backdrop);

  let listed = '';
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
    follow.show(now.session);
    const names = now.session?.members.map(({ name }) => name) ?? [];
    members.hidden = names.length < 2;
    if (names.join('\n') !== listed) {
      listed = names.join('\n');
      members.replaceChildren(...names.map((name, value) => element('option', { value }, name)));
    }
    members.value = String(now.session?.member ?? 0);
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

/** For a picture without what the camera sees. */
function backgroundDialog(take: (color: string) => void): HTMLDialogElement {
  const color = element('input', { type: 'color', id: 'ar-background', value: plainBackground });
  const dialog: HTMLDialogElement = element('dialog', { class: 'ask', id: 'ar-backdrop', 'aria-label': say('Picture') },
    element('h2', {}, say('Picture')),
    element('p', {}, say('This browser does not give the page what the camera sees. Choose what is behind the models instead.')),
    element('div', { class: 'field' }, element('label', { for: 'ar-background' }, say('Background')), color),
    element('div', { class: 'row' }, button(say('Cancel'), () => dialog.close(), { id: 'ar-no-picture' }), button(say('Take the picture'), () => {
      dialog.close();
      take(color.value);
    }, { kind: 'primary', id: 'ar-take' })));
  return dialog;
}
