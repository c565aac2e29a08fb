// The selected joint in numbers that can be typed: its rotation and scale from the rest pose, its position in the world.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Stance, Vector } from '../engine/messages';
import { element } from '../ui/dom';
import { jointTitle } from '../words/parts';
import { say, type Words } from '../words/say';

const degreeDigits = 1, scaleDigits = 2, minScale = 0.01;

/** Fields that show numbers and send them with one changed. */
interface Fields {
  root: HTMLElement;
  show(numbers: readonly number[] | null, digits: number): void;
}

interface FieldsOptions {
  text: Words;
  unit: string;
  id: string;
  /** What the fields are called; none where there is one alone. */
  axes?: readonly string[];
  /** Of an arrow key; with Shift a tenth of it. */
  step(): number;
  send(numbers: number[]): void;
}

function fieldsOf({ text, unit, id, axes = ['x', 'y', 'z'], step, send }: FieldsOptions): Fields {
  let shown: readonly number[] | null = null, digits = 0;
  const typed = new Set<HTMLInputElement>(); // not sent yet
  const inputs = axes.map((axis) => element('input', {
    type: 'number', step: 'any', id: axis ? `${id}-${axis}` : id, 'aria-label': axis ? `${say(text)} ${axis}, ${unit}` : say(text), autocomplete: 'off', disabled: true,
  }));
  const textOf = (value: number) => String(Number(value.toFixed(digits)) + 0); // no -0
  const fill = () => inputs.forEach((input, i) => {
    input.disabled = shown === null;
    if (!typed.has(input)) input.value = shown === null ? '' : textOf(shown[i]!);
  });
  const set = (i: number, value: number) => {
    typed.delete(inputs[i]!);
    if (shown && Number.isFinite(value) && textOf(value) !== textOf(shown[i]!)) send(shown.map((old, k) => (k === i ? value : old)));
    else fill();
  };
  inputs.forEach((input, i) => {
    input.addEventListener('input', () => typed.add(input));
    input.addEventListener('change', () => set(i, input.value === '' ? NaN : input.valueAsNumber));
    input.addEventListener('focus', () => input.select());
    input.addEventListener('keydown', (event) => {
      const by = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (by !== undefined && shown) {
        event.preventDefault();
        set(i, shown[i]! + by * step() * (event.shiftKey ? 0.1 : 1));
      } else if (event.key === 'Escape') {
        typed.delete(input);
        fill();
      }
    });
  });
  const fields = inputs.map((input, i) => element('label', { class: `number-field ${axes[i]!}` }, element('span', {}, axes[i] || unit), input));
  return {
    root: element('div', { class: 'triple', role: 'group', 'aria-label': say(text) }, element('span', { class: 'name' }, axes[0] ? `${say(text)} ${unit}` : say(text)), ...fields),
    show(numbers, wanted) {
      shown = numbers;
      digits = wanted;
      fill();
    },
  };
}

const three = (numbers: Float32Array, at: number): Vector => [numbers[at]!, numbers[at + 1]!, numbers[at + 2]!];

export function exactFields(studio: Studio, page: PageStore): HTMLElement {
  let stance: Stance | null = null;
  const step = () => page.now.session?.snap.step ?? 0.01;
  const act = (does: (joint: number, numbers: number[]) => Promise<void>) => (numbers: number[]) => {
    if (page.now.selected !== null) void does(page.now.selected, numbers);
  };
  const turn = fieldsOf({
    text: 'Turned', unit: '\u00b0', id: 'turn', step: () => (page.now.snapping ? page.now.session?.snap.degrees ?? 1 : 1),
    send: act((joint, vector) => studio.setTurn(joint, vector as Vector)),
  });
  const place = fieldsOf({ text: 'Place', unit: 'm', id: 'place', step, send: act((joint, vector) => studio.moveJointTo(joint, vector as Vector)) });
  const scale = fieldsOf({
    text: 'Scaled', unit: '\u00d7', id: 'scale', axes: [''], step: () => 0.1, send: act((joint, [factor = 1]) => studio.setScale(joint, Math.max(minScale, factor))),
  });
  const of = element('span', { class: 'number', id: 'exact-of' });
  const hint = element('p', { class: 'hint-text' });
  const root = element('details', { class: 'fold exact', id: 'exact' },
    element('summary', {}, say('Exact values'), ' ', of), turn.root, place.root, scale.root, hint);
  const show = () => {
    const { session, selected, also, correcting } = page.now;
    const none = !session || !stance || selected === null || correcting || stance.turns.length < 7 * (selected + 1);
    const name = none ? '' : jointTitle(session.joints[selected]);
    of.textContent = also.size > 0 && name !== '' ? `${name} + ${also.size}` : name;
    if (!root.open) return;
    // A tenth of the step that the magnet makes.
    turn.show(none ? null : three(stance!.turns, 7 * selected), degreeDigits);
    place.show(none ? null : three(stance!.handles, 4 * selected), Math.max(0, Math.ceil(1 - Math.log10(step()))));
    scale.show(none ? null : [stance!.scales[selected]!], scaleDigits);
    hint.textContent = say(none ? 'Select a joint first' : 'Turns, about the axes of the joint, and scales count from the rest pose');
  };
  root.addEventListener('toggle', show);
  page.watch(show);
  studio.readStance((now) => {
    stance = now;
    show();
  });
  return root;
}
