// Clips that play one after the other as one, in rows below the timeline: each begins before the one above it ends.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { number, say } from '../words/say';
import { chosenClip, shownSeconds, type Clip } from './moments';

const overlap = { first: 0.3, least: 0.1, most: 2, step: 0.1 }; // seconds

export function sequenceEditor(studio: Studio, page: PageStore): HTMLElement {
  const now = element('div', { class: 'now' });
  const root = element('div', { class: 'lanes spans', id: 'sequence', role: 'group', 'aria-label': say('Clips that follow each other') });
  let drawn: unknown = null;
  page.watch(({ session, seconds, sequence }) => {
    const clip = chosenClip(session);
    root.hidden = !sequence || !clip;
    if (root.hidden || !clip || !session) return;
    const end = shownSeconds(clip, seconds);
    now.style.setProperty('--at', String(seconds / end));
    if (drawn === session.clips) return;
    drawn = session.clips;
    const focused = document.activeElement?.closest<HTMLElement>('#sequence .lane')?.dataset['place'];
    const joined = document.activeElement?.id === 'then';
    root.replaceChildren(...partsOf(clip).map((_, place) => row(clip, place, end)), ending(clip, session.clips), now);
    if (focused) root.querySelector<HTMLElement>(`[data-place="${focused}"] .stand`)?.focus();
    if (joined) root.querySelector<HTMLElement>('#then')?.focus();
  });

  /** The sequence anew; a clip that is none becomes the beginning of a new one. */
  function join(clip: Clip, clips: string[], seconds: number) {
    void studio.run({ do: 'join_clips', clips, seconds, into: clip.sequence ? clip.name : '' });
  }

  function row(clip: Clip, place: number, end: number): HTMLElement {
    const parts = partsOf(clip), { clip: name, from, to } = parts[place]!;
    const label = button(name, () => studio.showMoment(from), { label: say('{clip}: to where it begins', { clip: name }) });
    const out = button('', () => join(clip, namesOf(clip).filter((_, i) => i !== place), secondsOf(clip)),
      { icon: 'erase', label: say('{clip} no longer follows', { clip: name }) });
    out.hidden = parts.length < 3;
    return element('div', { class: 'lane', 'data-place': place }, element('span', { class: 'label' }, label, out),
      element('span', { class: 'beat' }, bar(clip, place, end, `${number(from, 2)}\u2013${number(to, 2)}`)));
  }

  /** Dragged, or by arrow keys, all clips overlap more or less; the first lies where it does. */
  function bar(clip: Clip, place: number, end: number, when: string): HTMLElement {
    const { clip: name, from, to } = partsOf(clip)[place]!;
    const title = place === 0 ? say('{clip}: {when} s', { clip: name, when })
      : say('{clip}: {when} s; drag it, or press an arrow key, to overlap more or less', { clip: name, when });
    const made = element('button', { class: 'stand', type: 'button', title, 'aria-label': title });
    made.style.setProperty('--at', String(from / end));
    made.style.setProperty('--long', String((to - from) / end));
    if (place === 0) return made;
    const overlapBy = (seconds: number) => {
      const within = Math.min(overlap.most, Math.max(overlap.least, Math.round(seconds * 100) / 100));
      if (within !== secondsOf(clip)) join(clip, namesOf(clip), within);
    };
    made.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: overlap.step, ArrowRight: -overlap.step }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      overlapBy(secondsOf(clip) + step);
    });
    made.addEventListener('pointerdown', (down) => {
      if (down.button !== 0) return;
      made.setPointerCapture(down.pointerId);
      const { width } = made.parentElement!.getBoundingClientRect(), later = (x: number) => ((x - down.clientX) / width) * end;
      made.onpointermove = ({ clientX }) => made.style.setProperty('--at', String((from + later(clientX)) / end));
      const over = () => {
        made.onpointermove = made.onpointerup = made.onpointercancel = null;
        made.style.setProperty('--at', String(from / end));
      };
      made.onpointercancel = over;
      made.onpointerup = ({ clientX }) => {
        over();
        overlapBy(secondsOf(clip) - later(clientX));
      };
    });
    return made;
  }

  function ending(clip: Clip, clips: readonly Clip[]): HTMLElement {
    const then = element('select', { class: 'select', id: 'then', 'aria-label': say('A clip that follows') },
      element('option', { value: '' }, say('Then\u2026')),
      ...clips.filter(({ name, duration }) => duration > 0 && (!clip.sequence || name !== clip.name)).map(({ name }) => element('option', { value: name }, name)));
    then.addEventListener('change', () => {
      const name = then.value;
      then.value = '';
      if (name) join(clip, [...namesOf(clip), name], secondsOf(clip));
    });
    return element('div', { class: 'lane' }, then);
  }

  return root;
}

const partsOf = (clip: Clip) => clip.sequence?.clips ?? [{ clip: clip.name, from: 0, to: clip.duration }];
const namesOf = (clip: Clip) => partsOf(clip).map(({ clip: name }) => name);
const secondsOf = (clip: Clip) => clip.sequence?.seconds ?? overlap.first;
