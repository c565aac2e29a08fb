// Can the model be rigged with a named skeleton? What body it is, how it is posed and what stands in the way, before any work.
import { hasTemplate } from '../app/calls/core';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { RigCheck } from '../engine/messages';
import { button, element } from '../ui/dom';
import { adviceLines, bodyPoseText, bodyText, isNoBody } from '../words/rig_check';
import { say } from '../words/say';

function answerTo(check: RigCheck): HTMLElement[] {
  const pose = bodyPoseText(check), lines = adviceLines(check);
  return [
    element('p', { class: 'body' }, bodyText(check)),
    ...pose === null ? [] : [element('p', { class: 'body-pose' }, pose)],
    lines.length === 0 ? element('p', {}, say('Nothing stands in the way.'))
      : element('ul', {}, ...lines.map(({ text, inEnglish }) => element('li', { lang: inEnglish ? 'en' : null }, text))),
  ];
}

export function rigCheck(studio: Studio, page: PageStore): HTMLElement {
  let asked = 0; // of answers that come late only the last one counts
  const ask = button(say('Can it be rigged?'), () => void check(), {
    icon: 'help', id: 'check-rig', label: say('What body it is, how it is posed, and what stands in the way of a skeleton with names'),
  });
  const answer = element('div', { class: 'rig-check', id: 'rig-check', role: 'status' });
  const give = button(say('Give it a skeleton'), () => void studio.chooseMethods({ rigger: 'template' }), { kind: 'primary', id: 'give-skeleton' });
  const root = element('div', { class: 'correction' }, ask, answer, give);

  function show(texts: HTMLElement[], canBeGiven = false) {
    answer.replaceChildren(...texts);
    give.hidden = !canBeGiven;
  }
  async function check() {
    const number = ++asked;
    show([element('p', {}, say('Working \u2026'))]);
    const found = await studio.checkRig();
    if (number !== asked) return;
    if (found) show(answerTo(found), !isNoBody(found));
    else show([element('p', {}, say('This could not be found out now. It can be rigged all the same.'))]);
  }

  page.watch(({ session, model }, before) => {
    root.hidden = !session || hasTemplate(session);
    if (model === before.model) return;
    ++asked;
    show([]);
  });
  show([]);
  return root;
}
