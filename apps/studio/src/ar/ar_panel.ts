// What is on the screen in augmented reality, beside the models: a line that helps, and what fingers need at hand.
import type { ArState, DragMode, PageState } from '../app/state';
import { sceneDuration } from '../app/clips';
import { togglePlaying } from '../app/player';
import { addDialog } from '../panels/add_dialog';
import { handleCount } from '../panels/pose_panel';
import { status } from '../panels/status';
import { button, choice, element, setIcon } from '../ui/dom';
import { say } from '../words/say';
import type { ArView } from './ar_view';
import type { Desk } from './desk';

export interface ArPanel {
  root: HTMLElement;
  show(view: ArView): void;
  close(): void;
}

export function arPanel({ studio, page }: Desk): ArPanel {
  let view: ArView | null = null;
  const line = element('p', { class: 'ar-line', id: 'ar-line', role: 'status' });
  const leave = button(say('Close'), () => void view?.leave(), { label: say('Back to the desk'), id: 'ar-close' });
  const undo = button('', () => void studio.undo(), { icon: 'undo', label: say('Undo'), id: 'ar-undo' });
  const redo = button('', () => void studio.redo(), { icon: 'redo', label: say('Redo'), id: 'ar-redo' });
  const place = button(say('Place it here'), () => void view?.settle(), { kind: 'primary', id: 'ar-place' });
  const pose = button(say('Pose'), () => page.set({ display: page.now.display === 'handles' ? 'surface' : 'handles' }), {
    icon: 'motions', label: say('Show handles to pose the model'), id: 'ar-pose',
  });
  const again = button(say('Move it'), () => view?.placeAgain(), { icon: 'pin', label: say('Look for another place for it'), id: 'ar-again' });
  const play = button('', () => togglePlaying(studio, page), { icon: 'play', label: say('Play'), id: 'ar-play' });
  const mode = choice<DragMode>(say('What dragging a handle does'), [
    { value: 'move', text: say('Move'), icon: 'move' }, { value: 'turn', text: say('Turn'), icon: 'turn' },
  ], (value) => page.set({ mode: value }));
  const handles = handleCount(studio, page);
  const adding = addDialog(studio);
  const posing = element('div', { class: 'ar-posing' }, handles, mode.root);
  const tools = element('div', { class: 'row ar-tools' }, pose, play, again, adding.button);
  const root = element('main', { class: 'ar', id: 'ar' },
    element('div', { class: 'ar-surface', role: 'application', 'aria-label': say('The models in the real place. Buttons do what can be done without pointing.') }),
    element('div', { class: 'ar-top' }, leave, line, element('div', { class: 'group' }, undo, redo)),
    status(studio, page),
    element('div', { class: 'ar-bottom' }, posing, place, tools), adding.dialog);

  const stop = page.watch((now) => {
    const { ar, session, display } = now, placing = ar?.step !== 'placed', isPosing = display === 'handles';
    line.textContent = told(now);
    undo.disabled = !session?.undo;
    redo.disabled = !session?.redo;
    place.hidden = !ar || !placing;
    tools.hidden = placing;
    posing.hidden = placing || !isPosing;
    pose.setAttribute('aria-pressed', String(isPosing));
    play.hidden = sceneDuration(session) <= 0;
    setIcon(play, now.playing ? 'pause' : 'play');
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

/** What is the matter, else what to do next. */
function told({ ar, display, mode }: PageState): string {
  if (!ar) return say('Starting');
  if (ar.trouble) return troubles()[ar.trouble];
  if (ar.step === 'placing') return ar.surface ? say('Tap to place the model here') : say('Point the device at the floor or a table, and move it slowly');
  if (display !== 'handles') return ar.realSize ? say('Tap the model to pose it. Drag it to move it, turn and scale it with two fingers') : say('Not its real size');
  return mode === 'move' ? say('Drag a handle; walk with it to push or pull') : say('Drag a handle to turn it about its parent');
}

const troubles = (): Record<NonNullable<ArState['trouble']>, string> => ({
  'no-surface': say('No surface found yet. Look at one with a pattern and enough light, or place the model before you'),
  lost: say('The place is lost for the moment. Move the device slowly, back to where it was'),
  hidden: say('Waiting. Everything is as you left it'),
});
