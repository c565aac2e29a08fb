// What opens below the timeline: keys as a sheet or as curves, with the buttons that both share.
import { extentOf, frame, keysOf } from '../app/keys';
import type { KeyEditor, KeyPlace, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { SessionState } from '../engine/messages';
import { counted } from '../ui/counted';
import { button, choice, element } from '../ui/dom';
import { say } from '../words/say';
import { curveEditor } from './curve_editor';
import { dopeSheet } from './dope_sheet';
import { KeyActions } from './key_actions';
import { showKeys } from './key_toggle';

export function keyEditor(studio: Studio, page: PageStore): HTMLElement {
  const actions = new KeyActions(studio, page);
  const shown = choice<KeyEditor>(say('Show keys as'), [{ value: 'sheet', text: say('Sheet') }, { value: 'curves', text: say('Curves') }], (editor) => showKeys(page, editor));
  const told = element('output', { class: 'told', id: 'keys-told' });
  const copy = button(say('Copy'), () => actions.copy(), { icon: 'copy', keys: 'Ctrl+C', id: 'copy-keys' });
  const paste = button(say('Paste'), () => void actions.paste(), { icon: 'paste', label: say('Paste at this moment'), keys: 'Ctrl+V', id: 'paste-keys' });
  const remove = button(say('Delete'), () => actions.remove(), { icon: 'erase', keys: 'Del', id: 'delete-keys' });
  const slower = button('2\u00d7', () => actions.scale(2), { label: say('Twice as slow: the chosen keys move apart'), id: 'scale-up' });
  const faster = button('\u00bd\u00d7', () => actions.scale(0.5), { label: say('Twice as fast: the chosen keys move together'), id: 'scale-down' });
  const all = button(say('All'), () => actions.chooseAll(), { label: say('Choose all keys'), keys: 'Ctrl+A', id: 'choose-keys' });
  const tangents = (kind: 'auto' | 'flat') => void studio.setTangents(page.now.chosenKeys, kind);
  const smooth = button(say('Auto'), () => tangents('auto'), { label: say('Curves run smoothly through the chosen keys'), id: 'tangents-auto' });
  const level = button(say('Level'), () => tangents('flat'), { label: say('Curves run level through the chosen keys'), id: 'tangents-flat' });
  const sheet = dopeSheet(studio, page, actions), curves = curveEditor(studio, page);
  const nearer = button('+', () => sheet.zoom(1), { label: say('Zoom in: keys farther apart'), keys: '+', id: 'zoom-in' });
  const farther = button('\u2212', () => sheet.zoom(-1), { label: say('Zoom out'), keys: '-', id: 'zoom-out' });
  const root = element('div', { class: 'key-editor', id: 'key-editor', hidden: true },
    element('div', { class: 'row tools' }, shown.root, all, copy, paste, remove, slower, faster, nearer, farther, smooth, level, told), sheet.root, curves);
  page.watch(({ session, keyEditor: editor, chosenKeys, curve }) => {
    const clip = session?.clips[session.clip ?? -1] ?? null;
    root.hidden = editor === null || !clip;
    if (root.hidden) return;
    shown.show(editor ?? 'sheet');
    sheet.root.hidden = nearer.hidden = farther.hidden = editor !== 'sheet';
    nearer.disabled = !sheet.canZoom(1);
    farther.disabled = !sheet.canZoom(-1);
    curves.hidden = smooth.hidden = level.hidden = editor !== 'curves';
    smooth.disabled = level.disabled = chosenKeys.length === 0 || !curve || curve.tangents.length === 0;
    copy.disabled = remove.disabled = chosenKeys.length === 0;
    slower.disabled = faster.disabled = chosenKeys.length < 2 || extentOf(chosenKeys)[1] - extentOf(chosenKeys)[0] < frame / 2;
    paste.disabled = !actions.canPaste;
    all.disabled = keysOf(session).length === 0;
    told.textContent = tell(session, chosenKeys);
  });
  return root;
}

function tell(session: SessionState | null, chosen: readonly KeyPlace[]): string {
  if (chosen.length > 0) return say('{count} keys chosen', { count: chosen.length });
  return counted(keysOf(session).length, 'key');
}
