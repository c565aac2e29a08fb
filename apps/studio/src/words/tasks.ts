// Tasks and what became of them, as the engine has them in English, in the words of the page.
import type { SessionState } from '../engine/messages';
import { number, say, type Words } from './say';

const tasks: Readonly<Record<string, Words>> = {
  'position': 'at a place', 'orientation': 'turned as it rests', 'look-at': 'looks at a place', 'distance': 'at a distance', 'plane': 'keeps to a plane',
  'balance': 'Balance over the feet', 'keep-out': 'stays out of a ball', 'coupling': 'turns with another',
};
/** What kind of task it is, of "kind:joint=...". */
export const taskName = (kind: string) => {
  const known = tasks[kind];
  return known ? say(known) : kind;
};

const obstacles: Readonly<Record<string, Words>> = {
  'the bones are too short': '{left} left: the bones are too short',
  'the joints\' limits are in the way': '{left} left: the joints\u2019 limits are in the way',
  'other tasks are in the way': '{left} left: other tasks are in the way',
  'no pose was found that meets it, even alone': '{left} left: no pose was found that meets it, even alone',
};
/** What is left of a task and why, of "not met, 0.1 m left: ...". */
export function taskOutcome({ met, outcome }: SessionState['tasks'][number]): string {
  if (met) return say('met');
  const [, amount = '', unit, why = ''] = /^not met, ([\d.]+) (degrees|m) left: (.*)$/.exec(outcome) ?? [], known = obstacles[why];
  return known ? say(known, { left: unit === 'm' ? `${number(Number(amount), 3)} m` : `${number(Number(amount), 1)}\u00b0` }) : outcome;
}
