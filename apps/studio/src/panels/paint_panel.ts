// Weights painted with a brush.
import type { BrushSettings, PaintMode, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, choice, element } from '../ui/dom';
import { jointTitle } from '../words/parts';
import { say } from '../words/say';

const steps = 100;
const [least, most] = [0.01, 0.4]; // the brush's radius, of the model's longest side
const toSize = (place: number) => least * (most / least) ** (place / steps);
const toPlace = (size: number) => Math.round((steps * Math.log(size / least)) / Math.log(most / least));

export function setBrush(page: PageStore, change: Partial<BrushSettings>) {
  page.set({ brush: { ...page.now.brush, ...change } });
}

/** Larger, above 1, or smaller. */
export function resizeBrush(page: PageStore, times: number) {
  setBrush(page, { size: Math.min(most, Math.max(least, page.now.brush.size * times)) });
}

export function togglePainting(page: PageStore) {
  const { painting, selected, session } = page.now;
  if (!session) return;
  if (painting) return page.set({ painting: false, display: 'handles' });
  page.set({ painting: true, playing: false, correcting: false, placing: false, display: 'joint-weights', selected: selected ?? 0 });
}

export function paintPanel(studio: Studio, page: PageStore): HTMLElement {
  const toggle = button(say('Paint areas'), () => togglePainting(page), {
    icon: 'brush', keys: 'B', id: 'paint', label: say('Paint weights: which parts of the surface the selected joint moves'),
  });
  const mode = choice<PaintMode>(say('What the brush does'), [
    { value: 'add', text: say('Add') }, { value: 'subtract', text: say('Take away'), keys: 'Ctrl' }, { value: 'smooth', text: say('Smooth'), keys: 'Shift' },
  ], (value) => setBrush(page, { mode: value }));
  const slider = (text: string, id: string, keys: string, change: (place: number) => void) => {
    const made = element('input', { type: 'range', id, min: 0, max: steps, step: 1, title: keys });
    made.addEventListener('input', () => change(made.valueAsNumber));
    return { made, row: element('div', { class: 'field' }, element('label', { for: id }, text), made) };
  };
  const size = slider(say('Size'), 'brush-size', say('Width of the brush ([ and ])'), (place) => setBrush(page, { size: toSize(place) }));
  const strength = slider(say('Strength'), 'brush-strength', say('How much one stroke changes'), (place) => setBrush(page, { strength: place / steps }));
  const both = element('input', { type: 'checkbox', id: 'paint-both-sides' });
  both.addEventListener('change', () => page.set({ bothSides: both.checked }));
  const mirror = (text: string, from: 'left' | 'right', label: string) => button(text,
    () => void studio.run({ do: 'mirror_weights', from }), { id: `mirror-weights-${from}`, label });
  const joint = element('p', { class: 'from' });
  const body = element('div', { class: 'body' }, joint, mode.root, size.row, strength.row,
    element('label', { class: 'check', title: say('The other side gets the same, for the joint there') }, both, say('Both sides')),
    element('div', { class: 'row' },
      mirror(say('Left to right'), 'left', say('The right side takes the weights of the left side')),
      mirror(say('Right to left'), 'right', say('The left side takes the weights of the right side'))),
    element('p', { class: 'hint-text' }, say('Red moves with the joint, blue does not. Pick joints in the list, or with Alt and a click. Drag beside the model, with Alt or with two fingers to turn it.')));
  page.watch(({ session, painting, brush, bothSides, selected, display }) => {
    // Who looks at something else paints no longer.
    if (painting && display !== 'weights' && display !== 'joint-weights') return page.set({ painting: false });
    toggle.disabled = !session;
    toggle.setAttribute('aria-pressed', String(painting));
    body.hidden = !painting;
    mode.show(brush.mode);
    size.made.valueAsNumber = toPlace(brush.size);
    strength.made.valueAsNumber = Math.round(steps * brush.strength);
    both.checked = bothSides;
    const name = jointTitle(session?.joints[selected ?? 0]), locked = session?.locked.includes(selected ?? 0);
    joint.textContent = locked ? say('{name} is locked', { name }) : name;
  });
  return element('section', { class: 'card paint', 'aria-label': say('Painting weights') }, toggle, body);
}
