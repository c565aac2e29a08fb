// Keys of each joint in rows over time: chosen one by one or with a box, moved, scaled, copied.
import { changedTime, extentOf, frame, keysOf, onFrame, sameKey, type KeyChange } from '../app/keys';
import type { KeyPlace, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { SessionState } from '../engine/messages';
import { element } from '../ui/dom';
import type { KeyActions } from './key_actions';
import { jointTitle } from '../words/parts';
import { say } from '../words/say';
import { shownSeconds } from './moments';

const inset = 8; // pixels left and right of the first and last moment, as the slider above has them
const farthestOut = 1, nearest = 16, zoomStep = 2; // times as wide as the panel
const leastDrag = 4; // pixels: less is a click

/** What the pointer does since it went down. */
type Gesture =
  | { kind: 'box'; x: number; y: number; before: readonly KeyPlace[] }
  | { kind: 'move'; x: number; grabbed: number }
  | { kind: 'scale'; x: number; grabbed: number; pivot: number };

export interface DopeSheet {
  root: HTMLElement;
  /** Nearer (1) or farther (-1), round the moment that is shown. */
  zoom(by: 1 | -1): void;
  canZoom(by: 1 | -1): boolean;
}

export function dopeSheet(studio: Studio, page: PageStore, actions: KeyActions): DopeSheet {
  const lanes = element('div', {
    class: 'lanes', id: 'dope-sheet', role: 'application', tabindex: 0,
    'aria-label': say('Keys of each joint. Up and down choose a joint, Enter its key next to the playhead, left and right move the chosen keys by a frame.'),
  });
  const sheet = element('div', { class: 'sheet' });
  lanes.append(sheet);
  const box = element('div', { class: 'box', hidden: true }), now = element('div', { class: 'now' });
  const grips = (['first', 'last'] as const).map((end) => element('i', { class: `grip ${end}`, 'data-end': end, title: say('Drag to scale the chosen keys in time') }));
  const empty = element('p', { class: 'empty-keys' }, say('No keys yet. Pose the model: what is posed becomes a key here.'));
  let rows: HTMLElement[] = [], marks: { mark: HTMLElement; keys: KeyPlace[] }[] = [];
  let drawn: unknown = null, end = 1, gesture: Gesture | null = null, dragged = false, near = farthestOut;

  const laneWidth = () => {
    const label = lanes.querySelector<HTMLElement>('.label')?.offsetWidth ?? 0;
    return Math.max(1, sheet.clientWidth - label - 2 * inset);
  };
  const secondsPerPixel = () => end / laneWidth();
  const at = (element: HTMLElement, seconds: number) => element.style.setProperty('--at', String(seconds / end));
  const choose = (keys: readonly KeyPlace[]) => page.set({ chosenKeys: keys });
  const isChosen = (key: KeyPlace) => page.now.chosenKeys.some((other) => sameKey(other, key));

  const rebuild = (session: SessionState) => {
    const clip = session.clips[session.clip ?? -1];
    const of = (joint: number) => session.joints[joint];
    const listed = clip?.joint_keys ?? [];
    marks = [];
    const markOf = (keys: KeyPlace[]) => {
      const mark = element('i', { class: 'key', 'data-time': keys[0]!.seconds });
      marks.push({ mark, keys });
      return mark;
    };
    const row = (label: string, joint: number | null, keys: KeyPlace[][]) =>
      element('div', { class: 'lane', 'data-joint': joint }, element('span', { class: 'label', title: label }, label),
        element('span', { class: 'beat' }, ...keys.map(markOf)));
    const all = keysOf(session);
    rows = [
      row(say('All joints'), null, (clip?.keys ?? []).map((seconds) => all.filter((key) => Math.abs(key.seconds - seconds) < 1e-3)).filter((keys) => keys.length > 0)),
      ...listed.map(({ joint, seconds }) => row(jointTitle(of(joint)), joint, seconds.map((moment) => [{ joint, seconds: moment }]))),
    ];
    sheet.replaceChildren(...(listed.length > 0 ? rows : [empty]), now, box, ...grips);
  };
  const place = (change: KeyChange = {}) => {
    const { chosenKeys } = page.now;
    for (const { mark, keys } of marks) {
      const chosen = keys.every(isChosen);
      mark.classList.toggle('chosen', chosen);
      at(mark, chosen ? changedTime(keys[0]!.seconds, change) : keys[0]!.seconds);
    }
    const [first, last] = extentOf(chosenKeys), wide = chosenKeys.length > 1 && last - first > frame / 2;
    grips.forEach((grip, i) => {
      grip.hidden = !wide;
      if (wide) at(grip, changedTime(i === 0 ? first : last, change));
    });
  };

  const changeOf = (x: number): KeyChange => {
    const { chosenKeys } = page.now;
    if (!gesture || gesture.kind === 'box' || chosenKeys.length === 0) return {};
    const target = onFrame(gesture.grabbed + (x - gesture.x) * secondsPerPixel());
    const [first] = extentOf(chosenKeys);
    if (gesture.kind === 'move') return { shift: Math.max(target - gesture.grabbed, -first) };
    const { pivot, grabbed } = gesture, side = Math.sign(grabbed - pivot);
    return { pivot, scale: Math.max(frame, side * (Math.max(0, target) - pivot)) / Math.abs(grabbed - pivot) };
  };
  const boxed = (event: PointerEvent, { x, y, before }: Gesture & { kind: 'box' }) => {
    const [left, right] = [Math.min(x, event.clientX), Math.max(x, event.clientX)], [top, bottom] = [Math.min(y, event.clientY), Math.max(y, event.clientY)];
    const outer = sheet.getBoundingClientRect();
    Object.assign(box.style, {
      left: `${left - outer.left}px`, top: `${top - outer.top}px`, width: `${right - left}px`, height: `${bottom - top}px`,
    });
    box.hidden = false;
    const inside = marks.filter(({ mark }) => {
      const { x: from, width, y: above, height } = mark.getBoundingClientRect();
      const [middle, center] = [from + width / 2, above + height / 2];
      return middle >= left && middle <= right && center >= top && center <= bottom;
    }).flatMap(({ keys }) => keys);
    choose([...before, ...inside.filter((key) => !before.some((other) => sameKey(other, key)))]);
  };

  lanes.addEventListener('pointerdown', (event) => {
    const target = event.target as HTMLElement, label = target.closest<HTMLElement>('.label');
    if (event.button !== 0) return;
    if (label) {
      const joint = label.parentElement?.dataset['joint'];
      return joint === undefined ? actions.chooseAll() : page.set({ selected: Number(joint) });
    }
    const { chosenKeys } = page.now, [first, last] = extentOf(chosenKeys);
    const hit = marks.find(({ mark }) => mark === target)?.keys, grip = target.dataset['end'];
    dragged = false;
    if (hit) {
      const before = hit.every(isChosen);
      if (event.shiftKey) choose(before ? chosenKeys.filter((key) => !hit.some((other) => sameKey(key, other))) : [...chosenKeys, ...hit]);
      else if (!before) choose(hit);
      const grabbed = hit[0]!.seconds;
      gesture = event.altKey && chosenKeys.length > 1 && last > first
        ? { kind: 'scale', x: event.clientX, grabbed, pivot: Math.abs(grabbed - first) < Math.abs(grabbed - last) ? last : first }
        : { kind: 'move', x: event.clientX, grabbed };
    } else if (grip) {
      gesture = grip === 'first' ? { kind: 'scale', x: event.clientX, grabbed: first, pivot: last } : { kind: 'scale', x: event.clientX, grabbed: last, pivot: first };
    } else {
      gesture = { kind: 'box', x: event.clientX, y: event.clientY, before: event.shiftKey ? chosenKeys : [] };
    }
    lanes.focus({ preventScroll: true });
    lanes.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  lanes.addEventListener('pointermove', (event) => {
    if (!gesture) return;
    const far = Math.hypot(event.clientX - gesture.x, gesture.kind === 'box' ? event.clientY - gesture.y : 0);
    dragged ||= far > leastDrag;
    if (!dragged) return;
    if (gesture.kind === 'box') boxed(event, gesture);
    else place(changeOf(event.clientX));
  });
  const finish = (act: boolean) => (event: PointerEvent) => {
    const done = gesture, change = changeOf(event.clientX);
    gesture = null;
    box.hidden = true;
    if (!done) return;
    const still = change.shift === 0 || change.scale === 1;
    if (!act || done.kind === 'box' || still || !dragged) {
      if (act && done.kind === 'box' && !dragged && !event.shiftKey) choose([]);
      return place();
    }
    void studio.editKeys(page.now.chosenKeys, change);
  };
  lanes.addEventListener('pointerup', finish(true));
  lanes.addEventListener('pointercancel', finish(false));

  const showNow = () => {
    const label = lanes.querySelector<HTMLElement>('.label')?.offsetWidth ?? 0, room = lanes.clientWidth - label - 2 * inset;
    const from = now.offsetLeft - label - inset;
    if (from < lanes.scrollLeft || from > lanes.scrollLeft + room) lanes.scrollLeft = from - room / 2;
  };
  const canZoom = (by: 1 | -1) => (by > 0 ? near < nearest : near > farthestOut);
  const zoom = (by: 1 | -1) => {
    if (!canZoom(by)) return;
    near *= zoomStep ** by;
    sheet.style.setProperty('--near', String(near));
    lanes.scrollLeft = 0;
    showNow();
    page.set({}); // buttons show whether there is more
  };
  lanes.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    if (event.deltaY !== 0) zoom(event.deltaY < 0 ? 1 : -1);
  }, { passive: false });

  const plain: Record<string, () => void> = {
    ArrowLeft: () => actions.move(-1), ArrowRight: () => actions.move(1), Delete: () => actions.remove(), Backspace: () => actions.remove(),
    ArrowUp: () => step(-1), ArrowDown: () => step(1), Enter: () => chooseNearest(),
    '+': () => zoom(1), '-': () => zoom(-1),
  };
  const withControl: Record<string, () => void> = { c: () => actions.copy(), v: () => void actions.paste(), a: () => actions.chooseAll() };
  lanes.addEventListener('keydown', (event) => {
    const control = event.ctrlKey || event.metaKey;
    if (event.altKey || (event.key === 'Escape' && page.now.chosenKeys.length === 0)) return;
    const act = event.key === 'Escape' ? () => choose([]) : (control ? withControl : plain)[event.key];
    if (!act) return;
    act();
    event.preventDefault();
    event.stopPropagation();
  });
  const joints = () => rows.map(({ dataset }) => dataset['joint']).filter((joint) => joint !== undefined).map(Number);
  const step = (by: number) => {
    const all = joints(), from = all.indexOf(page.now.selected ?? -1);
    const next = all[Math.max(0, Math.min(all.length - 1, from < 0 ? 0 : from + by))];
    if (next !== undefined) page.set({ selected: next });
  };
  const chooseNearest = () => {
    const { selected, seconds, session } = page.now;
    const own = keysOf(session).filter(({ joint }) => joint === selected);
    const away = (key: KeyPlace) => Math.abs(key.seconds - seconds);
    if (own.length > 0) choose([own.reduce((best, key) => (away(key) < away(best) ? key : best))]);
  };

  page.watch((state, before) => {
    const { session, seconds, keyEditor, selected } = state;
    const clip = session?.clips[session.clip ?? -1];
    if (!session || !clip || keyEditor !== 'sheet') {
      drawn = null;
      return;
    }
    end = shownSeconds(clip, seconds);
    if (drawn !== session) rebuild(session);
    if (drawn !== session || state.chosenKeys !== before.chosenKeys) place();
    drawn = session;
    at(now, seconds);
    if (near > farthestOut && seconds !== before.seconds) showNow();
    for (const row of rows) {
      const own = row.dataset['joint'] !== undefined && Number(row.dataset['joint']) === selected;
      if (own && !row.classList.contains('selected')) row.scrollIntoView({ block: 'nearest' });
      row.classList.toggle('selected', own);
    }
  });
  return { root: lanes, zoom, canZoom };
}
