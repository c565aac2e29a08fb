// Weights painted with a brush.
import type { BrushSettings, PaintMode, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, choice, element } from '../ui/dom';

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
  const toggle = button('Paint weights', () => togglePainting(page), {
    icon: 'brush', keys: 'B', id: 'paint', label: 'Paint which parts of the surface the selected joint moves',
  });
  const mode = choice<PaintMode>('What the brush does', [
    { value: 'add', text: 'Add' }, { value: 'subtract', text: 'Take away', keys: 'Ctrl' }, { value: 'smooth', text: 'Smooth', keys: 'Shift' },
  ], (value) => setBrush(page, { mode: value }));
  const slider = (text: string, id: string, keys: string, change: (place: number) => void) => {
    const made = element('input', { type: 'range', id, min: 0, max: steps, step: 1, title: keys });
    made.addEventListener('input', () => change(made.valueAsNumber));
    return { made, row: element('div', { class: 'field' }, element('label', { for: id }, text), made) };
  };
  const size = slider('Size', 'brush-size', 'Width of the brush ([ and ])', (place) => setBrush(page, { size: toSize(place) }));
  const strength = slider('Strength', 'brush-strength', 'How much one stroke changes', (place) => setBrush(page, { strength: place / steps }));
  const both = element('input', { type: 'checkbox', id: 'paint-both-sides' });
  both.addEventListener('change', () => page.set({ bothSides: both.checked }));
  const mirror = (text: string, from: 'left' | 'right', label: string) => button(text,
    () => void studio.run({ do: 'mirror_weights', from }), { id: `mirror-weights-${from}`, label });
  const joint = element('p', { class: 'from' });
  const body = element('div', { class: 'body' }, joint, mode.root, size.row, strength.row,
    element('label', { class: 'check', title: 'The other side gets the same, for the joint there' }, both, 'Both sides'),
    element('div', { class: 'row' },
      mirror('Left to right', 'left', 'The right side takes the weights of the left side'),
      mirror('Right to left', 'right', 'The left side takes the weights of the right side')),
    element('p', { class: 'hint-text' }, 'Red moves with the joint, blue does not. Pick joints in the list, or with Alt and a click. Drag beside the model, with Alt or with two fingers to turn it.'));
  page.watch(({ session, painting, brush, bothSides, selected, display }) => {
    // Who looks at something else paints no longer.
    if (painting && (display === 'handles' || display === 'surface')) return page.set({ painting: false });
    toggle.disabled = !session;
    toggle.setAttribute('aria-pressed', String(painting));
    body.hidden = !painting;
    mode.show(brush.mode);
    size.made.valueAsNumber = toPlace(brush.size);
    strength.made.valueAsNumber = Math.round(steps * brush.strength);
    both.checked = bothSides;
    const name = session?.joints[selected ?? 0]?.name ?? '', locked = session?.locked.includes(selected ?? 0);
    joint.textContent = locked ? `${name} is locked` : name;
  });
  return element('section', { class: 'card paint', 'aria-label': 'Painting weights' }, toggle, body);
}
