// The card for AR on paper, and on this screen in its true size. Fetched when it is asked for.
import { remember, rememberedText } from '../../app/remembered';
import { button, element, offer } from '../../ui/dom';
import { say } from '../../words/say';
import { cardAlone, cardSheet, cardWithRim, papers, type Paper } from './card_drawing';

/** Of a bank card (ISO/IEC 7810, ID-1), in millimetres. */
const bankCard = { width: 85.6, height: 53.98 };
/** CSS pixels for a millimetre: what CSS says, and what screens are known to have. */
const perMillimetre = { css: 96 / 25.4, least: 2, most: 12 };
const kept = 'pixels-per-millimetre';

function open(dialog: HTMLDialogElement) {
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

/** In North America Letter, else A4. */
const usualPaper = (): Paper => (/-(US|CA|MX)$/i.test(navigator.language) ? 'letter' : 'a4');

export function printCardDialog() {
  const preview = element('div', { class: 'card-preview' });
  const paper = element('select', { class: 'select', id: 'card-paper' }, element('option', { value: 'a4' }, 'A4'), element('option', { value: 'letter' }, 'Letter'));
  const chosen = () => paper.value as Paper, show = () => preview.replaceChildren(cardSheet(chosen()));
  paper.value = usualPaper();
  paper.addEventListener('change', show);
  show();
  const dialog: HTMLDialogElement = element('dialog', { class: 'ask', id: 'print-card', 'aria-label': say('Print the card') },
    element('h2', {}, say('Print the card')),
    element('p', {}, say('A camera that sees this card knows where it is: models stand on it. Print it at 100 % and measure the line below it.')),
    preview, element('div', { class: 'field' }, element('label', { for: 'card-paper' }, say('Paper')), paper),
    element('div', { class: 'row' }, button(say('Close'), () => dialog.close(), { id: 'card-close' }),
      button(say('Save SVG'), () => offer(new XMLSerializer().serializeToString(cardSheet(chosen())), 'image/svg+xml', `limber_card_${chosen()}.svg`), { id: 'card-save' }),
      button(say('Print'), () => printSheet(chosen()), { id: 'card-print', kind: 'primary' })));
  open(dialog);
}

/** The sheet alone, in a frame of its own. */
function printSheet(paper: Paper) {
  const frame = element('iframe', { class: 'print-frame', 'aria-hidden': 'true', tabindex: -1, title: say('Print the card') });
  document.body.append(frame);
  const { contentDocument: page, contentWindow: seen } = frame;
  const style = page!.createElement('style');
  style.textContent = `@page { size: ${papers[paper].page}; margin: 0 } body { margin: 0 } svg { display: block }`;
  page!.head.append(style);
  page!.body.append(page!.importNode(cardSheet(paper), true));
  seen!.addEventListener('afterprint', () => frame.remove());
  seen!.print();
}

/** Millimetres of CSS are seldom true: a bank card, held against the screen, tells how long they are. */
export function showCardDialog() {
  const before = Number(rememberedText(kept));
  const size = element('input', {
    type: 'range', id: 'card-scale', min: perMillimetre.least, max: perMillimetre.most, step: 0.01,
    value: before >= perMillimetre.least && before <= perMillimetre.most ? before : perMillimetre.css,
  });
  const outline = element('div', { class: 'bank-card' }, element('span', {}, say('A bank card is as large as this'))), shown = element('div', { class: 'shown-card' }, cardAlone());
  const fit = () => {
    const scale = Number(size.value);
    outline.style.width = `${bankCard.width * scale}px`;
    outline.style.height = `${bankCard.height * scale}px`;
    shown.style.width = shown.style.height = `${cardWithRim * scale}px`;
  };
  size.addEventListener('input', () => {
    fit();
    remember(kept, size.value);
  });
  fit();
  const dialog: HTMLDialogElement = element('dialog', { class: 'ask show-card', id: 'show-card', 'aria-label': say('Show the card') },
    element('h2', {}, say('Show the card')),
    element('div', { class: 'true-size' }, shown, element('div', {},
      element('p', {}, say('Point the camera of the phone at this screen. Hold a bank card against it and move the slider until both are equally large: then models have their real size.')),
      element('div', { class: 'field' }, element('label', { for: 'card-scale' }, say('Size on this screen')), size), outline)),
    element('div', { class: 'row' }, button(say('Close'), () => dialog.close(), { id: 'card-close' })));
  open(dialog);
}
