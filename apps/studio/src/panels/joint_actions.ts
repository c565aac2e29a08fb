// What can be done to the rig at the selected joint: its weights locked; joints added, deleted, hung elsewhere.
import type { SessionState } from '../engine/messages';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { choose } from '../ui/choose';
import { button, element } from '../ui/dom';
import { jointTitle } from '../words/parts';
import { say } from '../words/say';

export function jointActions(studio: Studio, page: PageStore): HTMLElement {
  const selected = () => page.now.selected ?? 0;
  const nameOf = (joint: number) => page.now.session?.joints[joint]?.name ?? '';
  const lock = button(say('Lock'), () => void studio.toggleLock(selected()), { id: 'lock-joint', keys: 'L', label: say('Keep the weights of this joint as they are while others are painted') });
  const add = button(say('New'), () => page.set({ placing: !page.now.placing, painting: false, correcting: false }), {
    id: 'add-joint', label: say('Add a joint below this one: then click on the model where it should be. It moves nothing until you paint weights for it'),
  });
  addEventListener('keydown', (event) => { if (event.key === 'Escape' && page.now.placing) page.set({ placing: false }); });
  const remove = button(say('Delete'), () => void studio.deleteJoint(selected()), {
    id: 'delete-joint', label: say('Delete this joint: what it moves goes to the joint above, and so do the joints below it'),
  });
  const hang = button(say('Hang on \u2026'), () => void hangElsewhere(), {
    id: 'hang-joint', label: say('Hang this joint, with all below it, on another joint; it stays where it is'),
  });
  const hangElsewhere = async () => {
    const { session } = page.now, joint = selected();
    if (!session) return;
    const parents = possibleParents(session.joints, joint).map(nameOf);
    const parent = await choose(say('Hang {joint} elsewhere', { joint: nameOf(joint) }), say('On'), parents, say('Hang it there'));
    if (parent !== null) await studio.hangJoint(joint, parent);
  };
  const hint = element('p', { class: 'hint-text', role: 'status', id: 'place-hint' });
  page.watch(({ session, selected: joint, placing }) => {
    const none = !session || joint === null, locked = joint !== null && (session?.locked.includes(joint) ?? false);
    lock.disabled = add.disabled = none;
    lock.setAttribute('aria-pressed', String(locked));
    add.setAttribute('aria-pressed', String(placing));
    remove.disabled = none || session.joints.length < 2;
    hang.disabled = none || possibleParents(session.joints, joint).length === 0;
    hint.textContent = placing && joint !== null ? say('Click on the model where the joint below {joint} should be', { joint: jointTitle(session?.joints[joint]) }) : '';
    hint.hidden = !placing;
  });
  return element('div', { class: 'joint-actions' }, element('div', { class: 'row actions' }, lock, add, remove, hang), hint);
}

/** Those that are not below it, and not the one that it hangs on. */
function possibleParents(joints: SessionState['joints'], joint: number): number[] {
  const isBelow = (of: number): boolean => of === joint || (of >= 0 && isBelow(joints[of]?.parent ?? -1));
  return joints.flatMap((_, other) => (isBelow(other) || joints[joint]?.parent === other ? [] : [other]));
}
