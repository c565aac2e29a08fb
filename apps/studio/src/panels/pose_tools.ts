// What is at hand beside the model while it is posed: several joints at once, the magnet, and whose axes arrows have.
import { remember, remembered } from '../app/remembered';
import type { GizmoSpace, PageStore } from '../app/state';
import { button, element } from '../ui/dom';
import { say, type Words } from '../words/say';

const spaces: { value: GizmoSpace; text: Words; label: Words }[] = [
  { value: 'world', text: 'Axes: world', label: 'As the ground lies' },
  { value: 'parent', text: 'Axes: joint above', label: 'Those of the joint that this one hangs on' },
  { value: 'local', text: 'Axes: its own', label: 'Those of the joint itself' },
  { value: 'view', text: 'Axes: view', label: 'Across, up and towards you' },
];

export function toggleSelecting(page: PageStore) {
  const selecting = !page.now.selecting;
  page.set(selecting ? { selecting, painting: false, placing: false, display: 'handles' } : { selecting });
}

export function poseTools(page: PageStore): HTMLElement {
  const select = button('', () => toggleSelecting(page), {
    icon: 'select', id: 'select-several', keys: 'V', label: say('Select several joints: tap them or draw a box'),
  });
  const magnet = button('', () => page.set({ snapping: !page.now.snapping }), {
    icon: 'magnet', id: 'magnet', keys: 'N', label: say('Magnet: move in round steps and turn in steps of 15 degrees; feet find the floor'),
  });
  const told = element('output', { class: 'told', id: 'selected-told' });
  const space = element('select', { class: 'select', id: 'gizmo-space', 'aria-label': say('Axes of the arrows and rings'), title: say('Axes of the arrows and rings') },
    ...spaces.map(({ value, text, label }) => element('option', { value, title: say(label) }, say(text))));
  page.set({ gizmoSpace: remembered('gizmo-space', spaces.map(({ value }) => value), 'world') });
  space.addEventListener('change', () => {
    const { value = 'world' } = spaces.find(({ value: known }) => known === space.value) ?? {};
    remember('gizmo-space', value);
    page.set({ gizmoSpace: value });
  });
  const root = element('div', { class: 'pose-tools', role: 'group', 'aria-label': say('Posing tools') }, select, magnet, space, told);
  page.watch(({ session, selecting, snapping, gizmo, gizmoSpace, selected, also, display }) => {
    if (selecting && display !== 'handles') return page.set({ selecting: false });
    select.disabled = magnet.disabled = !session;
    select.setAttribute('aria-pressed', String(selecting));
    magnet.setAttribute('aria-pressed', String(snapping));
    space.hidden = !gizmo || display !== 'handles';
    space.value = gizmoSpace;
    const count = selected === null ? 0 : 1 + also.size;
    told.hidden = !selecting && count < 2;
    told.textContent = count === 0 ? say('Tap joints or draw a box') : say('{count} selected', { count });
  });
  return root;
}
