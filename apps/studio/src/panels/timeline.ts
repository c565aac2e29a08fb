// The clips of the model: choose, play, scrub, set keys.
import { sceneDuration } from '../app/clips';
import { motionFiles } from '../app/files';
import { togglePlaying } from '../app/player';
import { frame } from '../app/keys';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element, fileInput, setIcon } from '../ui/dom';
import { inSeconds, language, number, say } from '../words/say';
import { keyToggle } from './key_toggle';
import { chosenClip, shownSeconds, type Clip } from './moments';

const mostMarks = 400; // keys that are drawn; recorded motion has one for every frame
const spans = [0.1, 0.3, 0.6, 1]; // seconds

export function timeline(studio: Studio, page: PageStore, openSheet: () => Promise<void>): HTMLElement {
  const file = fileInput('motion-file', { accept: motionFiles }, (files) => void studio.openMotions(files));
  const clips = element('select', { class: 'select', id: 'clips', 'aria-label': say('The clip that is shown') });
  clips.addEventListener('change', () => {
    const name = clips.value;
    page.set({ playing: false });
    void studio.chooseClip(name);
  });
  const play = button('', () => togglePlaying(studio, page), { icon: 'play', label: say('Play'), keys: 'Space', id: 'play' });
  const time = element('output', { class: 'time', id: 'time' }, inSeconds(0, 2));
  const { track, scrub, show } = scrubber(studio, page);

  const speed = element('select', { class: 'select', id: 'speed', 'aria-label': say('Speed') },
    ...[0.25, 0.5, 1, 2].map((value) => element('option', { value, selected: value === 1 }, `${value.toLocaleString(language)}\u00d7`)));
  speed.addEventListener('change', () => page.set({ speed: Number(speed.value) }));
  const loop = button('', () => page.set({ loop: !page.now.loop }), { icon: 'loop', label: say('Again and again'), id: 'loop' });
  const key = button(say('Key'), () => void studio.setKey(), { icon: 'key', keys: 'K', label: say('The pose becomes a key at this moment'), id: 'add-key' });
  const auto = button(say('Auto'), () => page.set({ autoKey: !page.now.autoKey }), { label: say('What is posed becomes a key at once'), id: 'auto-key' });
  const erase = button('', () => void studio.run({ do: 'delete_keys', keys: [{ seconds: keyHere(page) ?? 0 }] }), { icon: 'erase', label: say('Take the key at this moment out'), id: 'delete-key' });
  const between = element('select', { class: 'select', id: 'interpolation', 'aria-label': say('Between keys') },
    ...([['step', say('In steps')], ['linear', say('Straight')], ['cubic', say('Curved')]] as const).map(([value, text]) => element('option', { value }, text)));
  between.addEventListener('change', () => void studio.run({ do: 'set_interpolation', interpolation: between.value }));
  const blend = element('select', { class: 'select', id: 'blend', 'aria-label': say('Seconds over which a correction comes and goes') },
    ...spans.map((value) => element('option', { value }, say('Blend {seconds} s', { seconds: value }))));
  blend.addEventListener('change', () => page.set({ span: Number(blend.value) }));
  const ghosts = button('', () => studio.showGhosts(!page.now.ghosts), { icon: 'ghosts', label: say('Ghosts: before and after, and the selected joint\u2019s path'), id: 'ghosts' });
  const feet = button(say('Feet'), () => page.set({ feet: !page.now.feet }), { icon: 'pin', label: say('While which foot stands'), id: 'open-feet' });
  feet.setAttribute('aria-controls', 'feet');
  const sequence = button(say('Join'), () => page.set({ sequence: !page.now.sequence }), { icon: 'sequence', label: say('Clips that follow each other'), id: 'open-sequence' });
  sequence.setAttribute('aria-controls', 'sequence');
  const sheet = button('', () => void openSheet(), { icon: 'sheet', label: say('Contact sheet: the clip at a glance'), id: 'open-sheet' });
  const add = button(say('New clip'), () => void studio.addClip(), { icon: 'add', label: say('A clip of your own poses'), id: 'add-clip' });
  const motion = button(say('Motion file'), () => file.click(), { icon: 'open', label: say('Play a motion (BVH, NPZ, VRMA, FBX, GLB) on the model; several come to the shelf'), id: 'open-motion' });
  const shelf = button(say('Motions'), () => page.set({ shelf: true }), { icon: 'motions', label: say('Motions to try on the model'), id: 'open-shelf' });
  const remove = button('', () => void studio.run({ do: 'remove_clip', clip: chosenClip(page.now.session)?.name ?? '' }), { icon: 'erase', label: say('Remove this clip'), id: 'remove-clip' });

  const card = element('section', { class: 'card timeline', 'aria-label': say('Timeline'), id: 'timeline' },
    element('div', { class: 'row tools' }, play, clips, add, shelf, motion, file,
      element('div', { class: 'row clip-tools' }, speed, loop, feet, sequence, sheet, key, auto, blend, erase, between, remove)),
    element('div', { class: 'row moment' }, keyToggle(page), ghosts, element('div', { class: 'track' }, scrub, track), time));
  let listed = '';
  page.watch(({ session, seconds, playing, autoKey, span, ghosts: seen, loop: again, feet: standing, sequence: joined }) => {
    const clip = chosenClip(session);
    const names = session?.clips.map(({ name }) => name) ?? [];
    if (names.join('\n') !== listed || clips.childElementCount === 0) {
      listed = names.join('\n');
      clips.replaceChildren(element('option', { value: '' }, names.length > 0 ? say('No clip') : say('No clips yet')),
        ...names.map((name) => element('option', { value: name }, name)));
    }
    clips.value = clip?.name ?? '';
    clips.disabled = names.length === 0;
    const still = !clip || clip.duration <= 0;
    play.disabled = loop.disabled = speed.disabled = sceneDuration(session) <= 0;
    sheet.disabled = ghosts.disabled = still;
    ghosts.setAttribute('aria-pressed', String(seen));
    feet.hidden = !clip || clip.feet.length === 0;
    feet.setAttribute('aria-expanded', String(standing));
    sequence.hidden = still;
    sequence.setAttribute('aria-expanded', String(joined));
    // Recorded motion has no curves of its own to choose; its corrections have a span.
    blend.hidden = !clip?.recorded;
    between.hidden = clip?.recorded ?? false;
    blend.value = String(span);
    play.setAttribute('aria-pressed', String(playing));
    setIcon(play, playing ? 'pause' : 'play');
    play.setAttribute('aria-label', playing ? say('Pause') : say('Play'));
    loop.setAttribute('aria-pressed', String(again));
    key.disabled = auto.disabled = remove.disabled = !clip;
    auto.setAttribute('aria-pressed', String(autoKey));
    erase.disabled = keyHere(page) === null;
    between.disabled = !clip || clip.keys.length === 0;
    if (clip) between.value = clip.interpolation;
    add.disabled = motion.disabled = shelf.disabled = !session;
    time.textContent = clip ? `${number(seconds, 2)} / ${inSeconds(clip.duration, 2)}` : '';
    show(clip, seconds);
    card.classList.toggle('empty', !clip);
  });
  return card;
}

