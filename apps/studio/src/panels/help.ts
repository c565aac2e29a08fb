// What every key does, under ?; on a device that is touched, what fingers do.
import type { PageStore } from '../app/state';
import { button, element } from '../ui/dom';
import { shownWhile } from '../ui/shown_while';
import { keyNames } from '../words/key_names';
import { say, type Words } from '../words/say';

interface Line {
  does: Words;
  /** With mouse and keyboard: keys as they are written on them, or a gesture. */
  keys?: string;
  mouse?: Words;
  /** With fingers; a button by its text. */
  touch?: Words;
}

const lines: Line[] = [
  { does: 'move, turn or scale it', mouse: 'Drag a red ball', touch: 'Drag a red ball' },
  { does: 'turn the view', mouse: 'Drag beside', touch: 'Drag beside' },
  { does: 'zoom', mouse: 'Wheel', touch: 'Pinch' },
  { does: 'shift the view', mouse: 'Right button', touch: 'Drag with two fingers' },
  { does: 'select its joint', mouse: 'Click the surface', touch: 'Touch the surface' },
  { does: 'choose it', mouse: 'Click another model', touch: 'Touch another model' },
  { does: 'add it to the scene', mouse: 'Drop a file with Shift' },
  { does: 'let go without a change', keys: 'Escape', touch: 'Undo, afterwards' },
  { does: 'move / turn / scale', keys: 'G / R / Shift+S', touch: 'Move, Turn, Scale' },
  { does: 'limbs follow, or the surface stretches', keys: 'I', touch: 'Follow, Stretch' },
  { does: 'both sides at once', keys: 'S', touch: 'Both sides' },
  { does: 'select another joint besides', mouse: 'Shift and click' },
  { does: 'draw a box round joints to select', mouse: 'Shift and drag beside' },
  { does: 'select several: tap them, or draw a box', keys: 'V', touch: 'The dashed box at the top left' },
  { does: 'magnet: round places, turns and scales', keys: 'N', touch: 'The magnet at the top left' },
  { does: 'the magnet the other way round', mouse: 'Ctrl while dragging' },
  { does: 'pin the joint', keys: 'P', touch: 'Pin' },
  { does: 'give the joint another name', keys: 'F2', touch: 'Rename' },
  { does: 'lock the joint against painting', keys: 'L', touch: 'Lock' },
  { does: 'mirror the pose', keys: 'M', touch: 'Mirror' },
  { does: 'copy and paste the pose; with Shift, pasted mirrored', keys: 'Ctrl+C, Ctrl+V', touch: 'Copy, Paste' },
  { does: 'move, turn or scale the selected joints; with Shift, finely', mouse: 'Arrow keys' },
  { does: 'put the selected joints back', keys: 'Del', touch: 'Reset, below the joints' },
  { does: 'put all joints back', keys: 'Alt+R', touch: 'Reset' },
  { does: 'undo', keys: 'Ctrl+Z', touch: 'Undo' },
  { does: 'redo', keys: 'Ctrl+Shift+Z, Ctrl+Y', touch: 'Redo' },
  { does: 'from the front, the right, above', keys: '1, 3, 7', touch: 'Front, Side, Top' },
  { does: 'without or with perspective', keys: '5', touch: 'Flat' },
  { does: 'the whole model', keys: 'Home, F', touch: 'Whole model' },
  { does: 'the view, while no joint is selected', mouse: 'Arrow keys, + and -' },
  { does: 'hide or show the handles', keys: 'H', touch: 'Surface, Handles' },
  { does: 'arrows for exact work', keys: 'X', touch: 'Arrows' },
  { does: 'play or pause', keys: 'Space', touch: 'Play' },
  { does: 'the pose becomes a key', keys: 'K', touch: 'Key' },
  { does: 'choose and move keys; add to them; scale in time', mouse: 'Keys: drag, with Shift, with Alt', touch: 'Keys: drag them, beside them, the orange grips' },
  { does: 'copy keys, paste them at this moment, take them out', keys: 'Ctrl+C, Ctrl+V, Del', touch: 'Copy, Paste, Delete' },
  { does: 'paint what a joint moves', keys: 'B', touch: 'Paint areas' },
  { does: 'a smaller or larger brush', mouse: '[ and ]', touch: 'Size' },
  { does: 'take away, smooth, while painting', keys: 'Ctrl, Shift', touch: 'Take away, Smooth' },
  { does: 'open a file', keys: 'Ctrl+O', touch: 'Open' },
  { does: 'this list', keys: '?' },
];

export function help(page: PageStore): HTMLElement {
  const touched = matchMedia('(pointer: coarse)').matches;
  const how = ({ keys, mouse, touch }: Line) => (touched ? touch && say(touch) : keys === undefined ? mouse && say(mouse) : keyNames(keys));
  const title = touched ? say('What fingers do') : say('Keyboard and mouse');
  const dialog = element('dialog', { 'aria-labelledby': 'help-title', id: 'help' },
    element('h2', { id: 'help-title' }, title),
    element('dl', {}, ...lines.flatMap((line) => {
      const by = how(line);
      return by ? [element('dt', {}, by), element('dd', {}, say(line.does))] : [];
    })),
    button(say('Close'), () => page.set({ help: false }), { kind: 'primary' }));
  shownWhile(dialog, page, 'help', {
    opens() {
      dialog.showModal();
      dialog.scrollTop = 0; // the button at its end has the focus
    },
  });
  return dialog;
}
