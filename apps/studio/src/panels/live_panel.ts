// Whether motion comes from another program, and what becomes of it. Loaded where the program serves the page with --live.
import type { LiveState } from '../app/calls/live';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { say } from '../words/say';

export function livePanel(studio: Studio): HTMLElement {
  const told = element('span', { role: 'status', id: 'live-state' });
  const pause = button(say('Pause'), () => void studio.pauseLive(), { id: 'live-pause' });
  const follow = button(say('Follow'), () => studio.followLive(), { id: 'live-follow' });
  const keep = button(say('Keep as a clip'), () => void studio.keepLive(), { id: 'live-keep' });
  const states: Record<LiveState, string> = {
    waiting: say('Waiting for motion'), following: say('Following live motion'), paused: say('Live motion is paused'),
  };
  studio.listenLive((state) => {
    told.textContent = states[state];
    pause.hidden = state === 'paused';
    follow.hidden = state !== 'paused';
    keep.hidden = state !== 'following';
  });
  return element('section', { class: 'card live', 'aria-label': say('Live motion'), id: 'live' },
    element('div', { class: 'row' }, told, pause, follow, keep));
}
