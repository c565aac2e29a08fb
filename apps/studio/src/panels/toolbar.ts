// The bar on top: open, undo, what leaves the page.
import type { Journal } from '../app/journal';
import { samples, scenes } from '../app/samples';
import { mediaTypes, stemOf } from '../app/saved_files';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { ExportFormat } from '../engine/messages';
import type { Viewport } from '../scene/viewport';
import { button, element, icon, offer } from '../ui/dom';
import { arriving } from '../ui/loaded_when_opened';
import { addDialog } from './add_dialog';
import { moreMenu, type MenuEntry } from './more_menu';
import { pictureDialog } from './picture_dialog';
import { recent } from './recent';
import { chosenClip } from './moments';
import { say } from '../words/say';

const filmRate = 30; // pictures a second
const movingRate = 20; // pictures a second of an animated PNG, each of which is a whole picture
const turnSeconds = 4; // of a film all the way round

export function toolbar(studio: Studio, page: PageStore, journal: Journal, viewport: Viewport, augmented: MenuEntry[]): HTMLElement {
  const kept = recent(studio, journal), adding = addDialog(studio);
  const file = element('input', {
    type: 'file', accept: '.glb,.gltf,.vrm,.obj,.fbx,.stl,.ply,.bvh,.npz,.vrma,.json,.zip,.limber,.bin,.mtl,.png,.jpg,.jpeg', multiple: true, hidden: true, id: 'file',
  });
  file.addEventListener('change', () => {
    const chosen = [...file.files ?? []];
    if (chosen.length > 0) void studio.openFiles(chosen);
    file.value = '';
  });
  const sample = element('select', { 'aria-label': say('Open a sample'), class: 'select', id: 'samples' },
    element('option', { value: '' }, say('Samples')),
    element('optgroup', { label: say('Models') }, ...samples.map(([value, text]) => element('option', { value }, say(text)))),
    element('optgroup', { label: say('Scenes') }, ...scenes.map(([value, text]) => element('option', { value }, say(text)))));
  sample.addEventListener('change', () => {
    const scene = scenes.find(([name]) => name === sample.value);
    if (scene) void studio.openScene(scene[0], say(scene[1]));
    else if (sample.value !== '') void studio.openSample(sample.value);
    sample.value = '';
  });

  const stem = () => stemOf(page.now);
  const save = async (format: Exclude<ExportFormat, 'ply'>) => {
    const bytes = await studio.exportFile(format);
    const ending = format === 'session' ? '_session.glb' : format === 'bvh' ? '.bvh' : `_posed.${format}`;
    if (bytes) offer(bytes as BlobPart, mediaTypes[format], stem() + ending);
  };
  /** The surface as a picture should have it, whatever is shown now. */
  const onSurface = async (act: () => Promise<void>) => {
    const { display } = page.now;
    if (display === 'handles') page.set({ display: 'surface' });
    await studio.guard(act);
    page.set({ display });
  };
  const pictures = pictureDialog({
    picture: (background) => onSurface(async () => {
      const picture = await viewport.picture(background);
      if (picture) offer(picture, 'image/png', `${stem()}.png`);
    }),
    clip: (background) => onSurface(async () => {
      const clip = chosenClip(page.now.session);
      if (!clip) return;
      const moments = Math.max(2, Math.ceil(clip.duration * filmRate));
      offer(await viewport.film(filmRate, background, (draw) => studio.eachMoment(moments, draw)), 'video/webm', `${clip.name}.webm`);
    }),
    moving: (background) => onSurface(async () => {
      const clip = chosenClip(page.now.session);
      if (!clip) return;
      const { animatedPng } = await import('../app/animated_png'), moments = Math.max(2, Math.round(clip.duration * movingRate));
      const made = await viewport.pictures(background, (draw) => studio.eachMoment(moments, draw, { repeats: true }));
      if (made.length > 0) offer(await animatedPng(made, movingRate), 'image/png', `${clip.name}.png`);
    }),
    turn: (background) => onSurface(async () => {
      offer(await viewport.turn(filmRate, turnSeconds, background), 'video/webm', `${stem()}_turn.webm`);
    }),
  });
  const saveModel = async () => {
    const make = await studio.guard(() => arriving(import('./save_dialog')));
    if (make) await make.saveDialog(studio, page);
  };
  const saveRecord = async () => {
    const record = await studio.record();
    if (record) offer(record, 'application/json', `${stem()}_commands.json`);
  };
  const more = moreMenu((outlet) => {
    if (outlet === 'pictures') pictures.open(chosenClip(page.now.session) !== null);
    else if (outlet === 'model') void saveModel();
    else if (outlet === 'limber') offer(studio.limberFile() as BlobPart, 'application/zip', `${stem()}.limber`);
    else if (outlet === 'record') void saveRecord();
    else void save(outlet);
  }, augmented, () => page.set({ help: true }));
  const undo = button('', () => void studio.undo(), { icon: 'undo', label: say('Undo'), keys: 'Ctrl+Z', id: 'undo' });
  const redo = button('', () => void studio.redo(), { icon: 'redo', label: say('Redo'), keys: 'Ctrl+Shift+Z', id: 'redo' });
  const glb = button(say('Save GLB'), () => void save('glb'), { icon: 'save', kind: 'primary', id: 'save-glb' });
  const name = element('h1', { class: 'name' }, 'limber');
  page.watch(({ session }) => {
    undo.disabled = !session?.undo;
    redo.disabled = !session?.redo;
    glb.disabled = adding.button.disabled = !session;
    for (const option of more.outlets) option.disabled = !session || (option.value === 'bvh' && chosenClip(session) === null);
    name.textContent = session?.name ?? 'limber';
    document.title = session ? `${session.name} \u2013 limber studio` : 'limber studio';
  });
  return element('header', { class: 'bar' },
    button(say('Open'), () => file.click(), { icon: 'open', id: 'open' }), element('div', { class: 'samples' }, icon('samples'), sample), adding.button, adding.dialog, pictures.dialog, kept.button, kept.dialog, file, name,
    element('div', { class: 'group' }, undo, redo), element('div', { class: 'group' }, glb, more.root),
    button('', () => page.set({ help: true }), { icon: 'help', label: say('Keyboard and mouse'), keys: '?', id: 'help-button' }));
}
