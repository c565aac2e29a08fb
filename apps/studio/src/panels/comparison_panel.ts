// Below each figure of a comparison: its method, and what it measures.
import type { LimberError, Measures, Variant } from '../engine/messages';
import { chosenClip } from '../app/clips';
import { obstacleOf, type Obstacle, type ReportRow } from '../app/report_rows';
import type { Comparison, PageState, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { ComparisonView } from '../scene/comparison_view';
import { button, element } from '../ui/dom';
import { methodName, methodSummary, told } from '../words/engine';
import { language, number, percent, say } from '../words/say';
import { currentMethod } from './methods_panel';

const most = 4; // figures beside each other

/** What is worth comparing, in words, and better low or high left to the reader. */
function figuresOf(measures: Measures): [string, string][] {
  const { motion } = measures;
  const rows: [string, string][] = [
    [say('Joints'), number(measures.joints)],
    [say('Joints a vertex'), number(measures.influences, 2)],
    [say('Weights change'), number(measures.smoothness, 3)],
    [say('Stretched'), percent(measures.stretch)],
    [say('Volume'), `${measures.volume >= 0 ? '+' : '\u2212'}${percent(Math.abs(measures.volume))}`],
  ];
  if (measures.target_distance !== null) rows.push([say('Pins missed by'), `${number(1000 * measures.target_distance, 1)} mm`]);
  if (motion) {
    rows.splice(1, 2);
    rows.push([say('Bones off'), `${number(motion.bone_direction_degrees, 1)}\u00b0`],
      [say('Ends off'), percent(motion.end_effector_share)],
      [say('Feet slide'), `${number(motion.sliding_centimetres_per_second, 1)} cm/s`],
      [say('Feet sink'), `${number(motion.penetration_millimetres)} mm`], [say('Jerk'), `${number(motion.jerk_ratio, 2)}\u00d7`]);
  }
  return rows;
}

/** What can stand beside the model. */
interface Choice {
  name: string;
  text: string;
  summary: string;
  /** Why it cannot, else empty. */
  why: string;
  row?: ReportRow;
}

const whyNot: Record<Obstacle, string> = {
  method: say('not in the page'), own: say('keeps each model\u2019s own skeleton'), solver: say('another solver'), motion: say('needs a motion'),
};

function choicesOf({ kind }: Comparison, { methods, report, session }: PageState): Choice[] {
  if (!methods) return [];
  if (kind !== 'report') return methods[kind].map((method) => ({ name: method.name, text: methodName(method.name), summary: methodSummary(method), why: '' }));
  return report.map((row) => {
    const obstacle = obstacleOf(row, methods, Boolean(chosenClip(session)?.source));
    return { name: row.name, text: row.name, summary: '', why: obstacle ? whyNot[obstacle] : '', row };
  });
}

function ownName({ kind }: Comparison, now: PageState): string {
  if (kind !== 'report') return methodName(currentMethod(kind, now));
  return (['rigger', 'skinning', 'deformer', 'retargeting'] as const).map((one) => currentMethod(one, now)).filter(Boolean).join(' + ');
}

/** What the report says of a row; its own words. */
function fromReport({ cells, done, options, figures }: ReportRow): HTMLElement {
  const rows: [string, string][] = [[say('Ended well'), `${done}/${cells}`], ...figures.map(({ measure, median }): [string, string] =>
    [measure.replaceAll('_', ' '), median.toLocaleString(language, { maximumSignificantDigits: 4 })])];
  return element('details', { class: 'report' }, element('summary', {}, say('In the report')),
    options ? element('p', { class: 'note' }, say('with options that are not set here: {options}', { options })) : null,
    element('dl', {}, ...rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)])));
}

export function comparisonPanel(studio: Studio, page: PageStore, view: ComparisonView): HTMLElement {
  const root = element('section', { class: 'comparison', 'aria-label': say('Comparison'), id: 'comparison', hidden: true });
  const close = button(say('End comparison'), () => void studio.endComparison(), { id: 'end-comparison', kind: 'primary' });
  let columns: HTMLElement[] = [];
  view.onPlaced = (places) => {
    const room = columns[0] ? (columns[0].offsetWidth + 8) / Math.max(1, root.offsetWidth) : 0;
    apart(places, room).forEach((at, i) => columns[i]?.style.setProperty('--at', String(at)));
  };

  const column = (comparison: Comparison, index: number): HTMLElement => {
    const card = element('div', { class: 'card column' });
    if (index < 0) {
      card.append(element('h2', {}, ownName(comparison, page.now)));
      if (comparison.measures) card.append(table(comparison.measures));
      return card;
    }
    const choices = choicesOf(comparison, page.now);
    const select = element('select', { class: 'select', 'aria-label': say('The method beside it') },
      ...choices.map(({ name, text, summary, why }) => element('option', { value: name, title: summary, disabled: why !== '' }, why ? `${text} (${why})` : text)));
    select.value = comparison.names[index] ?? '';
    select.addEventListener('change', () => void studio.compare(comparison.kind, comparison.names.map((name, i) => (i === index ? select.value : name))));
    const remove = button('', () => {
      const names = comparison.names.filter((_, i) => i !== index);
      void (names.length > 0 ? studio.compare(comparison.kind, names) : studio.endComparison());
    }, { icon: 'erase', label: say('Take this one out') });
    const row = choices.find(({ name }) => name === select.value)?.row;
    card.append(element('div', { class: 'row head' }, select, remove), result(comparison.variants[index]), row ? fromReport(row) : '');
    return card;
  };

  let drawn: Comparison | null = null;
  page.watch(({ comparison }) => {
    root.hidden = comparison === null;
    if (comparison === drawn) return;
    drawn = comparison;
    if (!comparison) return;
    columns = [column(comparison, -1), ...comparison.names.map((_, i) => column(comparison, i))];
    columns.forEach((one, i) => one.style.setProperty('--at', String((i + 1) / (columns.length + 1))));
    const own = comparison.kind === 'report' ? '' : currentMethod(comparison.kind, page.now);
    const unused = choicesOf(comparison, page.now).find(({ name, why }) => !why && name !== own && !comparison.names.includes(name));
    const add = button(say('Another'), () => void studio.compare(comparison.kind, [...comparison.names, unused!.name]), { icon: 'add', id: 'compare-another' });
    add.disabled = !unused || comparison.names.length + 1 >= most;
    root.style.setProperty('--count', String(columns.length));
    root.replaceChildren(element('div', { class: 'row tools' }, add, close), ...columns);
  });
  return root;
}

/** Places in a row, each at least `room` from the next, and all of them within 0 and 1. */
function apart(places: number[], room: number): number[] {
  const last = places.length - 1, first = places[0] ?? 0, end = places[last] ?? 0;
  const step = Math.max(room, last > 0 ? (end - first) / last : 0);
  const middle = Math.min(1 - (last * step + room) / 2, Math.max((last * step + room) / 2, (first + end) / 2));
  return places.map((_, i) => middle + (i - last / 2) * step);
}

function result(variant: Variant | LimberError | undefined): HTMLElement {
  if (!variant) return element('p', { class: 'note' }, say('Working \u2026'));
  return 'measures' in variant ? table(variant.measures) : element('p', { class: 'note' }, told(variant).title);
}

function table(measures: Measures): HTMLElement {
  return element('dl', {}, ...figuresOf(measures).flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
}
