// What there is: meshes, clips, corrected and pinned joints, and the joints as a tree. What can be picked in the scene can be picked
// here.
import type { SessionState } from '../engine/messages';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { HandleView } from '../scene/handle_view';
import { counted } from '../ui/counted';
import { button, element } from '../ui/dom';
import { renameIn } from '../ui/rename';
import { jointActions } from './joint_actions';
import { clipList, meshList, pinList, targetList } from './outliner_lists';
import { partName } from '../words/parts';
import { say } from '../words/say';

export function outliner(studio: Studio, page: PageStore, handles: HandleView): HTMLElement {
  const list = element('ul', { class: 'joints', role: 'listbox', 'aria-label': say('Joints'), 'aria-multiselectable': 'true', tabindex: 0, id: 'joints' });
  const actions = element('div', { class: 'row actions' });
  const selectedJoint = () => page.now.selected ?? 0;
  const pin = button(say('Pin'), () => void studio.togglePin(selectedJoint(), handles.position(selectedJoint()).toArray()), {
    label: say('Hold this joint where it is, with limbs following'), keys: 'P', id: 'pin',
  });
  const reset = button(say('Reset'), () => void studio.resetJoint(selectedJoint()), { label: say('Put this joint back'), keys: 'Del', id: 'reset-joint' });
  const name = button(say('Rename'), () => rename(), { keys: 'F2', id: 'rename-joint' });
  actions.append(pin, reset, name);

  list.addEventListener('click', (event) => {
    const row = (event.target as Element).closest<HTMLElement>('[data-joint]');
    if (!row) return;
    const joint = Number(row.dataset['joint']);
    if (event.shiftKey || event.ctrlKey || event.metaKey || page.now.selecting) studio.selectAlso(joint);
    else page.set({ selected: joint, also: new Set() });
  });
  const rename = () => {
    const joint = page.now.selected, row = joint === null ? null : list.querySelector<HTMLElement>(`#joint-${joint}`);
    if (joint === null || !row) return;
    const before = page.now.session?.joints[joint]?.name ?? '';
    renameIn(row, say('Name of the joint'), before, (wanted) => void studio.renameJoint(joint, wanted));
  };
  list.addEventListener('dblclick', rename);
  list.addEventListener('keydown', (event) => {
    if (event.key === 'F2') {
      event.preventDefault();
      return rename();
    }
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const count = page.now.session?.joints.length ?? 0;
    if (by === undefined || count === 0) return;
    event.preventDefault();
    const from = page.now.selected ?? (by > 0 ? -1 : count);
    page.set({ selected: Math.max(0, Math.min(count - 1, from + by)) });
  });

  const title = element('h2', {}, say('Joints'));
  page.watch((now, before) => {
    const { session, selected, also } = now;
    title.textContent = session ? counted(session.joints.length, 'joint') : say('Joints');
    if (session && (session.joints !== before.session?.joints || list.childElementCount === 0)) {
      const known = before.session?.joints.map((joint) => joint.name).join('\n');
      if (list.childElementCount === 0 || known !== session.joints.map((joint) => joint.name).join('\n')) {
        list.replaceChildren(...rows(session));
      }
    }
    const pinned = new Set(now.pinned);
    for (const row of list.children as HTMLCollectionOf<HTMLElement>) {
      const joint = Number(row.dataset['joint']);
      row.setAttribute('aria-selected', String(joint === selected || also.has(joint)));
      const notes = [pinned.has(joint) ? say('pinned') : '', session?.locked.includes(joint) ? say('locked') : ''].filter((note) => note !== '');
      if (notes.length > 0) row.dataset['note'] = notes.join(', ');
      else delete row.dataset['note'];
      row.classList.toggle('pinned', pinned.has(joint));
      if (joint === selected && selected !== before.selected) {
        // The list alone scrolls: on a narrow screen the whole panel would jump.
        const above = row.offsetTop - list.offsetTop, below = above + row.offsetHeight - list.clientHeight;
        list.scrollTop = Math.min(above, Math.max(below, list.scrollTop));
        list.setAttribute('aria-activedescendant', row.id);
      }
    }
    // Another model may have fewer joints.
    const active = list.getAttribute('aria-activedescendant');
    if (active !== null && !list.querySelector(`#${active}`)) list.removeAttribute('aria-activedescendant');
    pin.disabled = reset.disabled = name.disabled = selected === null || !session;
    pin.setAttribute('aria-pressed', String(selected !== null && pinned.has(selected)));
  });
  return element('section', { class: 'card outliner', 'aria-label': say('Contents') },
    meshList(page), clipList(studio, page), pinList(studio, page), targetList(studio, page), title, list, actions, jointActions(studio, page));
}

const plain = (name: string) => name.toLowerCase().replace(/[^a-z0-9]/g, '');

/** In the order of the tree, each indented below its parent. */
function rows({ joints }: SessionState): HTMLElement[] {
  const children = new Map<number, number[]>();
  joints.forEach(({ parent }, joint) => children.set(parent, [...(children.get(parent) ?? []), joint]));
  const made: HTMLElement[] = [];
  const stack = [...(children.get(-1) ?? [])].reverse().map((joint) => ({ joint, depth: 0 }));
  for (let next = stack.pop(); next; next = stack.pop()) {
    const { joint, depth } = next;
    const { name = '', part = null } = joints[joint] ?? {};
    const row = element('li', { role: 'option', id: `joint-${joint}`, 'data-joint': joint, title: name }, name);
    if (part !== null && plain(part) !== plain(name)) row.dataset['part'] = partName(part);
    row.style.setProperty('--depth', String(Math.min(depth, 12)));
    made.push(row);
    for (const child of [...(children.get(joint) ?? [])].reverse()) stack.push({ joint: child, depth: depth + 1 });
  }
  return made;
}
