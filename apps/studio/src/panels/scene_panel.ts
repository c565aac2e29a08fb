// The models of the scene: choose one, put it where it belongs, let a joint hold it.
import { Euler, MathUtils, Quaternion, Vector3 } from 'three';
import type { Placement, SceneMember, Vector } from '../engine/messages';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { renameIn } from '../ui/rename';
import { say } from '../words/say';
import { askHolder } from './hold_dialog';

const finest = 1e-4; // of what a field shows

/** Turn, tilt and roll in degrees, in the order in which people think of them: first where it faces. */
function anglesOf({ turn }: Placement): Vector {
  const vector = new Vector3(...turn), degrees = vector.length();
  const { x, y, z } = new Euler().setFromQuaternion(new Quaternion().setFromAxisAngle(vector.normalize(), MathUtils.degToRad(degrees)), 'YXZ');
  return [x, y, z].map(MathUtils.radToDeg) as Vector;
}

function turnOf([x, y, z]: Vector): Vector {
  const { x: qx, y: qy, z: qz, w } = new Quaternion().setFromEuler(new Euler(...[x, y, z].map(MathUtils.degToRad) as Vector, 'YXZ'));
  const sine = Math.hypot(qx, qy, qz), degrees = MathUtils.radToDeg(2 * Math.atan2(sine, w));
  return sine < 1e-12 ? [0, 0, 0] : [qx, qy, qz].map((part) => (degrees * part) / sine) as Vector;
}

/** The middle of the model's floor stays where it is while it is turned or scaled. */
function aboutFeet({ box, placement }: SceneMember, change: Pick<Placement, 'turn' | 'scale'>): Vector {
  const feet = new Vector3((box.min[0] + box.max[0]) / 2, box.min[1], (box.min[2] + box.max[2]) / 2);
  const from = ({ turn, scale }: Pick<Placement, 'turn' | 'scale'>) => {
    const axis = new Vector3(...turn), degrees = axis.length();
    return feet.clone().multiplyScalar(scale).applyAxisAngle(axis.normalize(), MathUtils.degToRad(degrees));
  };
  return new Vector3(...placement.position).add(from(placement)).sub(from(change)).toArray();
}

function heldBy({ name, attached }: SceneMember, members: SceneMember[]): string {
  const holder = members[attached!.to], joint = holder?.joints.find((known) => known.name === attached!.joint);
  return say('{holder} holds {name}: {joint}', { name, holder: holder?.name ?? '', joint: joint?.part ?? attached!.joint });
}

export function scenePanel(studio: Studio, page: PageStore): HTMLElement {
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

  const field = (id: string, text: string, step: number, shown: (of: SceneMember) => number, take: (value: number, of: SceneMember) => void) => {
    const input = element('input', { type: 'number', id, step, class: 'number' });
    input.addEventListener('change', () => {
      const of = member(), value = input.valueAsNumber;
      if (of && Number.isFinite(value)) take(value, of);
    });
    const show = (of: SceneMember) => {
      const value = Math.round(shown(of) / finest) * finest;
      if (document.activeElement !== input) input.value = String(Number(value.toFixed(4)));
    };
    return { show, row: element('label', { class: 'number-field', for: id }, text, input) };
  };
  const move = (axis: number) => (value: number, of: SceneMember) => {
    const position = [...of.placement.position] as Vector;
    position[axis] = value;
    void studio.placeMember(chosen(), position);
  };
  const reshape = (of: SceneMember, change: Partial<Placement>) => {
    const whole = { ...of.placement, ...change };
    void studio.placeMember(chosen(), aboutFeet(of, whole), whole);
  };
  const angle = (axis: number) => (value: number, of: SceneMember) => {
    const angles = anglesOf(of.placement);
    angles[axis] = value;
    reshape(of, { turn: turnOf(angles) });
  };
  const fields = [
    field('member-x', 'X', 0.1, ({ placement }) => placement.position[0], move(0)),
    field('member-y', 'Y', 0.1, ({ placement }) => placement.position[1], move(1)),
    field('member-z', 'Z', 0.1, ({ placement }) => placement.position[2], move(2)),
    field('member-turn', say('Turn \u00b0'), 15, ({ placement }) => anglesOf(placement)[1], angle(1)),
    field('member-tilt', say('Tilt \u00b0'), 15, ({ placement }) => anglesOf(placement)[0], angle(0)),
    field('member-roll', say('Roll \u00b0'), 15, ({ placement }) => anglesOf(placement)[2], angle(2)),
    field('member-size', say('Size %'), 5, ({ placement }) => 100 * placement.scale, (value, of) => { if (value > 0) reshape(of, { scale: value / 100 }); }),
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
    element('details', { id: 'member-place' }, element('summary', {}, say('Place and size')), element('div', { class: 'number-fields' }, ...fields.map((one) => one.row))));
  let listed = '';
  page.watch(({ session, arranging }, before) => {
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
    if (session !== before.session || list.childElementCount > 0) fields.forEach(({ show }) => show(of));
    // Who looks at handles again poses.
    if (arranging && page.now.display === 'handles') page.set({ arranging: false });
  });
  return root;
}
