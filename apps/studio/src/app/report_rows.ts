// The cells.json of limber study as rows to compare with: a method each, with the medians of its figures.
import type { Command, Methods } from '../engine/messages';

const fields = ['kind', 'rigger', 'skinning', 'deformer', 'options', 'retargeting', 'solver'] as const;
export type RowMethods = Record<(typeof fields)[number], string>;

export interface ReportRow extends RowMethods {
  /** As the report writes the method. */
  name: string;
  /** Models, or models and motions, and how many of them ended well. */
  cells: number;
  done: number;
  figures: { measure: string; median: number }[];
}

/** What keeps the page from doing as a row does: it lacks a method, each model keeps its own skeleton, another solver is in
 *  the motion, or the model has no motion. */
export type Obstacle = 'method' | 'own' | 'solver' | 'motion';

const pageSolver = 'two-bone'; // by which the page retargets

const median = (values: number[]) => {
  const sorted = values.toSorted((a, b) => a - b), middle = sorted.length >> 1;
  return sorted.length % 2 ? sorted[middle]! : (sorted[middle - 1]! + sorted[middle]!) / 2;
};

const isRecord = (value: unknown): value is Record<string, unknown> => typeof value === 'object' && value !== null;

/** In the report's order; null where the text is no such file. */
export function reportRows(text: string): ReportRow[] | null {
  let document: unknown;
  try {
    document = JSON.parse(text);
  } catch {
    return null;
  }
  const cells: unknown = isRecord(document) ? document['cells'] : null;
  if (!Array.isArray(cells)) return null;
  const found = new Map<string, { methods: RowMethods; subjects: Map<string, boolean>; values: Map<string, number[]> }>();
  for (const cell of cells as unknown[]) {
    if (!isRecord(cell)) return null;
    const textOf = (key: string) => (typeof cell[key] === 'string' ? cell[key] : '');
    const methods = Object.fromEntries(fields.map((key) => [key, textOf(key)])) as RowMethods;
    if (methods.kind !== 'rig' && methods.kind !== 'retarget') continue;
    const name = rowName(methods), key = `${methods.kind} ${name}`;
    const row = found.get(key) ?? { methods, subjects: new Map(), values: new Map() };
    found.set(key, row);
    row.subjects.set(JSON.stringify([textOf('group'), textOf('model'), textOf('motion')]), cell['outcome'] === 'done');
    const { measure, value } = cell;
    if (typeof measure !== 'string' || typeof value !== 'number') continue;
    row.values.set(measure, [...row.values.get(measure) ?? [], value]);
  }
  return [...found.values()].map(({ methods, subjects, values }) => ({
    ...methods, name: rowName(methods), cells: subjects.size, done: [...subjects.values()].filter(Boolean).length,
    figures: [...values].map(([measure, all]) => ({ measure, median: median(all) })),
  }));
}

function rowName({ rigger, skinning, deformer, options, retargeting, solver }: RowMethods): string {
  const methods = [rigger, skinning, deformer, retargeting, solver].filter(Boolean).join(' + ');
  return options ? `${methods}, ${options}` : methods;
}

export function obstacleOf(row: RowMethods, methods: Methods, hasMotion: boolean): Obstacle | null {
  const knows = (kind: keyof Methods, name: string) => methods[kind].some((method) => method.name === name);
  if (row.kind === 'rig') {
    if (row.rigger === 'own') return 'own';
    const isKnown = knows('rigger', row.rigger) && knows('skinning', row.skinning) && (!row.deformer || knows('deformer', row.deformer));
    return isKnown ? null : 'method';
  }
  if (!knows('retargeting', row.retargeting)) return 'method';
  if (row.solver && row.solver !== pageSolver) return 'solver';
  return hasMotion ? null : 'motion';
}

/** What makes a rig of the model as the row does. */
export function rigCommands({ rigger, skinning, deformer }: RowMethods): Command[] {
  return [{ do: 'choose_methods', rigger, skinning }, ...(deformer ? [{ do: 'set_deformer' as const, deformer }] : [])];
}

