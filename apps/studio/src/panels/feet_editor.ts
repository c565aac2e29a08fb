// While which foot of the clip's motion stands, in rows below the timeline: let go or held where it was found wrongly.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { partName } from '../words/parts';
import { number, say } from '../words/say';
import { chosenClip, shownSeconds, type Clip } from './moments';

type Foot = Clip['feet'][number];

const pressed = 0.2; // seconds that a press holds a foot for
const leastDrag = 4; // pixels: less is a press

export function feetEditor(studio: Studio, page: PageStore): HTMLElement {
  const now = element('div', { class: 'now' });
  const root = element('div', { class: 'lanes spans', id: 'feet', role: 'group', 'aria-label': say('Feet that stand') });
  const change = (foot: Foot, from: number, to: number, contact: 'planted' | 'free' | 'found') =>
    void studio.run({ do: 'set_contact', foot: foot.foot, from: Math.max(0, from), to, contact });
  let drawn: unknown = null;
  page.watch(({ session, seconds, feet }) => {
    const clip = chosenClip(session);
    root.hidden = !feet || !clip || clip.feet.length === 0;
    if (root.hidden || !clip) return;
    const end = shownSeconds(clip, seconds);
    now.style.setProperty('--at', String(seconds / end));
    if (drawn === clip) return;
    drawn = clip;
    const focused = document.activeElement?.closest<HTMLElement>('#feet .lane')?.dataset['part'];
    root.replaceChildren(...clip.feet.map((foot) => row(foot, clip.duration, end)), now);
    if (focused) root.querySelector<HTMLElement>(`[data-part="${CSS.escape(focused)}"] .label .button`)?.focus();
  });

  function row(foot: Foot, duration: number, end: number): HTMLElement {
    const name = foot.part ? partName(foot.part) : foot.foot;
    const around = (seconds: number) => change(foot, seconds - pressed / 2, Math.min(seconds + pressed / 2, duration), 'planted');
    const label = button(name, () => {
      const { seconds } = page.now, here = foot.planted.find(([from, to]) => from <= seconds && seconds <= to);
      if (here) change(foot, ...here, 'free');
      else around(seconds);
    }, { label: say('{foot}: stand or let go at this moment', { foot: name }) });
    const asFound = button('', () => change(foot, 0, duration, 'found'), { icon: 'reset', label: say('{foot}: as it was found', { foot: name }) });
    asFound.hidden = !foot.edited;
    const beat = element('span', { class: 'beat' }, ...foot.planted.map(([from, to]) => stand(foot, name, from, to, end)));
    beat.addEventListener('pointerdown', (down) => {
      if (down.target !== beat || down.button !== 0) return;
      beat.setPointerCapture(down.pointerId);
      const { left, width } = beat.getBoundingClientRect(), at = (x: number) => Math.min(Math.max(0, ((x - left) / width) * end), duration);
      const draft = element('i', { class: 'stand' });
      const between = (x: number) => [Math.min(at(down.clientX), at(x)), Math.max(at(down.clientX), at(x))] as const;
      beat.onpointermove = ({ clientX }) => {
        put(draft, ...between(clientX), end);
        beat.append(draft);
      };
      const over = () => {
        beat.onpointermove = beat.onpointerup = beat.onpointercancel = null;
        draft.remove();
      };
      beat.onpointercancel = over;
      beat.onpointerup = ({ clientX }) => {
        over();
        if (Math.abs(clientX - down.clientX) < leastDrag) around(at(clientX));
        else change(foot, ...between(clientX), 'planted');
      };
    });
    return element('div', { class: 'lane', 'data-part': foot.part ?? foot.foot }, element('span', { class: 'label' }, label, asFound), beat);
  }

  function stand(foot: Foot, name: string, from: number, to: number, end: number): HTMLElement {
    const title = say('{foot} stands from {from} to {to} s; press to let it go', { foot: name, from: number(from, 2), to: number(to, 2) });
    const made = element('button', { class: 'stand', type: 'button', title, 'aria-label': title });
    made.addEventListener('click', () => change(foot, from, to, 'free'));
    put(made, from, to, end);
    return made;
  }

  return root;
}

function put(element: HTMLElement, from: number, to: number, end: number) {
  element.style.setProperty('--at', String(from / end));
  element.style.setProperty('--long', String((to - from) / end));
}
