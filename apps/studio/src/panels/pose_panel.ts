// How handles are moved, how many there are, and how the model is shown.
import type { PoseShelf } from '../app/pose_shelf';
import type { Display, DragMode, PageState, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { jointColor } from '../scene/palette';
import type { Viewport } from '../scene/viewport';
import { counted } from '../ui/counted';
import { button, choice, element } from '../ui/dom';
import { arriving } from '../ui/loaded_when_opened';
import { partName } from '../words/parts';
import { say } from '../words/say';
import { exactFields } from './exact_fields';
import { followSwitch } from './follow_switch';

const mostHandles = 200;

export function posePanel(studio: Studio, page: PageStore, poses: PoseShelf, viewport: Viewport): HTMLElement {
  const mode = choice<DragMode>(say('What dragging a handle does'), [
    { value: 'move', text: say('Move'), icon: 'move', keys: 'G' },
    { value: 'turn', text: say('Turn'), icon: 'turn', keys: 'R' },
    { value: 'scale', text: say('Scale'), icon: 'scale', keys: 'Shift+S' },
  ], (value) => page.set({ mode: value }));
  const follow = followSwitch(studio, 'follow');
  const both = button(say('Both sides'), () => page.set({ bothSides: !page.now.bothSides }), {
    keys: 'S', label: say('What is dragged on one side is done on the other as well'), id: 'both-sides',
  });
  const mirror = button(say('Mirror'), () => void studio.mirrorPose(), { keys: 'M', label: say('Swap the pose of left and right'), id: 'mirror' });
  const reset = button(say('Reset'), () => void studio.resetPose(), { keys: 'Alt+R', label: say('Put all joints back'), id: 'reset' });
  const rest = button(say('New rest pose'), () => void studio.setRestPose(), { label: say('The pose becomes the one that the model rests in'), id: 'rest-pose' });
  const copy = button(say('Copy'), () => void poses.copy(), { keys: 'Ctrl+C', label: say('Copy the pose'), id: 'copy-pose' });
  const paste = button(say('Paste'), () => void poses.paste(), {
    keys: 'Ctrl+V', label: say('Paste the pose that was copied: at another moment, or on another model'), id: 'paste-pose',
  });
  const library = button(say('Poses'), () => page.set({ poseLibrary: true }), { label: say('Poses to put the model into, and your own'), id: 'open-poses' });
  const display = choice<Display>(say('What is shown'), [
    { value: 'handles', text: say('Handles') }, { value: 'surface', text: say('Surface'), label: say('The model alone') },
    { value: 'weights', text: say('Areas'), label: say('Which area each joint moves (weights), each in its colour') },
    { value: 'joint-weights', text: say('By joint'), label: say('What the selected joint moves (weights): red much, blue nothing') },
    { value: 'parts', text: say('Limbs'), label: say('The limbs of the model as the weights have them, each in its colour') },
    { value: 'stretch', text: say('Stretching'), label: say('How far the surface is stretched or squeezed: red is twice as long or half, blue as at rest') },
  ], (value) => page.set({ display: value }));
  const toggle = (text: string, key: 'bones' | 'wireframe' | 'gizmo' | 'limits', title = text) => {
    const box = element('input', { type: 'checkbox', id: key });
    box.addEventListener('change', () => page.set({ [key]: box.checked }));
    page.watch((now) => { box.checked = now[key]; });
    return element('label', { class: 'check', title }, box, text);
  };
  page.watch(({ session, mode: nowMode, display: nowDisplay, bothSides, copiedPose }) => {
    mode.show(nowMode);
    display.show(nowDisplay);
    follow.show(session);
    both.setAttribute('aria-pressed', String(bothSides));
    both.disabled = mirror.disabled = !session;
    copy.disabled = library.disabled = !session;
    paste.disabled = !session || copiedPose === null;
    reset.disabled = rest.disabled = !session?.posed;
  });
  return element('section', { class: 'card pose', 'aria-label': say('Posing') },
    handleCount(studio, page),
    element('div', { class: 'row' }, mode.root),
    element('div', { class: 'row' }, follow.root),
    element('div', { class: 'row' }, both, mirror),
    element('div', { class: 'row' }, reset, rest),
    element('div', { class: 'row' }, copy, paste, library),
    display.root, legend(page),
    element('div', { class: 'row checks' }, toggle(say('Bones'), 'bones'), toggle(say('Mesh lines'), 'wireframe'),
      toggle(say('Arrows'), 'gizmo', say('Arrows, rings or boxes on the selected joint, for exact work (gizmo)')),
      toggle(say('Limits'), 'limits', say('How far joints may turn'))),
    limits(studio, page), exactFields(studio, page), tasks(studio, page, viewport));
}

/** What the parts that are shown are called, each beside its colour. */
function legend(page: PageStore): HTMLElement {
  const list = element('ul', { class: 'part-names', id: 'legend', 'aria-label': say('Limbs') });
  page.watch(({ display, parts }, before) => {
    list.hidden = display !== 'parts' || !parts;
    if (parts === before.parts) return;
    list.replaceChildren(...(parts?.names ?? []).map((name, part) => {
      const swatch = element('span', { class: 'swatch' });
      swatch.style.background = jointColor(part).getStyle();
      return element('li', {}, swatch, element('span', {}, partName(name)));
    }));
  });
  return list;
}

/** Its code comes when it is first opened. */
function tasks(studio: Studio, page: PageStore, viewport: Viewport): HTMLElement {
  const root = element('details', { class: 'fold tasks', id: 'tasks' }, element('summary', {}, say('Tasks')));
  let asked = false;
  root.addEventListener('toggle', () => {
    if (!root.open || asked) return;
    asked = true;
    void studio.guard(() => arriving(import('./tasks_panel'))).then((code) => {
      if (code) return root.append(code.tasksPanel(studio, page, viewport));
      asked = root.open = false;
    });
  });
  return root;
}

/** How far joints may turn: a file of limits; what is shown where there are none. */
function limits(studio: Studio, page: PageStore): HTMLElement {
  const file = element('input', { type: 'file', accept: '.json', hidden: true, id: 'limits-file' });
  file.addEventListener('change', () => {
    const chosen = file.files?.[0];
    if (chosen) void studio.openLimits(chosen);
    file.value = '';
  });
  const open = button(say('Load limits'), () => file.click(), { icon: 'open', label: say('How far joints may turn (JSON)'), id: 'load-limits' });
  const remove = button(say('Remove'), () => void studio.run({ do: 'set_limits', limits: '' }), { id: 'remove-limits' });
  const row = element('div', { class: 'row' }, file, open, remove);
  page.watch(({ session, limits: shown }) => {
    row.hidden = !shown || !session;
    remove.disabled = !session?.limited;
  });
  return row;
}

export const mostHandlesOf = ({ session }: PageState) => Math.max(2, Math.min(mostHandles, session?.most_handles ?? mostHandles));

/** The slider runs evenly over the logarithm of the count: few handles differ more than many. */
export function handleCount(studio: Studio, page: PageStore): HTMLElement {
  const steps = 1000;
  const toCount = (place: number) => Math.round(mostHandlesOf(page.now) ** (place / steps));
  const toPlace = (count: number) => Math.round((steps * Math.log(Math.max(1, count))) / Math.log(mostHandlesOf(page.now)));

  const number = element('output', { class: 'count', for: 'handles' }, '0');
  const slider = element('input', { type: 'range', id: 'handles', min: 0, max: steps, step: 1 });
  slider.addEventListener('input', () => {
    const count = toCount(slider.valueAsNumber);
    number.textContent = String(count);
    slider.setAttribute('aria-valuetext', counted(count, 'handle'));
    void studio.setHandles(count);
  });
  const step = (by: number) => {
    const count = Math.max(1, Math.min(mostHandlesOf(page.now), studio.handleCount() + by));
    slider.valueAsNumber = toPlace(count);
    number.textContent = String(count);
    void studio.setHandles(count);
  };
  // A step of the keyboard is a handle more or less.
  slider.addEventListener('keydown', (event) => {
    const by = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    step(by);
  });
  const fewer = button('\u2212', () => step(-1), { label: say('One handle fewer'), id: 'fewer-handles' });
  const more = button('+', () => step(1), { label: say('One handle more'), id: 'more-handles' });
  for (const each of [fewer, more]) each.classList.add('step');
  const marks = element('div', { class: 'marks', role: 'group', 'aria-label': say('Suggested numbers of handles') });
  let marked = '';
  page.watch((now) => {
    slider.disabled = fewer.disabled = more.disabled = !now.session;
    if (!now.session) return;
    const { joints, suggestions } = now.session;
    if (!studio.settingHandles()) {
      number.textContent = String(joints.length);
      slider.valueAsNumber = toPlace(studio.handleCount());
      slider.setAttribute('aria-valuetext', counted(joints.length, 'handle'));
    }
    if (`${suggestions} ${mostHandlesOf(now)}` === marked) return;
    marked = `${suggestions} ${mostHandlesOf(now)}`;
    marks.replaceChildren(...apart(suggestions.map((count) => ({ count, at: toPlace(count) / steps }))).map(({ count, at }) => {
      const mark = button(String(count), () => void studio.setHandles(count), {
        label: say(suggestions[0] === count ? '{handles}, the best suggestion' : '{handles}, suggested', { handles: counted(count, 'handle') }),
      });
      mark.classList.add('mark');
      mark.classList.toggle('best', suggestions[0] === count);
      mark.style.setProperty('--at', String(at));
      return mark;
    }));
  });
  return element('div', { class: 'handle-count' },
    element('div', { class: 'row spread' }, element('label', { for: 'handles' }, say('Handles')), element('span', { class: 'number' }, fewer, number, more)), slider, marks);
}

/** The best of them that have room beside each other on the scale, in their order on it. */
function apart<T extends { at: number }>(marks: T[]): T[] {
  const kept: T[] = [], room = 0.07 * parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
  for (const mark of marks) {
    if (kept.every(({ at }) => Math.abs(at - mark.at) > room)) kept.push(mark);
  }
  return kept.sort((a, b) => a.at - b.at);
}
