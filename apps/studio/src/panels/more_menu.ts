// The menu "More": other formats to save as, what augmented reality needs, the language, the size of the text.
import { asked } from '../app/beginning';
import { remember } from '../app/remembered';
import { setTextSize, textSize, type TextSize } from '../app/text_size';
import { element } from '../ui/dom';
import { keptLanguage, languageChoices, languages, say, type Words } from '../words/say';

export type Outlet = 'model' | 'obj' | 'stl' | 'bvh' | 'usdz' | 'limber' | 'session' | 'record' | 'pictures';

/** What leaves the page besides GLB. */
const outlets: [Outlet, Words][] = [
  ['model', 'FBX, VRM, USD\u2026 for another program'],
  ['obj', 'OBJ, posed surface'], ['stl', 'STL, posed surface'], ['bvh', 'BVH, the clip'], ['usdz', 'USDZ, for AR Quick Look'],
  ['limber', 'Limber file, everything to go on with'], ['session', 'Session in a GLB'], ['record', 'Commands, for limber session replay'],
  ['pictures', 'Pictures and films\u2026'],
];
const sizes: [TextSize, Words][] = [['normal', 'Normal text'], ['large', 'Large text'], ['largest', 'Largest text']];

/** Said when the page is made: so it is made anew, with what was worked on last. */
function setLanguage(choice: (typeof languageChoices)[number]) {
  remember('language', choice);
  location.assign(location.pathname + (asked.live ? '?live' : ''));
}

export type MenuEntry = { id: string; text: string; act: () => void };

export function moreMenu(save: (outlet: Outlet) => void, augmented: MenuEntry[], help: () => void): { root: HTMLSelectElement; outlets: HTMLOptionElement[] } {
  const option = (text: string, act: () => void, chosen = false) => {
    const made = element('option', {}, chosen ? `\u2713 ${text}` : text);
    acts.set(made, act);
    return made;
  };
  const acts = new Map<Element, () => void>();
  const root = element('select', { 'aria-label': say('More: save as another format, augmented reality, language, size of the text, help'), class: 'select', id: 'export-as' });
  const files = outlets.map(([outlet, text]) => {
    const made = option(say(text), () => save(outlet));
    made.value = outlet;
    return made;
  });
  const reality = augmented.map(({ id, text, act }) => {
    const made = option(text, act);
    made.value = id;
    return made;
  });
  const helping = option(say('Help'), help);
  helping.value = 'help';
  const fill = () => root.replaceChildren(element('option', { value: '' }, say('More')), element('optgroup', { label: say('Save as') }, ...files),
    element('optgroup', { label: say('Augmented reality') }, ...reality),
    element('optgroup', { label: say('Language') }, ...languageChoices.map((choice) => {
      const made = option(choice === 'system' ? say('As the browser') : languages[choice], () => setLanguage(choice), choice === keptLanguage());
      made.value = choice;
      if (choice !== 'system') made.lang = choice;
      return made;
    })),
    element('optgroup', { label: say('Size of the text') }, ...sizes.map(([size, text]) => {
      const made = option(say(text), () => {
        setTextSize(size);
        fill();
      }, size === textSize());
      made.value = size;
      return made;
    })), helping);
  fill();
  root.addEventListener('change', () => {
    const act = acts.get(root.selectedOptions[0]!);
    root.value = '';
    act?.();
  });
  return { root, outlets: files };
}
