// A model that leaves the page for another program: format, names and axes, clip, and what is lost. Loaded when it is first opened.
import { unpack } from '../app/files';
import { mediaTypes, stemOf } from '../app/saved_files';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { ModelFormat, SavedModel } from '../engine/messages';
import { button, element, offer } from '../ui/dom';
import { methodName, warningText } from '../words/engine';
import { number, say, type Words } from '../words/say';
import { chosenClip } from '../app/clips';

const formats: Record<ModelFormat, { name: string; told: Words; holdsOneClip?: true; hasOwnNames?: true }> = {
  fbx: { name: 'FBX', told: 'for Unreal, Unity, Blender, Maya' },
  vrm: { name: 'VRM', told: 'for people, as avatars', hasOwnNames: true },
  usdz: { name: 'USDZ', told: 'for AR Quick Look, one clip', holdsOneClip: true },
  usdc: { name: 'USDC', told: 'binary, one clip', holdsOneClip: true },
  usda: { name: 'USDA', told: 'as text, one clip', holdsOneClip: true },
  glb: { name: 'GLB', told: 'glTF binary' },
  gltf: { name: 'glTF', told: 'text, with its buffers, in a ZIP archive' },
};
const plain = 'gltf'; // the target that changes nothing
const programs: Record<string, string> = {
  unreal: 'Unreal Engine', unity: 'Unity', godot: 'Godot', blender: 'Blender', vrm: 'VRM', mixamo: 'Mixamo', metahuman: 'MetaHuman',
  rigify: 'Blender Rigify', actorcore: 'ActorCore, Character Creator', roblox: 'Roblox',
};

/** What is offered, and of what kind: an archive of one file is that file. */
function fileOf(format: ModelFormat, bytes: Uint8Array, stem: string): { bytes: Uint8Array; type: string; name: string } {
  if (format !== 'gltf' && format !== 'usda' && format !== 'usdc') return { bytes, type: mediaTypes[format], name: `${stem}.${format}` };
  const inside = [...unpack(bytes, stem).values()];
  if (inside.length > 1) return { bytes, type: mediaTypes.zip, name: `${stem}_${format}.zip` };
  return { bytes: inside[0]!, type: mediaTypes[format], name: `${stem}.${format}` };
}

const option = (value: string, text: string) => element('option', { value }, text);
const field = (label: Words, select: HTMLSelectElement) => element('div', { class: 'field' }, element('label', { for: select.id }, say(label)), select);

export async function saveDialog(studio: Studio, page: PageStore) {
  const targets = await studio.targets(), { session } = page.now;
  if (!targets || !session) return;
  const title = say('Save for another program');
  const format = element('select', { class: 'select', id: 'save-format' },
    ...Object.entries(formats).map(([value, { name, told }]) => option(value, `${name}, ${say(told)}`)));
  const target = element('select', { class: 'select', id: 'save-target' },
    ...targets.map((name) => option(name, name === plain ? say('as it is') : programs[name] ?? name)));
  const clip = element('select', { class: 'select', id: 'save-clip' },
    // In a scene the clips of its models have other names than each by itself.
    option('', say('the pose, without movement')), ...(session.members.length > 1 ? [] : session.clips).map(({ name }) => option(name, name)));
  clip.value = session.members.length > 1 ? '' : chosenClip(session)?.name ?? '';
  const names = field('Names and axes for', target), moves = field('Clip', clip);
  const told = element('p', { hidden: true }), lost = element('ul', { id: 'save-lost' }), result = element('div', { role: 'status' }, told, lost);
  const close = button(say('Cancel'), () => dialog.close(), { id: 'save-close' });
  const chosen = () => formats[format.value as ModelFormat];
  const fit = () => {
    names.hidden = chosen().hasOwnNames ?? false;
    moves.hidden = !chosen().holdsOneClip;
    told.hidden = true;
    lost.replaceChildren();
  };

  const tell = (name: string, { warnings }: SavedModel) => {
    const lines = warnings.map(({ kind, message, count }) => (count > 1 ? `${warningText({ kind, message })} (${number(count)})` : warningText({ kind, message })));
    const { deformer } = session;
    if (deformer !== 'linear-blend') lines.push(say('{name} is not kept: other programs bend the surface linearly', { name: methodName(deformer) }));
    if (lines.length === 0) return dialog.close();
    told.textContent = say('{file} is saved. Not as in the model:', { file: name });
    told.hidden = false;
    lost.replaceChildren(...lines.map((line) => element('li', {}, line)));
    close.querySelector('span')!.textContent = close.title = say('Close');
  };
  const save = button(say('Save'), async () => {
    const asked = { format: format.value as ModelFormat, target: chosen().hasOwnNames ? plain : target.value, clip: chosen().holdsOneClip ? clip.value : '' };
    save.disabled = true;
    const saved = await studio.saveModel(asked);
    save.disabled = false;
    if (!dialog.open) return; // cancelled
    if (!saved) return dialog.close(); // why not is told on the page
    const file = fileOf(asked.format, saved.bytes, stemOf(page.now) + (asked.target === plain ? '' : `_${asked.target}`));
    offer(file.bytes as BlobPart, file.type, file.name);
    tell(file.name, saved);
  }, { icon: 'save', kind: 'primary', id: 'save-model' });
  const dialog: HTMLDialogElement = element('dialog', { id: 'save-as', class: 'ask save', 'aria-label': title }, element('h2', {}, title),
    field('Format', format), names, moves, result, element('div', { class: 'row' }, close, save));
  format.addEventListener('change', fit);
  target.addEventListener('change', fit);
  dialog.addEventListener('close', () => dialog.remove());
  fit();
  document.body.append(dialog);
  dialog.showModal();
}
