// The shorter lists of the outliner: meshes, pinned joints, clips.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { renameIn } from '../ui/rename';
import { jointTitle } from '../words/parts';
import { inSeconds, say } from '../words/say';
import { chosenClip } from './moments';

/** A list that folds; it goes away while it is empty. */
function group(title: string, id: string, open: boolean) {
  const list = element('ul', { class: 'items', id, 'aria-label': title });
  const count = element('span', { class: 'number' });
  const root = element('details', { class: 'fold', open }, element('summary', {}, `${title} `, count), list);
  return {
    root, list,
    show(rows: HTMLElement[]) {
      root.hidden = rows.length === 0;
      count.textContent = String(rows.length);
      list.replaceChildren(...rows);
    },
  };
}

export function meshList(page: PageStore): HTMLElement {
  const { root, show } = group(say('Parts of the model'), 'meshes', false);
  page.watch((now, before) => {
    if (now.model === before.model && now.hiddenParts === before.hiddenParts && now !== before) return;
    show((now.model?.parts ?? []).map(({ name }, part) => {
      const hidden = now.hiddenParts.has(part), text = name === '' ? say('mesh {number}', { number: part + 1 }) : name;
      const eye = button('', () => {
        const parts = new Set(page.now.hiddenParts);
        if (!parts.delete(part)) parts.add(part);
        page.set({ hiddenParts: parts });
      }, { icon: 'eye', label: say('Show {name}', { name: text }) });
      eye.setAttribute('aria-pressed', String(!hidden));
      const row = element('li', {}, element('span', { class: 'text' }, text), eye);
      row.classList.toggle('off', hidden);
      return row;
    }));
  });
  return root;
}

/** What a person calls it, with its name in the file beside. */
function jointPick(page: PageStore, known: { name: string; part: string | null } | undefined, joint: number): HTMLElement {
  const title = jointTitle(known), name = known?.name ?? '';
  const pick = button(title, () => page.set({ selected: joint }), { label: say('Select {joint}', { joint: title === name ? name : `${title}, ${name}` }) });
  pick.classList.add('joint-pick');
  if (title !== name) pick.append(element('span', { class: 'number' }, name));
  return pick;
}

export function targetList(studio: Studio, page: PageStore): HTMLElement {
  const { root, show } = group(say('Pinned joints'), 'targets', true);
  page.watch(({ session, pinned }, before) => {
    if (pinned === before.pinned && session !== null && session === before.session) return;
    show(pinned.map((joint) => {
      const known = session?.joints[joint], title = jointTitle(known);
      return element('li', {}, jointPick(page, known, joint), button('', () => void studio.clearTarget(joint), { icon: 'erase', label: say('Let go of {joint}', { joint: title }) }));
    }));
  });
  return root;
}

/** Joints of a template that the user corrected. */
export function pinList(studio: Studio, page: PageStore): HTMLElement {
  const { root, show } = group(say('Corrected joints'), 'pins', true);
  page.watch(({ session }, before) => {
    if (session?.pins === before.session?.pins && session !== null && session === before.session) return;
    show((session?.pins ?? []).map(({ joint }) => {
      const place = session!.joints.findIndex(({ name }) => name === joint), known = session!.joints[place] ?? { name: joint, part: null };
      return element('li', {}, jointPick(page, known, place), button('', () => void studio.unpinJoint(joint), { icon: 'erase', label: say('{joint} as it was found', { joint: jointTitle(known) }) }));
    }));
  });
  return root;
}

export function clipList(studio: Studio, page: PageStore): HTMLElement {
  const { root, list, show } = group(say('Clips'), 'clip-list', true);
  const rename = (row: HTMLElement) => {
    const name = row.dataset['clip'] ?? '';
    renameIn(row, say('Name of the clip'), name, (wanted) => void studio.renameClip(name, wanted));
  };
  list.addEventListener('dblclick', (event) => {
    const row = (event.target as Element).closest<HTMLElement>('[data-clip]');
    if (row) rename(row);
  });
  let drawn = '';
  page.watch(({ session }) => {
    const chosen = chosenClip(session);
    const now = JSON.stringify([session?.clips.map(({ name, duration }) => [name, duration]), chosen?.name]);
    if (now === drawn) return;
    drawn = now;
    show((session?.clips ?? []).map(({ name, duration }) => {
      const pick = element('button', { type: 'button', class: 'button pick', 'aria-pressed': String(name === chosen?.name) },
        element('span', { class: 'text' }, name), element('span', { class: 'number' }, inSeconds(duration, 1)));
      pick.addEventListener('click', () => {
        if (chosenClip(page.now.session)?.name !== name) void studio.chooseClip(name);
      });
      const row = element('li', { 'data-clip': name }, pick,
        button('', () => rename(row), { icon: 'edit', label: say('Rename {name}', { name }) }));
      return row;
    }));
  });
  return root;
}
