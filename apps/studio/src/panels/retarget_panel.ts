// How the chosen clip was brought onto the model, where it comes from a motion: method, reach, which joint follows which.
import { jointColor } from '../scene/palette';
import type { SessionState } from '../engine/messages';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { counted } from '../ui/counted';
import { element } from '../ui/dom';
import { methodName, methodSummary } from '../words/engine';
import { partName } from '../words/parts';
import { say } from '../words/say';
import { compareButton } from './methods_panel';
import { chosenClip } from './moments';

const doubtful = 0.75;

export function retargetPanel(studio: Studio, page: PageStore): HTMLElement {
  const method = element('select', { class: 'select', id: 'method' });
  method.addEventListener('change', () => void studio.retarget({ method: method.value }));
  const reach = element('input', { type: 'range', id: 'reach', min: 0, max: 1, step: 0.05 });
  reach.addEventListener('change', () => void studio.retarget({ reach: reach.valueAsNumber }));
  const contacts = element('input', { type: 'checkbox', id: 'contacts' });
  contacts.addEventListener('change', () => void studio.retarget({ contacts: contacts.checked }));
  const shown = element('input', { type: 'checkbox', id: 'source-shown' });
  shown.addEventListener('change', () => page.set({ sourceShown: shown.checked }));
  const rows = element('tbody');
  const summary = element('summary', {}, say('Matched joints'));
  const from = element('p', { class: 'from' });
  let drawn = '', choices = '';
  // Parts of this clip that were taken out of the match, to be put in again.
  let half: SessionState['match'] = [], halfOf = '', matched = '';
  const card = element('section', { class: 'card retarget', 'aria-label': say('Motion'), id: 'retarget', hidden: true },
    element('h2', {}, say('Motion')), from,
    element('div', { class: 'field' }, element('label', { for: 'method' }, say('Method')), method, compareButton(studio, page, 'retargeting')),
    element('label', { class: 'field' }, say('Hands reach'), reach),
    element('label', { class: 'check' }, contacts, say('Feet stay planted')),
    element('label', { class: 'check' }, shown, say('The other character beside it')),
    element('details', {}, summary,
      element('table', { id: 'match' }, element('thead', {}, element('tr', {}, element('td'), element('th', {}, say('Motion')), element('th', {}, say('Model')))), rows)));
  page.watch(({ session, methods, sourceModel, sourceShown }) => {
    if (methods && method.childElementCount === 0) {
      method.append(...methods.retargeting.map((each) => element('option', { value: each.name, title: methodSummary(each) }, methodName(each.name))));
    }
    shown.checked = sourceShown;
    shown.parentElement!.hidden = sourceModel === null;
    const clip = chosenClip(session), source = clip?.source ?? null;
    card.hidden = source === null;
    if (!session || !clip || !source) return;
    from.textContent = source.motion;
    method.value = source.method;
    reach.valueAsNumber = source.reach;
    reach.disabled = source.method !== 'limb-ik';
    contacts.checked = source.contacts;
    const unsure = session.match.filter((match) => match.by !== 'file' && match.confidence < doubtful).length;
    summary.textContent = say(unsure > 0 ? '{parts} matched, {unsure} to look at' : '{parts} matched', { parts: counted(session.match.length, 'part'), unsure });
    const taken = new Set(session.match.map(({ part }) => part));
    const match = JSON.stringify(session.match);
    if (halfOf !== clip.name) half = [];
    halfOf = clip.name;
    // The store also changes while the engine still retargets: until it has, the part is in the match.
    if (match !== matched) half = half.filter(({ part }) => !taken.has(part));
    matched = match;
    const apart = half.filter(({ part }) => !taken.has(part));
    const now = JSON.stringify([session.match, apart, source.motion, session.joints.length]);
    const chosen = () => [...rows.querySelectorAll('select')].map(({ value }) => value).join('\n');
    if (now === drawn && chosen() === choices) return;
    drawn = now;
    const motion = session.motions.find(({ name }) => name === source.motion);
    const sources = motion?.joints.map(({ name }) => name) ?? [], targets = session.joints.map(({ name }) => name);
    const listed = [...session.match, ...apart];
    rows.replaceChildren(...listed.map((match, index) => {
      const change = (side: 'source' | 'target') => (joints: string[]) => {
        const changed = { ...match, [side]: joints }, whole = changed.source.length > 0 && changed.target.length > 0;
        half = half.filter(({ part }) => part !== match.part);
        if (!whole) half.push(changed);
        const matches = listed.map((other, i) => (i === index ? changed : other))
          .filter((other) => other.source.length > 0 && other.target.length > 0);
        void studio.retarget({ map: JSON.stringify({ matches }) });
      };
      const color = element('i', { class: 'swatch' });
      color.style.background = `#${jointColor(index).getHexString()}`;
      const row = element('tr', { title: partName(match.part) }, element('td', {}, color),
        element('td', {}, jointsSelect(say('{part} in the motion', { part: partName(match.part) }), sources, match.source, change('source'))),
        element('td', {}, jointsSelect(say('{part} in the model', { part: partName(match.part) }), targets, match.target, change('target'))));
      row.classList.toggle('unsure', match.by !== 'file' && match.confidence < doubtful);
      return row;
    }));
    choices = chosen();
  });
  return card;
}

/** One joint, or a chain that is shown as one choice; none takes the part out of the match. */
function jointsSelect(label: string, names: string[], now: string[], choose: (joints: string[]) => void): HTMLElement {
  const chain = now.length > 1;
  const select = element('select', { class: 'select', 'aria-label': label },
    chain ? element('option', { value: '\n' }, `${now[0]} \u2026 ${now.at(-1)}`) : null,
    element('option', { value: '' }, '\u2014'), ...names.map((name) => element('option', { value: name }, name)));
  select.value = chain ? '\n' : now[0] ?? '';
  select.addEventListener('change', () => choose(select.value === '' ? [] : [select.value]));
  return select;
}
