// By which methods the model is rigged, and how others do beside them.
import type { MethodKind } from '../engine/messages';
import type { PageState, PageStore } from '../app/state';
import { hasTemplate } from '../app/calls/core';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { methodName, methodSummary } from '../words/engine';
import { say } from '../words/say';

/** What the document has of that kind. */
export function currentMethod(kind: MethodKind, { session }: PageState): string {
  if (!session) return '';
  return kind === 'retargeting' ? session.clips[session.clip ?? -1]?.source?.method ?? '' : session[kind];
}

/** Shows the document beside the method that comes first among the others. */
export function compareButton(studio: Studio, page: PageStore, kind: MethodKind): HTMLButtonElement {
  const made = button('', () => {
    if (page.now.comparison?.kind === kind) return void studio.endComparison();
    const other = page.now.methods?.[kind].find(({ name }) => name !== currentMethod(kind, page.now));
    if (other) void studio.compare(kind, [other.name]);
  }, { icon: 'compare', label: say('Compare with other methods, side by side'), id: `compare-${kind}` });
  page.watch((now) => {
    made.disabled = !now.session || (now.methods?.[kind].length ?? 0) < 2;
    made.setAttribute('aria-pressed', String(now.comparison?.kind === kind));
  });
  return made;
}

export function methodsPanel(studio: Studio, page: PageStore): HTMLElement {
  const choose: Record<'rigger' | 'skinning' | 'deformer' | 'solver', (name: string) => void> = {
    rigger: (rigger) => void studio.chooseMethods({ rigger }),
    skinning: (skinning) => void studio.chooseMethods({ skinning }),
    deformer: (deformer) => void studio.chooseDeformer(deformer),
    solver: (solver) => void studio.chooseSolver(solver),
  };
  const row = (kind: keyof typeof choose, text: string) => {
    const select = element('select', { class: 'select', id: kind });
    select.addEventListener('change', () => choose[kind](select.value));
    page.watch(({ methods, session }) => {
      if (methods && select.childElementCount === 0) {
        select.append(...methods[kind].map((method) => element('option', { value: method.name, title: methodSummary(method) }, methodName(method.name))));
      }
      select.disabled = !session;
      if (session) select.value = session[kind];
    });
    return element('div', { class: 'field' }, element('label', { for: kind }, text), select, compareButton(studio, page, kind));
  };
  return element('details', { class: 'card methods', id: 'methods' }, element('summary', {}, say('How it is done')),
    row('rigger', say('Joints')), correction(studio, page), row('skinning', say('Skin')), row('deformer', say('Deformation')), row('solver', say('Limbs')));
}

/** Joints of a named skeleton that are not where they should be. */
function correction(studio: Studio, page: PageStore): HTMLElement {
  const made = button(say('Correct joints'), () => void studio.correct(!page.now.correcting), {
    icon: 'pin', id: 'correct', label: say('Put joints where they should be; the model is rigged anew'),
  });
  const hint = element('p', {}, say('Drag a joint to where it should be; or select one and touch the model there.'));
  const row = element('div', { class: 'correction' }, made, hint);
  page.watch(({ session, correcting }) => {
    row.hidden = !session || !hasTemplate(session);
    made.setAttribute('aria-pressed', String(correcting));
    hint.hidden = !correcting;
  });
  return row;
}
