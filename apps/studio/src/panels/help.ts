// Every key, under ?.
import type { PageStore } from '../app/state';
import { button, element } from '../ui/dom';
import { say } from '../words/say';

const keys: [string, string][] = [
  ['Drag a handle', 'move or turn it'], ['Drag beside', 'turn the view'], ['Wheel, pinch', 'zoom'],
  ['Right button, two fingers', 'shift the view'], ['Click the surface', 'select its joint'], ['G / R', 'move / turn'],
  ['I', 'limbs follow'], ['S', 'both sides at once'], ['Shift+click', 'select another joint besides'], [say('Shift+drag beside'), say('draw a box round joints to select')], ['V', say('select several: taps add a joint, drags draw a box')], ['N', say('magnet: round steps')], [say('Ctrl while dragging'), say('the magnet the other way round')], ['P', 'pin the joint'], ['M', 'mirror the pose'], ['Arrows', 'move or turn the selected joints; with Shift, finely'],
  ['Delete', 'put the selected joint back'], ['Alt+R', 'put all joints back'], ['Ctrl+Z', 'undo'], ['Ctrl+Shift+Z, Ctrl+Y', 'redo'],
  ['Escape', 'let go without a change'], ['1, 3, 7', 'from the front, the right, above'], ['5', 'perspective on or off'], ['Arrows, + and -', 'the view, while no joint is selected'],
  ['Space', 'play or pause'], ['K', 'the pose becomes a key'], ['Keys: drag, Shift, Alt', 'choose and move, add, scale in time'], ['Keys: Ctrl+C, Ctrl+V, Delete', 'copy, paste at this moment, take out'], ['B', 'paint weights'], ['[ and ]', 'a smaller or larger brush'], ['L', 'lock the weights of the selected joint'], ['X', 'arrows and rings on the selected joint'], ['F2', 'rename the selected joint'], ['F, Home', 'the whole model'], ['H', 'handles or surface'], ['Ctrl+O', 'open a file'], ['?', 'this list'],
];

export function help(page: PageStore): HTMLElement {
  const dialog = element('dialog', { 'aria-labelledby': 'help-title', id: 'help' },
    element('h2', { id: 'help-title' }, 'Keyboard and mouse'),
    element('dl', {}, ...keys.flatMap(([key, does]) => [element('dt', {}, key), element('dd', {}, does)])),
    button('Close', () => dialog.close(), { kind: 'primary' }));
  dialog.addEventListener('close', () => page.set({ help: false }));
  page.watch(({ help: open }) => {
    if (!open || dialog.open) return;
    dialog.showModal();
    dialog.scrollTop = 0; // the button at its end has the focus
  });
  return dialog;
}
