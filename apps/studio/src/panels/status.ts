// What takes long, what went wrong, what the engine had to repair.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { counted } from '../ui/counted';
import { button, element } from '../ui/dom';
import { warningText } from '../words/engine';
import { number, say } from '../words/say';

export function status(studio: Studio, page: PageStore): HTMLElement {
  const stage = element('span', {});
  const bar = element('progress', { max: 1, 'aria-label': say('Progress') });
  const work = element('div', { class: 'toast work', role: 'status', hidden: true },
    stage, bar, button(say('Stop'), () => void studio.stop(), { id: 'stop' }));

  const title = element('strong', {}), detail = element('span', { class: 'detail' });
  const undo = button(say('Undo'), () => {
    const { notice } = page.now;
    page.set({ notice: null });
    void notice?.undo?.();
  }, { icon: 'undo', id: 'undo-notice', kind: 'primary' });
  const notice = element('div', { class: 'toast notice', role: 'alert', id: 'notice', hidden: true },
    element('div', { class: 'text' }, title, detail), undo, button(say('Close'), () => page.set({ notice: null }), { id: 'close-notice' }));

  page.watch((now) => {
    work.hidden = now.work === null;
    if (now.work) {
      stage.textContent = now.work.stage;
      if (now.work.fraction > 0) bar.value = now.work.fraction;
      else bar.removeAttribute('value');
    }
    notice.hidden = now.notice === null;
    notice.classList.toggle('error', now.notice?.kind === 'error');
    title.textContent = now.notice?.title ?? '';
    detail.textContent = now.notice?.detail ?? '';
    undo.hidden = !now.notice?.undo;
    detail.lang = now.notice?.inEnglish ? 'en' : '';
  });
  return element('div', { class: 'status' }, work, notice);
}

export function facts(page: PageStore): HTMLElement {
  const line = element('p', { class: 'facts', id: 'facts' });
  page.watch(({ session }) => {
    if (!session) return;
    const warnings = session.warnings.map(({ count, kind, message }) => (count === 1 ? warningText({ kind, message }) : `${warningText({ kind, message })} (${number(count)})`)).join('; ');
    line.textContent = [say('{count} vertices', { count: session.vertices }), counted(session.triangles, 'triangle'), ...session.own_rig ? [say('its own rig')] : []].join(', ')
      + (warnings === '' ? '' : `. ${say('Warnings: {warnings}', { warnings })}`);
    line.title = line.textContent;
  });
  return line;
}
