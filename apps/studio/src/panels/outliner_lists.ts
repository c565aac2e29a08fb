// The shorter lists of the outliner: meshes, pinned joints, clips.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { renameIn } from '../ui/rename';
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
  const { root, show } = group('Meshes', 'meshes', false);
  page.watch((now, before) => {
    if (now.model === before.model && now.hiddenParts === before.hiddenParts && now !== before) return;
    show((now.model?.parts ?? []).map(({ name }, part) => {
      const hidden = now.hiddenParts.has(part), text = name === '' ? `mesh ${part + 1}` : name;
      const eye = button('', () => {
        const parts = new Set(page.now.hiddenParts);
        if (!parts.delete(part)) parts.add(part);
        page.set({ hiddenParts: parts });
      }, { icon: 'eye', label: `Show ${text}` });
      eye.setAttribute('aria-pressed', String(!hidden));
      const row = element('li', {}, element('span', { class: 'text' }, text), eye);
      row.classList.toggle('off', hidden);
      return row;
    }));
  });
  return root;
}

export function targetList(studio: Studio, page: PageStore): HTMLElement {
  const { root, show } = group('Pinned joints', 'targets', true);
  page.watch(({ session }, before) => {
    if (session?.targets === before.session?.targets && session !== null && session === before.session) return;
    show((session?.targets ?? []).map(({ joint }) => {
      const name = session?.joints[joint]?.name ?? '';
      const pick = button(name, () => page.set({ selected: joint }), { label: `Select ${name}` });
      return element('li', {}, pick, button('', () => void studio.clearTarget(joint), { icon: 'erase', label: `Let go of ${name}` }));
    }));
  });
  return root;
}

/** Joints of a template that the user corrected. */
export function pinList(studio: Studio, page: PageStore): HTMLElement {
  const { root, show } = group('Corrected joints', 'pins', true);
  page.watch(({ session }, before) => {
    if (session?.pins === before.session?.pins && session !== null && session === before.session) return;
    show((session?.pins ?? []).map(({ joint }) => {
      const pick = button(joint, () => page.set({ selected: session!.joints.findIndex(({ name }) => name === joint) }), { label: `Select ${joint}` });
      return element('li', {}, pick, button('', () => void studio.unpinJoint(joint), { icon: 'erase', label: `${joint} as it was found` }));
    }));
  });
  return root;
}

export function clipList(studio: Studio, page: PageStore): HTMLElement {
  const { root, list, show } = group('Clips', 'clip-list', true);
  const rename = (row: HTMLElement) => {
    const name = row.dataset['clip'] ?? '';
    renameIn(row, 'Name of the clip', name, (wanted) => void studio.renameClip(name, wanted));
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
        element('span', { class: 'text' }, name), element('span', { class: 'number' }, `${duration.toFixed(1)} s`));
      pick.addEventListener('click', () => {
        if (chosenClip(page.now.session)?.name !== name) void studio.chooseClip(name);
      });
      const row = element('li', { 'data-clip': name }, pick,
        button('', () => rename(row), { icon: 'edit', label: `Rename ${name}` }));
      return row;
    }));
  });
  return root;
}
