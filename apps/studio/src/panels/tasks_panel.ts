// What the body shall do, all at once: look somewhere, keep out of something, stay in balance; and what became of each.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Vector } from '../engine/messages';
import type { Viewport } from '../scene/viewport';
import { button, element } from '../ui/dom';
import { jointTitle } from '../words/parts';
import { say } from '../words/say';
import { taskName, taskOutcome } from '../words/tasks';

const balance = 'balance=within';
const kindOf = (task: string) => task.split(/[:=]/)[0]!;
const jointOf = (task: string) => /^[^:=]+:([^=]*)=/.exec(task)?.[1] ?? '';
const numbers = (...values: number[]) => values.map((value) => Number(value.toFixed(4)) + 0).join(',');

/** Tasks whose numbers are typed, as they stand for a joint at that place. */
const typed: Record<string, (joint: string, at: Vector, radius: number, parent: string) => string> = {
  'position': (joint, at) => `position:${joint}=${numbers(...at)}`,
  'orientation': (joint) => `orientation:${joint}=y:0`,
  'keep-out': (joint, at, radius) => `keep-out:${joint}=sphere:${numbers(...at, radius)}`,
  'distance': (joint, at, radius) => `distance:${joint}=${numbers(...at)}:${numbers(radius)}`,
  'coupling': (joint, _at, _radius, parent) => `coupling:${joint}=${parent}:0.5`,
};

export function tasksPanel(studio: Studio, page: PageStore, viewport: Viewport): HTMLElement {
  let wanted: string[] = [], known = '', skeleton = '', moment = 0;
  let handles: Float32Array = new Float32Array();
  studio.readStance((stance) => { handles = stance.handles; });

  const selected = () => page.now.session?.joints[page.now.selected ?? -1];
  const apply = (tasks: string[]) => {
    known = '';
    void studio.applyTasks(tasks);
  };
  /** What became of it, in the pose that is shown. */
  const outcomeOf = (task: string) => (page.now.seconds === moment ? page.now.session?.tasks.find((one) => one.task === task) : undefined);
  /** In place of one of its kind for the joint. */
  const ask = (task: string) => apply([...wanted.filter((other) => kindOf(other) !== kindOf(task) || jointOf(other) !== jointOf(task)), task]);
  const drop = (task: string) => {
    wanted = wanted.filter((other) => other !== task);
    show();
  };

  const look = button(say('Look at me'), () => ask(`look-at:${selected()!.name}=${numbers(...viewport.eye())}`), {
    id: 'task-look', label: say('The selected joint turns so that what it carries looks at the camera'),
  });
  const ground = button(say('Above the ground'), () => {
    const { normal, distance } = viewport.floor();
    ask(`plane:${selected()!.name}=above:${numbers(...normal, distance)}`);
  }, { id: 'task-ground', label: say('The selected joint does not sink into the ground') });
  const stand = button(say('Balance'), () => (wanted.includes(balance) ? drop(balance) : ask(balance)), {
    id: 'task-balance', label: say('The weight of the body is over its feet; all of it may move for that'),
  });

  const text = element('input', { id: 'task-text', 'aria-label': say('Task, as text'), placeholder: 'look-at:head=0,1.6,2', autocomplete: 'off', spellcheck: 'false' });
  const add = () => {
    const task = text.value.trim();
    if (task !== '') apply([...wanted.filter((other) => other !== task), task]);
  };
  text.addEventListener('keydown', (event) => { if (event.key === 'Enter') add(); });
  const other = element('select', { class: 'select', id: 'task-kind', 'aria-label': say('Another task') },
    element('option', { value: '' }, say('Another task')), ...Object.keys(typed).map((kind) => element('option', { value: kind }, taskName(kind))));
  other.addEventListener('change', () => {
    const joint = selected(), index = page.now.selected ?? 0, make = typed[other.value];
    other.value = '';
    if (!joint || !make) return;
    const at = [...handles.subarray(4 * index, 4 * index + 3)] as Vector, parent = page.now.session?.joints[joint.parent]?.name ?? joint.name;
    text.value = make(joint.name, at, Math.max(2 * joint.radius, 0.01), parent);
    text.focus();
  });
  const enter = button(say('Do it'), add, { id: 'do-task' });
  const again = button(say('Do all again'), () => apply(wanted), { id: 'tasks-again' });
  const list = element('ul', { class: 'items', id: 'task-list', 'aria-label': say('Tasks'), 'aria-live': 'polite' });

  const titleOf = (task: string) => {
    const name = jointOf(task), joint = page.now.session?.joints.find((one) => one.name === name);
    return name === '' ? taskName(kindOf(task)) : say('{joint}: {task}', { joint: joint ? jointTitle(joint) : name, task: taskName(kindOf(task)) });
  };
  function row(task: string): HTMLElement {
    const found = outcomeOf(task), title = titleOf(task);
    const outcome = element('span', { class: found && !found.met ? 'outcome unmet' : 'outcome' }, found ? taskOutcome(found) : say('not in this pose'));
    const pick = element('button', { type: 'button', class: 'button pick', title: say('Change the text of this task: {task}', { task: title }) },
      element('span', { class: 'text' }, title), outcome);
    pick.addEventListener('click', () => {
      drop(task);
      text.value = task;
      text.focus();
    });
    return element('li', {}, pick, button('', () => drop(task), { icon: 'erase', label: say('Take this task out: {task}', { task: title }) }));
  }
  function show() {
    const { session } = page.now;
    list.replaceChildren(...wanted.map(row));
    list.hidden = wanted.length === 0;
    again.hidden = !session || wanted.every((task) => outcomeOf(task) !== undefined);
    stand.setAttribute('aria-pressed', String(wanted.includes(balance)));
  }
  page.watch(({ session, seconds, selected: joint }, before) => {
    const names = session?.joints.map(({ name }) => name).join('\n') ?? '';
    const asked = session?.tasks.map(({ task }) => task) ?? [];
    if (names !== skeleton || (asked.length > 0 && asked.join('\n') !== known)) wanted = asked;
    [skeleton, known] = [names, asked.join('\n')];
    if (session !== before.session) moment = seconds;
    look.disabled = ground.disabled = other.disabled = !session || joint === null;
    stand.disabled = enter.disabled = !session;
    if (session !== before.session || seconds !== before.seconds || list.childElementCount !== wanted.length) show();
  });
  show();
  return element('div', { class: 'body' },
    element('p', { class: 'hint-text' }, say('What the body shall do, all at once. Where you change the pose afterwards, ask for it again.')),
    element('div', { class: 'row' }, look, ground, stand),
    element('div', { class: 'row' }, other, text, enter),
    list, again);
}