/** The key under the playhead. */
function keyHere(page: PageStore): number | null {
  const { session, seconds } = page.now;
  return chosenClip(session)?.keys.find((time) => Math.abs(time - seconds) < frame / 4) ?? null;
}

/** The slider of time with the keys on it, which can be dragged elsewhere. */
function scrubber(studio: Studio, page: PageStore) {
  const scrub = element('input', { type: 'range', id: 'scrub', min: 0, max: 1, step: 0.001, 'aria-label': say('Moment of the clip') });
  const track = element('div', { class: 'keys', id: 'keys' });
  scrub.addEventListener('input', () => {
    const to = scrub.valueAsNumber; // before the page draws the slider where it was
    page.set({ playing: false });
    studio.showMoment(to);
  });
  let drawn = '';
  const show = (clip: Clip | null, seconds: number) => {
    scrub.disabled = !clip;
    if (!clip) {
      drawn = '';
      return track.replaceChildren();
    }
    scrub.max = String(shownSeconds(clip, seconds));
    scrub.step = clip.recorded ? '0.001' : String(frame);
    scrub.value = String(seconds);
    scrub.setAttribute('aria-valuetext', say('{seconds} seconds', { seconds: number(seconds, 2) }));
    const now = `${clip.name} ${scrub.max} ${clip.keys}`;
    if (now === drawn) return;
    drawn = now;
    track.replaceChildren(...(clip.keys.length > mostMarks ? [] : clip.keys).map((time) => mark(time, Number(scrub.max))));
    track.classList.toggle('dense', clip.keys.length > 24);
  };
  const mark = (time: number, end: number) => {
    const made = element('i', { title: say('Key at {seconds} s; drag it to another moment', { seconds: number(time, 2) }), 'data-time': time });
    made.style.setProperty('--at', String(time / end));
    made.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      made.setPointerCapture(event.pointerId);
      const box = track.getBoundingClientRect();
      const placeOf = (x: number) => Math.min(end, Math.max(0, Math.round(((x - box.left) / box.width) * end / frame) * frame));
      made.onpointermove = (move) => made.style.setProperty('--at', String(placeOf(move.clientX) / end));
      made.onpointerup = (up) => {
        made.onpointermove = made.onpointerup = null;
        const to = placeOf(up.clientX);
        if (Math.abs(to - time) < frame / 2) studio.showMoment(time);
        else void studio.run({ do: 'edit_keys', keys: [{ seconds: time }], shift: to - time });
      };
    });
    return made;
  };
  return { track, scrub, show };
}
