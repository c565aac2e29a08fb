// What comes into the scene beside the model that is there.
import { samples } from '../app/samples';
import type { Studio } from '../app/studio';
import { button, element, fileInput } from '../ui/dom';
import { say } from '../words/say';

export const modelFiles = '.glb,.gltf,.vrm,.obj,.fbx,.stl,.ply,.zip,.bin,.mtl,.png,.jpg,.jpeg';

export function addDialog(studio: Studio): { button: HTMLButtonElement; dialog: HTMLDialogElement } {
  const prop = element('input', { type: 'checkbox', id: 'as-prop' });
  const file = fileInput('member-file', { accept: modelFiles }, (files) => {
    dialog.close();
    void studio.addFiles(files, prop.checked);
  });
  const dialog: HTMLDialogElement = element('dialog', { id: 'add-member', class: 'ask', 'aria-label': say('Add to the scene') },
    element('h2', {}, say('Add to the scene')),
    element('label', { class: 'check', title: say('One piece with a single handle: a sword, a chair, a ball') }, prop, say('As a prop that does not bend')),
    element('div', { class: 'row samples' }, ...samples.map(([name, text]) => {
      const made = button(say(text), () => {
        dialog.close();
        void studio.addSample(name, prop.checked);
      });
      made.dataset['sample'] = name;
      return made;
    })),
    element('div', { class: 'row' }, button(say('Cancel'), () => dialog.close(), { id: 'close-add' }),
      button(say('From a file\u2026'), () => file.click(), { icon: 'open', id: 'add-file', kind: 'primary' })), file);
  const opener = button(say('Add'), () => dialog.showModal(), {
    icon: 'add', id: 'open-add', label: say('Another model or a prop beside this one; or drop a file with Shift held'),
  });
  return { button: opener, dialog };
}
