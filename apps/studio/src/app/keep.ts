// What the list of kept documents shows, and what is said where the browser keeps nothing.
import type { Viewport } from '../scene/viewport';
import type { Journal } from './journal';
import type { PageStore } from './state';
import type { Studio } from './studio';
import { say } from '../words/say';

const quiet = 1000; // milliseconds without a change before a picture is taken
const width = 192, height = 128; // pixels of the picture

export function bindJournal(journal: Journal, studio: Studio, page: PageStore, viewport: Viewport) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  let timer = 0;
  const later = () => {
    clearTimeout(timer);
    timer = window.setTimeout(describe, quiet);
  };
  const describe = () => {
    const context = canvas.getContext('2d'), { session, playing } = page.now;
    if (!session || !context) return;
    if (playing || !studio.idle) return later();
    context.fillStyle = '#eef0f3';
    context.fillRect(0, 0, width, height);
    viewport.drawInto(context, 0, 0, width, height);
    journal.describe(session.members.length > 1 ? session.members.map(({ name }) => name).join(', ') : session.name, canvas.toDataURL('image/jpeg', 0.8));
  };
  page.watch((now, before) => {
    if (now.session !== before.session && now.session) later();
  });

  journal.onTrouble = (why) => page.set({
    notice: { kind: 'error', title: say('This browser cannot keep your work'), detail: say('Save it as a file before you leave ({why})', { why }) },
  });
  addEventListener('pagehide', () => journal.flush());
  addEventListener('beforeunload', (event) => {
    if (!journal.written || studio.changing() || (journal.atRisk && page.now.session?.undo)) event.preventDefault();
  });
}
