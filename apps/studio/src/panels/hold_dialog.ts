// By which joint of which other model one is to be held.
import type { SessionState } from '../engine/messages';
import { button, element } from '../ui/dom';
import { partName } from '../words/parts';
import { say } from '../words/say';

export interface Holder {
  to: number;
  joint: string;
  snap: boolean;
}

/** Hands first: most things are held in one. */
function jointsOf({ joints }: SessionState['members'][number]) {
  const isHand = (part: string | null) => part !== null && /hand/.test(part);
  return [...joints.filter(({ part }) => isHand(part)), ...joints.filter(({ part }) => !isHand(part))];
}

/** null where the user thought better of it. */
export function askHolder(session: SessionState, member: number): Promise<Holder | null> {
  const held = session.members[member]!;
  const groups = session.members.flatMap((of, to) => (to === member ? [] : [element('optgroup', { label: of.name },
    ...jointsOf(of).map(({ name, part }) => element('option', { value: JSON.stringify([to, name]) }, part ? `${partName(part)} (${name})` : name)))]));
  return new Promise((resolve) => {
    const select = element('select', { class: 'select', id: 'holder' }, ...groups);
    const snap = element('input', { type: 'checkbox', id: 'holder-snap', checked: true });
    const title = say('Let another model hold {name}', { name: held.name });
    const dialog = element('dialog', { class: 'ask', id: 'hold', 'aria-label': title }, element('h2', {}, title));
    const close = (holder: Holder | null) => {
      dialog.remove();
      resolve(holder);
    };
    const taken = (): Holder => {
      const [to, joint] = JSON.parse(select.value) as [number, string];
      return { to, joint, snap: snap.checked };
    };
    dialog.append(
      element('div', { class: 'field' }, element('label', { for: 'holder' }, say('By')), select),
      element('label', { class: 'check', title: say('Else it keeps its distance from there') }, snap, say('Bring it there')),
      element('div', { class: 'row' }, button(say('Cancel'), () => close(null), { id: 'hold-no' }),
        button(say('Attach'), () => close(taken()), { id: 'hold-yes', kind: 'primary' })));
    dialog.addEventListener('cancel', () => close(null));
    document.body.append(dialog);
    dialog.showModal();
  });
}
