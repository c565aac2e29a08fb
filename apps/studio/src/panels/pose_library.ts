// The library of poses: each shown on the user's own character, put on it by a click; and the user's own, which are
// kept in the browser and go as files.
import type { KeptPose } from '../app/pose_store';
import { poseFile, type PoseShelf } from '../app/pose_shelf';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { Trials } from '../app/trials';
import type { MotionPreview, SamplePose } from '../engine/messages';
import { MotionPictures } from '../scene/motion_picture';
import { arrowsMoveFocus } from '../ui/cards';
import { button, element, fileInput, offer } from '../ui/dom';
import { goneLine } from '../ui/gone_line';
import { renameIn } from '../ui/rename';
import { shownWhile } from '../ui/shown_while';
import { poseName, told } from '../words/engine';
import { say } from '../words/say';

const width = 264, height = 198; // pixels of a picture
const pictureType = 'image/webp';

/** One that the engine makes, or one of the user's. */
type Entry = SamplePose | KeptPose;
const isKept = (entry: Entry): entry is KeptPose => 'id' in entry;
const titleOf = (entry: Entry) => (isKept(entry) ? entry.name : poseName(entry.name));

interface Card {
  entry: Entry;
  root: HTMLElement;
  press: HTMLButtonElement;
  canvas: HTMLCanvasElement;
  reason: HTMLElement;
  preview: MotionPreview | null;
}

