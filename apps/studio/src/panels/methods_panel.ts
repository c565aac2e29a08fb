// By which methods the model is rigged, and how others do beside them.
import type { MethodKind, SessionState } from '../engine/messages';
import type { PageState, PageStore } from '../app/state';
import { hasTemplate } from '../app/calls/core';
import type { Studio } from '../app/studio';
import { button, element, fileInput } from '../ui/dom';
import { methodName, methodSummary } from '../words/engine';
import { partName } from '../words/parts';
import { say } from '../words/say';
import { rigCheck } from './rig_check';

const rigFiles = '.glb,.gltf,.vrm,.fbx,.npz';

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
    row('rigger', say('Joints')), rigCheck(studio, page), correction(studio, page), otherRigs(studio, page), row('skinning', say('Skin')),
    row('deformer', say('Bending')), row('solver', say('Limbs')), report(studio, page));
}

/** Whole rows of a study's report beside the model. */
function report(studio: Studio, page: PageStore): HTMLElement {
  const file = fileInput('report-file', { accept: '.json' }, ([chosen]) => void studio.openReport(chosen!));
  const open = button(say('Compare with a report\u2026'), () => file.click(), {
    icon: 'compare', id: 'compare-report', label: say('Methods out of the cells.json that limber study writes, beside this model'),
  });
  page.watch(({ session }) => { open.disabled = !session; });
  return element('div', { class: 'row' }, open, file);
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

/** Rigs that no method makes: another model's, or the one that the file's own animation tells. */
function otherRigs(studio: Studio, page: PageStore): HTMLElement {
  const file = element('input', { type: 'file', accept: rigFiles, hidden: true, id: 'rig-file' });
  file.addEventListener('change', () => {
    const chosen = file.files?.[0];
    file.value = '';
    if (chosen) void studio.takeRig(chosen);
  });
  const take = button(say('Take a rig from another model\u2026'), () => file.click(), {
    id: 'take-rig', label: say('The joints, weights and blend shapes of another model of the same kind, fitted to this one'),
  });
  const found = button(say('Bones from its motion'), () => void studio.rigFromAnimation(), {
    id: 'rig-from-animation', label: say('Joints and weights that move the model as the animation in its file does'),
  });
  const apart = element('p', { id: 'rig-gaps' });
  page.watch(({ session }) => {
    take.disabled = !session;
    found.hidden = !session?.animated;
    apart.hidden = !session?.gaps;
    if (session?.gaps) apart.textContent = gapsText(session.gaps);
  });
  return element('div', { class: 'correction' }, take, found, file, apart);
}

/** Where the other model's surface stays apart from this one. */
function gapsText({ rms, beyond, limit, parts }: NonNullable<SessionState['gaps']>): string {
  const percent = (value: number) => value.toFixed(1);
  const all = say('Both surfaces lie {rms} % of the height apart.', { rms: percent(rms) });
  const worst = parts.filter((part) => part.beyond > 0).slice(0, 3).map(({ part }) => partName(part));
  if (worst.length === 0) return all;
  return `${all} ${say('{share} % of this one is farther than {limit} %: {parts}.', { share: percent(100 * beyond), limit: String(limit), parts: worst.join(', ') })}`;
}
