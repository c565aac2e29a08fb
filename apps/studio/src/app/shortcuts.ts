// Keys that work wherever the focus is, but in a field of text.
import type { HandleView } from '../scene/handle_view';
import type { Viewport } from '../scene/viewport';
import { resizeBrush, togglePainting } from '../panels/paint_panel';
import { toggleSelecting } from '../panels/pose_tools';
import { togglePlaying } from './player';
import type { PoseShelf } from './pose_shelf';
import type { PageStore } from './state';
import type { Studio } from './studio';

export function bindShortcuts(studio: Studio, page: PageStore, viewport: Viewport, handles: HandleView, poses: PoseShelf) {
  const selected = (act: (joint: number) => void) => () => {
    if (page.now.selected !== null) act(page.now.selected);
  };
  const plain: Record<string, () => void> = {
    'g': () => page.set({ mode: 'move' }),
    'r': () => page.set({ mode: 'turn' }),
    'S': () => page.set({ mode: 'scale' }),
    'i': () => void studio.toggleIk(),
    's': () => page.set({ bothSides: !page.now.bothSides }),
    'm': () => void studio.mirrorPose(),
    'p': selected((joint) => void studio.togglePin(joint, handles.position(joint).toArray())),
    'h': () => page.set({ display: page.now.display === 'handles' ? 'surface' : 'handles' }),
    'f': () => viewport.frameAgain(),
    'Home': () => viewport.frameAgain(),
    'Delete': selected((joint) => void studio.resetJoint(joint)),
    '1': () => viewport.look('front'),
    '3': () => viewport.look('right'),
    '7': () => viewport.look('top'),
    '+': () => viewport.zoom(1.2),
    '-': () => viewport.zoom(1 / 1.2),
    '5': () => viewport.toggleOrthographic(),
    ' ': () => togglePlaying(studio, page),
    'k': () => { if (page.now.session?.clip != null) void studio.setKey(); },
    'b': () => togglePainting(page),
    '[': () => resizeBrush(page, 1 / 1.15),
    ']': () => resizeBrush(page, 1.15),
    'l': selected((joint) => void studio.toggleLock(joint)),
    'x': () => page.set({ gizmo: !page.now.gizmo }),
    'n': () => page.set({ snapping: !page.now.snapping }),
    'v': () => toggleSelecting(page),
    '?': () => page.set({ help: true }),
  };
  const withControl: Record<string, () => void> = {
    'z': () => void studio.undo(), 'Z': () => void studio.redo(), 'y': () => void studio.redo(),
    'o': () => document.getElementById('file')?.click(),
    'c': () => void poses.copy(), 'v': () => void poses.paste(), 'V': () => void poses.paste({ mirrored: true }),
  };
  addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (event.key === ' ' && target.matches('button, summary')) return; // it is pressed
    if (target.matches('input:not([type=range], [type=checkbox]), select, textarea') || page.now.help || document.querySelector('dialog:modal')) return;
    if (event.altKey && event.key.toLowerCase() === 'r') void studio.resetPose();
    else if (event.altKey) return;
    else if (event.ctrlKey || event.metaKey) {
      const act = withControl[event.shiftKey ? event.key.toUpperCase() : event.key];
      if (!act || (event.key === 'c' && getSelection()?.isCollapsed === false)) return; // text is copied
      act();
    } else {
      const act = plain[event.key];
      if (!act || !page.now.session) return;
      act();
    }
    event.preventDefault();
  });
}
