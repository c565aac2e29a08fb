// The models of the scene: choose one, put it where it belongs, let a joint hold it.
import { Euler, MathUtils, Quaternion, Vector3 } from 'three';
import type { Placement, SceneMember, Vector } from '../engine/messages';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { quaternionOf, turnVector, type Places } from '../scene/places';
import { button, element } from '../ui/dom';
import { renameIn } from '../ui/rename';
import { partName } from '../words/parts';
import { say } from '../words/say';
import { askHolder } from './hold_dialog';

const decimals = 4; // that a field shows

/** Tilt, turn and roll in degrees, as people think of them: where it faces comes first. */
function anglesOf({ turn }: Placement): Vector {
  const { x, y, z } = new Euler().setFromQuaternion(quaternionOf(turn), 'YXZ');
  return [x, y, z].map(MathUtils.radToDeg) as Vector;
}

const turnOf = (angles: Vector) => turnVector(new Quaternion().setFromEuler(new Euler(...angles.map(MathUtils.degToRad) as Vector, 'YXZ')));

/** The middle of the model's floor stays where it is while it is turned or scaled. */
function aboutFeet({ min, max }: SceneMember['box'], before: Placement, change: Partial<Placement>): Placement {
  const after = { ...before, ...change };
  const feet = ({ turn, scale }: Placement) =>
    new Vector3((min[0] + max[0]) / 2, min[1], (min[2] + max[2]) / 2).multiplyScalar(scale).applyQuaternion(quaternionOf(turn));
  return { ...after, position: new Vector3(...before.position).add(feet(before)).sub(feet(after)).toArray() };
}

function heldBy({ name, attached }: SceneMember, members: SceneMember[]): string {
  const holder = members[attached!.to], joint = holder?.joints.find((known) => known.name === attached!.joint);
  return say('{holder} holds {name}: {joint}', { name, holder: holder?.name ?? '', joint: joint?.part ? partName(joint.part) : attached!.joint });
}

export function scenePanel(studio: Studio, page: PageStore, places: Places): HTMLElement {
  const chosen = () => page.now.session?.member ?? 0;
  const member = () => page.now.session?.members[chosen()] ?? null;
  const list = element('ul', { class: 'members', 'aria-label': say('Models in the scene'), id: 'members' });
  const place = button(say('Move about'), () => page.set({ arranging: !page.now.arranging, display: page.now.arranging ? 'handles' : 'surface', playing: false }), {
    icon: 'move', id: 'arrange', label: say('Drag a model over the floor'),
  });
  const hold = button(say('Attach\u2026'), () => void attach(), { id: 'attach-member', label: say('Let a joint of another model hold this one') });
  const letGo = button(say('Let go'), () => void studio.detachMember(chosen()), { id: 'detach-member', label: say('It stays where it is') });
  const remove = button('', () => void studio.removeMember(chosen()), { icon: 'erase', id: 'remove-member', label: say('Take this model out of the scene') });
  const attach = async () => {
    const { session } = page.now;
    const wanted = session && await askHolder(session, chosen());
    if (wanted) await studio.attachMember(chosen(), wanted.to, wanted.joint, wanted.snap);
  };

  /** Takes what is entered into the place where the model is now: one that is held may have moved since the page was told. */
  const field = (id: string, text: string, step: number, shown: (of: Placement) => number, take: (value: number, of: Placement) => Placement | null) => {
    const input = element('input', { type: 'number', id, step, class: 'number' });
    input.addEventListener('change', () => {
      const { session } = page.now, value = input.valueAsNumber;
      const wanted = session && Number.isFinite(value) ? take(value, places.placement(chosen(), session.members)) : null;
      if (wanted) void studio.placeMember(chosen(), wanted);
    });
    const show = ({ placement }: SceneMember) => {
      if (document.activeElement !== input) input.value = String(Number(shown(placement).toFixed(decimals)));
    };
    return { show, row: element('label', { class: 'placement-field', for: id }, text, input) };
  };
  const along = (axis: number) => (value: number, of: Placement) => ({ ...of, position: of.position.map((was, i) => (i === axis ? value : was)) as Vector });
  const reshape = (of: Placement, change: Partial<Placement>) => {
    const box = member()?.box;
    return box ? aboutFeet(box, of, change) : null;
  };
  const angle = (axis: number) => (value: number, of: Placement) =>
    reshape(of, { turn: turnOf(anglesOf(of).map((was, i) => (i === axis ? value : was)) as Vector) });
  const fields = [
    field('member-x', 'X', 0.1, ({ position }) => position[0], along(0)),
    field('member-y', 'Y', 0.1, ({ position }) => position[1], along(1)),
    field('member-z', 'Z', 0.1, ({ position }) => position[2], along(2)),
    field('member-turn', say('Turn °'), 15, (of) => anglesOf(of)[1], angle(1)),
    field('member-tilt', say('Tilt °'), 15, (of) => anglesOf(of)[0], angle(0)),
    field('member-roll', say('Roll °'), 15, (of) => anglesOf(of)[2], angle(2)),
    field('member-size', say('Size %'), 5, ({ scale }) => 100 * scale, (value, of) => (value > 0 ? reshape(of, { scale: value / 100 }) : null)),
  ];
  const about = element('p', { class: 'hint-text', id: 'member-about' });

  const row = (of: SceneMember, index: number) => {
    const pick = button(of.name, () => void studio.chooseMember(index), { label: of.name });
    const rename = button('', () => renameIn(item, say('Name of the model'), of.name, (name) => void studio.renameMember(index, name)), {
      icon: 'edit', label: say('Rename {name}', { name: of.name }),
    });
    const item = element('li', {}, pick, rename);
    item.dataset['member'] = String(index);
    return item;
  };
  const root = element('section', { class: 'card scene', 'aria-label': say('Scene'), id: 'scene' },
    list, element('div', { class: 'row' }, place, hold, letGo, remove), about,
    element('details', { id: 'member-place' }, element('summary', {}, say('Place and size')), element('div', { class: 'placement-fields' }, ...fields.map((one) => one.row))));
  let listed = '';
  page.watch(({ session, arranging }) => {
    const members = session?.members ?? [], of = member();
    root.hidden = members.length < 2;
    if (root.hidden || !of) {
      if (arranging) page.set({ arranging: false, display: 'handles' });
      return;
    }
    const names = members.map(({ name }) => name).join('\n');
    if (names !== listed) list.replaceChildren(...members.map(row));
    listed = names;
    [...list.children].forEach((item, index) => item.querySelector('button')?.setAttribute('aria-pressed', String(index === session?.member)));
    place.setAttribute('aria-pressed', String(arranging));
    letGo.hidden = of.attached === null;
    about.textContent = of.attached
      ? heldBy(of, members)
      : arranging ? say('Drag a model over the floor; beside them you turn the view') : '';
    about.hidden = about.textContent === '';
    fields.forEach(({ show }) => show(of));
    // Who looks at handles again poses.
    if (arranging && page.now.display === 'handles') page.set({ arranging: false });
  });
  return root;
}
