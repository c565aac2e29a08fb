// The ways into AR that this device has, the best first, and why it has not the others.
import type { Notice } from '../app/state';
import { button, element } from '../ui/dom';
import { say } from '../words/say';
import { allWays, type Lack, type Way, type Ways } from './ways';

/** `there`: in the order to show. `take` is called within the tap. */
export function waysDialog(there: Way[], ways: Ways, trouble: Notice | null, take: (way: Way) => void) {
  const words = wordsOfWays(), title = trouble?.title ?? say('Ways to view in AR');
  const dialog = element('dialog', { class: 'ask ways', id: 'ways', 'aria-label': title }, element('h2', {}, title));
  const close = () => dialog.remove();
  const entry = (way: Way) => {
    const [name, line] = words[way], made = element('button', { type: 'button', class: 'button plain way', 'data-way': way }, element('strong', {}, name), element('span', {}, line));
    made.addEventListener('click', () => {
      close();
      take(way);
    });
    return element('li', {}, made, way === 'card' ? theCard() : null);
  };
  if (trouble) dialog.append(element('p', { role: 'alert' }, trouble.detail, ' ', say('These ways are left:')));
  else if (there.length === 0) dialog.append(element('p', {}, say('This device shows models in 3D on its screen alone.')));
  dialog.append(element('ul', { class: 'way-list' }, ...there.map(entry)));
  const lacking = allWays.filter((way) => ways[way] !== null && ways[way] !== 'needless');
  if (lacking.length > 0) {
    dialog.append(element('details', { open: there.length === 0 }, element('summary', {}, say('Not on this device')),
      element('dl', {}, ...lacking.flatMap((way) => [element('dt', {}, words[way][0]), element('dd', {}, wordsOfLacks()[ways[way]!])]))));
  }
  dialog.append(element('div', { class: 'row' }, button(say('Cancel'), close, { id: 'ways-close' })));
  dialog.addEventListener('close', close);
  document.body.append(dialog);
  dialog.showModal();
}

/** No card at hand? */
function theCard(): HTMLElement {
  const print = button(say('Print the card'), () => void import('./card/card_dialogs').then(({ printCardDialog }) => printCardDialog()), { id: 'ways-print-card' });
  return element('p', { class: 'the-card' }, say('No card? Open this page on a computer, and choose More, then Show the card.'), ' ', print);
}

const wordsOfWays = (): Record<Way, [string, string]> => ({
  webxr: [say('In the room'), say('The device knows the place: put models on the floor, walk round them, pose them.')],
  card: [say('On a card'), say('A printed card, or one on another screen, carries the model: walk round it, pose it.')],
  camera: [say('Camera view'), say('The model in front of what the camera sees. Turning the device looks round; walking does not move the view, as nothing tracks the place.')],
  'quick-look': [say('AR Quick Look'), say('The viewer of the device, with this pose: to look at, not to pose.')],
  'scene-viewer': [say('Scene Viewer'), say('The viewer of the device, with the file as it is at its address, without your pose.')],
  share: [say('Share the file'), say('The model in this pose, for an app or a device that shows it in AR.')],
});

const wordsOfLacks = (): Record<Lack, string> => ({
  insecure: say('The page must be opened by https.'),
  'no-webxr': say('This browser has no WebXR for AR.'),
  'no-camera': say('No camera was found.'),
  'no-sensors': say('No motion sensors were found.'),
  'not-apple': say('Only iPhones and iPads have it.'),
  'not-android': say('Only Android has it.'),
  'no-address': say('The model needs an address on the web, as of a page opened with ?model=.'),
  'no-sharing': say('This browser does not share models.'),
  needless: '',
});
