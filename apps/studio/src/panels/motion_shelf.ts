// Motions to try on: each plays on the user's own character in a small picture, and is put on it by a click.
import { isMotionFile, motionFiles } from '../app/files';
import { Trials, type Motion } from '../app/trials';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { MotionPreview } from '../engine/messages';
import { MotionPictures } from '../scene/motion_picture';
import { arrowsMoveFocus } from '../ui/cards';
import { button, element, fileInput } from '../ui/dom';
import { shownWhile } from '../ui/shown_while';
import { motionName, motionSummary, told } from '../words/engine';
import { say } from '../words/say';

const width = 264, height = 198; // pixels of a picture
const mostUnsearched = 12; // cards that are found without searching
const stillShare = 0.45; // of the motion, which the picture of a card that does not play shows: about its middle

function titleOf(motion: Motion): string {
  if (motion instanceof File) return motion.name.replace(/\.[^.]*$/, '');
  return motionName(motion.name);
}

interface Card {
  motion: Motion;
  root: HTMLElement;
  press: HTMLButtonElement;
  canvas: HTMLCanvasElement;
  reason: HTMLElement;
  preview: MotionPreview | null;
}

/** What a card is about: the motion, or all of why it cannot be put on the model. */
function explained({ motion, preview }: Card): string {
  if (preview?.error) return `${titleOf(motion)}: ${told(preview.error).title}`;
  return motion instanceof File ? motion.name : motionSummary(motion);
}