export function poseLibrary(studio: Studio, page: PageStore, shelf: PoseShelf): HTMLElement {
  let pictures: MotionPictures | null = null; // made when the library is first opened
  const trials = new Trials<Card>(page, ({ entry }) => studio.previewPose(entry.pose), () => studio.previewRig());
  const hide = () => page.set({ poseLibrary: false });
  const cards = { sample: [] as Card[], own: [] as Card[] };
  const all = () => [...cards.own, ...cards.sample];

  const samples = element('ul', { class: 'cards', id: 'pose-samples' }), own = element('ul', { class: 'cards', id: 'pose-own' });
  const none = element('p', { class: 'hint-line' }, say('Save the pose that the model stands in: it is kept here, in this browser, for all your models.'));
  const name = element('input', { class: 'select', id: 'pose-name', 'aria-label': say('Name of the pose'), placeholder: say('Name of the pose'), maxlength: 80 });
  const save = async () => {
    const wanted = name.value.trim();
    name.value = '';
    await shelf.save(wanted);
  };
  name.addEventListener('keydown', ({ key }) => { if (key === 'Enter') void save(); });
  const gone = goneLine('undo-pose');
  const files = fileInput('pose-files', { accept: '.json,.zip' }, (chosen) => void studio.openFiles(chosen));
  const partly = element('input', { type: 'checkbox', id: 'pose-partly' });
  const partlyLabel = element('label', { class: 'check' }, partly, say('Only the selected joints and what hangs on them'));
  const dialog = element('dialog', { class: 'shelf poses', id: 'poses', 'aria-labelledby': 'poses-title' },
    element('div', { class: 'row head' }, element('h2', { id: 'poses-title', tabindex: -1, autofocus: true }, say('Poses')),
      button(say('Close'), hide, { id: 'close-poses' })),
    partlyLabel,
    element('h3', {}, say('Your poses')), none,
    element('div', { class: 'row save-pose' }, name, button(say('Save this pose'), () => void save(), { id: 'save-pose', icon: 'add' })),
    gone.root, own, element('h3', {}, say('Poses to begin with')), samples,
    element('div', { class: 'row foot' }, files,
      button(say('Open poses'), () => files.click(), { icon: 'open', label: say('Open poses that were saved as files'), id: 'open-pose-files' })));

  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const card = all().find(({ root }) => root === target);
      if (!card) continue;
      if (isIntersecting && !card.preview) trials.want(card);
      else trials.leave(card);
    }
  }, { root: dialog });

  trials.onResult = (card, preview) => {
    card.preview = preview;
    showResult(card, preview);
  };
  /** Those for another kind of body come last. */
  trials.onRest = () => {
    if (!dialog.open) return;
    keepPictures();
    if (samples.querySelector(':is(:active, :hover, :focus)')) return; // nothing moves away from under the pointer
    const suits = (card: Card) => Number(card.preview?.error == null), before = cards.sample.slice();
    cards.sample.sort((a, b) => suits(b) - suits(a) || page.now.samplePoses.indexOf(a.entry as SamplePose) - page.now.samplePoses.indexOf(b.entry as SamplePose));
    if (cards.sample.some((card, i) => card !== before[i])) samples.replaceChildren(...cards.sample.map(({ root }) => root));
  };

  function showResult(card: Card, { error }: MotionPreview) {
    card.press.setAttribute('aria-disabled', String(error !== null));
    card.press.removeAttribute('aria-busy');
    const why = error ? told(error) : null;
    card.reason.textContent = error?.code === 'unsupported' ? say('Made for another kind of body') : why?.title ?? '';
    card.press.title = why ? `${titleOf(card.entry)}: ${why.title}` : titleOf(card.entry);
    if (error) void drawKept(card);
    else draw(card);
  }

  function draw(card: Card) {
    const { session, hiddenParts } = page.now, rig = card.preview && trials.rigOf(card.preview);
    if (!pictures || !card.preview || card.preview.error || !session || !rig) return;
    pictures.show(rig.model, rig.joints, session.box, hiddenParts);
    pictures.draw(card.canvas, card.preview, 0);
  }

  /** The character that stood so before. */
  async function drawKept({ entry, canvas }: Card) {
    if (!isKept(entry) || entry.picture === '') return;
    const image = new Image();
    image.src = entry.picture;
    await image.decode().catch(() => {});
    if (image.naturalWidth > 0) canvas.getContext('2d')?.drawImage(image, 0, 0, width, height);
  }

  function choose({ entry, preview }: Card) {
    if (preview?.error) return;
    const { selected, also } = page.now;
    const joints = partly.checked && selected !== null ? hangingOn(new Set([selected, ...also])) : [];
    hide();
    void studio.applyPose(entry.pose, { joints });
  }

  /** The joints and all below them. */
  function hangingOn(chosen: ReadonlySet<number>): number[] {
    const joints = page.now.session?.joints ?? [];
    const isBelow = (of: number): boolean => chosen.has(of) || (of >= 0 && isBelow(joints[of]?.parent ?? -1));
    return joints.flatMap((_, at) => (isBelow(at) ? [at] : []));
  }

  function makeCard(entry: Entry): Card {
    const canvas = element('canvas', { width, height, 'aria-hidden': true }), reason = element('span', { class: 'reason' });
    const press = element('button', { type: 'button', class: 'motion-card', 'data-pose': entry.name, 'aria-busy': 'true' }, canvas, element('span', { class: 'text' }, titleOf(entry)), reason);
    const card: Card = { entry, root: element('li', {}, press), press, canvas, reason, preview: null };
    press.title = titleOf(entry);
    press.addEventListener('click', () => choose(card));
    press.addEventListener('keydown', (event) => arrowsMoveFocus(event, all(), card));
    if (isKept(entry)) card.root.append(keptActions(card, entry.id));
    seen.observe(card.root);
    return card;
  }

  function keptActions(card: Card, id: string): HTMLElement {
    const act = (does: (kept: KeptPose) => void) => () => {
      const kept = page.now.ownPoses.find((pose) => pose.id === id);
      if (kept) does(kept);
    };
    const named = titleOf(card.entry), actions = element('div', { class: 'row pose-actions' });
    actions.append(
      button('', act((kept) => renameIn(actions, say('Name of the pose'), kept.name, (after) => void rename(kept, after))), { icon: 'edit', label: say('Rename {name}', { name: named }) }),
      button('', act((kept) => {
        const { file, text } = poseFile(kept);
        offer(text, 'application/json', file);
      }), { icon: 'save', label: say('Save {name} as a file', { name: named }) }),
      button('', act((kept) => {
        void shelf.forget(kept);
        gone.tell(say('{name} was deleted', { name: kept.name }), () => shelf.bringBack(kept));
        name.focus();
      }), { icon: 'erase', label: say('Delete {name}', { name: named }) }));
    return actions;
  }

  async function rename(kept: KeptPose, after: string) {
    await shelf.rename(kept, after);
    cards.own.find(({ entry }) => isKept(entry) && entry.id === kept.id)?.press.focus();
  }

  /** What is as it was keeps its card, with its picture; one with a new picture, too. */
  function fill(list: HTMLElement, before: Card[], entries: readonly Entry[]): Card[] {
    const sameCard = (card: Card, entry: Entry) => card.entry === entry
      || (isKept(card.entry) && isKept(entry) && card.entry.id === entry.id && card.entry.name === entry.name);
    const after = entries.map((entry) => {
      const known = before.find((card) => sameCard(card, entry));
      if (known) known.entry = entry;
      return known ?? makeCard(entry);
    });
    before.filter((card) => !after.includes(card)).forEach((card) => {
      seen.unobserve(card.root);
      trials.leave(card);
    });
    // A button that is taken out while it is pressed is not clicked.
    if (after.length !== before.length || after.some((card, i) => card !== before[i])) list.replaceChildren(...after.map(({ root }) => root));
    return after;
  }

  /** On another rig all is tried anew. */
  function renew() {
    trials.renew();
    for (const card of all()) {
      card.preview = null;
      card.press.setAttribute('aria-busy', 'true');
      card.press.removeAttribute('aria-disabled');
      card.reason.textContent = '';
      // Observed anew, it tells again whether it is seen.
      seen.unobserve(card.root);
      seen.observe(card.root);
    }
  }

  function open() {
    if (!pictures) {
      pictures = new MotionPictures();
      pictures.onChange = () => all().forEach(draw);
    }
    void shelf.load();
    dialog.showModal();
    renew();
  }

  /** What a pose looks like where it cannot be shown on the model. */
  function keepPictures() {
    for (const { entry, canvas, preview } of cards.own) {
      if (isKept(entry) && entry.picture === '' && preview && !preview.error) void shelf.describe(entry, canvas.toDataURL(pictureType));
    }
  }

  dialog.addEventListener('keydown', (event) => event.stopPropagation()); // what is behind the library has keys, too
  dialog.addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && (event.target as HTMLElement).matches('.rename')) event.preventDefault(); // the field closes, not the library
  }, { capture: true });
  let listed: readonly SamplePose[] = [], kept: readonly KeptPose[] = [];
  page.watch((now, before) => {
    if (now.samplePoses !== listed) cards.sample = fill(samples, cards.sample, listed = now.samplePoses);
    if (now.ownPoses !== kept) cards.own = fill(own, cards.own, kept = now.ownPoses);
    none.hidden = now.ownPoses.length > 0;
    partly.disabled = now.selected === null;
    if (now.selected === null) partly.checked = false;
    if (dialog.open && now.model !== before.model) renew();
  });
  shownWhile(dialog, page, 'poseLibrary', {
    ready: ({ session }) => session !== null,
    opens: open,
    closes() {
      trials.leaveAll();
      keepPictures();
      pictures?.clear();
    },
  });
  return dialog;
}