export function motionShelf(studio: Studio, page: PageStore): HTMLElement {
  let pictures: MotionPictures | null = null; // made when the shelf is first opened
  let playing: Card | null = null, begun = 0;
  let tapped: Card | null = null; // touched for the first time: it plays, and is not chosen yet
  const trials = new Trials<Motion>(page, (motion) => studio.previewMotion(motion), () => studio.previewRig());
  const hide = () => page.set({ shelf: false });
  const cards = { sample: [] as Card[], own: [] as Card[] };

  const samples = element('ul', { class: 'cards', id: 'shelf-samples' }), own = element('ul', { class: 'cards', id: 'shelf-own' });
  const search = element('input', { type: 'search', class: 'select search', id: 'shelf-search', 'aria-label': say('Search your motions'), placeholder: say('Search') });
  const none = element('p', { class: 'hint-line' }, say('Drop a folder of BVH, NPZ, VRMA, FBX or GLB motions on the page, or choose it here: it becomes a shelf of your own.'));
  const about = element('p', { class: 'hint-line', role: 'status', id: 'shelf-about' });
  const files = fileInput('shelf-files', { accept: motionFiles }, (chosen) => void studio.openMotions(chosen));
  const folder = fileInput('shelf-folder', { folder: true }, (chosen) => void studio.openMotions(chosen.filter(isMotionFile)));
  const dialog = element('dialog', { class: 'shelf', id: 'shelf', 'aria-labelledby': 'shelf-title' },
    element('div', { class: 'row head' }, element('h2', { id: 'shelf-title', tabindex: -1, autofocus: true }, say('Motions')),
      button(say('Close'), hide, { id: 'close-shelf' })),
    samples, element('h3', {}, say('Your motions')), none, search, own,
    element('div', { class: 'row foot' }, files, folder, about,
      button(say('Add files'), () => files.click(), { icon: 'add', label: say('Add motions (BVH, NPZ, VRMA, FBX, GLB)'), id: 'shelf-add-files' }),
      button(say('Add a folder'), () => folder.click(), { icon: 'open', label: say('Add a folder of motions'), id: 'shelf-add-folder' })));

  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const card = all().find(({ root }) => root === target);
      if (!card) continue;
      // Of a long shelf only what is seen is kept in motion.
      if (!isIntersecting && card.motion instanceof File && !card.preview?.error) card.preview = null;
      if (isIntersecting && !card.preview) trials.want(card.motion);
      else trials.leave(card.motion);
    }
  }, { root: dialog });
  const all = () => [...cards.sample, ...cards.own];

  /** Not while one is pointed at: nothing moves away from under the pointer. */
  function suitedFirst() {
    for (const [list, of] of [[samples, cards.sample], [own, cards.own]] as const) {
      const suited = (card: Card) => Number(card.preview?.error == null);
      const before = of.slice(), motions: readonly Motion[] = list === samples ? page.now.sampleMotions : page.now.ownMotions;
      of.sort((a, b) => suited(b) - suited(a) || motions.indexOf(a.motion) - motions.indexOf(b.motion));
      if (of.some((card, i) => card !== before[i])) list.replaceChildren(...of.map(({ root }) => root));
    }
  }

  trials.onRest = () => { if (dialog.open && !playing && !tapped) suitedFirst(); };
  trials.onResult = (motion, preview) => {
    const card = all().find((one) => one.motion === motion);
    if (card) showResult(card, preview);
  };

  function showResult(card: Card, preview: MotionPreview) {
    const { error } = preview;
    card.preview = preview;
    card.press.setAttribute('aria-disabled', String(error !== null));
    card.reason.textContent = !error ? '' : error.code === 'unsupported' ? say('Made for another kind of body') : told(error).title;
    card.press.title = explained(card);
    if (card === playing) about.textContent = explained(card);
    card.press.removeAttribute('aria-busy');
    if (card === playing) begun = performance.now();
    draw(card, 0);
  }

  /** `seconds` after its still picture. */
  function draw(card: Card, seconds: number) {
    const { session, hiddenParts } = page.now, rig = card.preview && trials.rigOf(card.preview);
    if (!pictures || !card.preview || card.preview.error || !session || !rig) return;
    pictures.show(rig.model, rig.joints, session.box, hiddenParts);
    pictures.draw(card.canvas, card.preview, stillShare * card.preview.seconds + seconds);
  }

  function step(now: number) {
    if (!playing || !dialog.open) return;
    draw(playing, Math.max(0, now - begun) / 1000);
    requestAnimationFrame(step);
  }

  function play(card: Card | null) {
    if (card === playing) return;
    playing?.root.firstElementChild?.classList.remove('playing');
    if (playing) draw(playing, 0);
    const idle = playing === null;
    playing = card;
    begun = performance.now();
    about.textContent = card ? explained(card) : '';
    if (!card) return;
    card.press.classList.add('playing');
    if (!card.preview) trials.wantFirst(card.motion);
    if (idle) requestAnimationFrame(step);
  }

  function choose({ motion, preview }: Card) {
    if (preview?.error) return;
    hide();
    void (motion instanceof File ? studio.openMotion(motion) : studio.openSampleMotion(motion.name));
  }

  function makeCard(motion: Motion): Card {
    const canvas = element('canvas', { width, height, 'aria-hidden': true }), reason = element('span', { class: 'reason' });
    const press = element('button', {
      type: 'button', class: 'motion-card', 'data-motion': motion.name, 'aria-busy': 'true',
    }, canvas, element('span', { class: 'text' }, titleOf(motion)), reason);
    const card: Card = { motion, root: element('li', {}, press), press, canvas, reason, preview: null };
    press.title = explained(card);
    press.addEventListener('pointerenter', ({ pointerType }) => { if (pointerType !== 'touch') play(card); });
    press.addEventListener('pointerleave', ({ pointerType }) => { if (pointerType !== 'touch' && document.activeElement !== press) play(null); });
    press.addEventListener('pointerdown', ({ pointerType }) => { tapped = pointerType === 'touch' && playing !== card ? card : null; });
    press.addEventListener('focus', () => play(card));
    press.addEventListener('blur', () => { if (playing === card) play(null); });
    press.addEventListener('click', () => {
      const first = tapped === card;
      tapped = null;
      if (first) play(card);
      else choose(card);
    });
    press.addEventListener('keydown', (event) => arrowsMoveFocus(event, all(), card));
    seen.observe(card.root);
    return card;
  }

  /** Those that are on it already stay, with their pictures. */
  function fill(list: HTMLElement, before: Card[], motions: readonly Motion[]): Card[] {
    const after = motions.map((motion) => before.find((card) => card.motion === motion) ?? makeCard(motion));
    before.filter((card) => !after.includes(card)).forEach(({ root }) => seen.unobserve(root));
    list.replaceChildren(...after.map(({ root }) => root));
    return after;
  }

  function filter() {
    const wanted = search.value.trim().toLowerCase();
    for (const { motion, root } of cards.own) root.hidden = !titleOf(motion).toLowerCase().includes(wanted);
  }
  search.addEventListener('input', filter);

  /** With another rig all is tried anew. */
  function renew() {
    if (!trials.renew()) return;
    for (const card of all()) {
      card.preview = null;
      card.press.setAttribute('aria-busy', 'true');
      card.press.removeAttribute('aria-disabled');
      card.press.title = explained(card);
      card.reason.textContent = '';
      card.canvas.getContext('2d')?.clearRect(0, 0, width, height);
      // Observed anew, it tells again whether it is seen.
      seen.unobserve(card.root);
      seen.observe(card.root);
    }
  }

  function open() {
    if (!pictures) {
      pictures = new MotionPictures();
      pictures.onChange = () => all().forEach((card) => { if (card !== playing) draw(card, 0); });
    }
    dialog.showModal();
    renew();
  }

  dialog.addEventListener('keydown', (event) => event.stopPropagation()); // what is behind the shelf has keys, too
  const fillOwn = (motions: readonly File[]) => {
    cards.own = fill(own, cards.own, motions);
    none.hidden = motions.length > 0;
    search.hidden = motions.length <= mostUnsearched;
    search.placeholder = say('Search {count} motions', { count: motions.length });
    filter();
  };
  fillOwn([]);
  let listed: readonly Motion[] = [], brought: readonly File[] = [];
  page.watch((now, before) => {
    if (now.sampleMotions !== listed) cards.sample = fill(samples, cards.sample, listed = now.sampleMotions);
    if (now.ownMotions !== brought) fillOwn(brought = now.ownMotions);
    if (dialog.open && now.model !== before.model) renew();
  });
  shownWhile(dialog, page, 'shelf', {
    ready: ({ session }) => session !== null,
    opens: open,
    closes() {
      play(null);
      trials.leaveAll();
      pictures?.clear();
    },
  });
  return dialog;
}
