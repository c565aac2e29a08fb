// The card as a drawing in millimetres: alone, and on a sheet of paper with a ruler that tells whether it was printed true.
import { AR } from 'js-aruco2/src/aruco.js';
import 'js-aruco2/src/dictionaries/aruco_mip_16h3.js';
import { say } from '../../words/say';
import { cardId, cardSide, cellsAcross, dictionary } from './card';

const cell = (1000 * cardSide) / cellsAcross; // millimetres
/** Millimetres: the card with its white rim, without which it is not found. */
export const cardWithRim = (cellsAcross + 2) * cell;
const ruler = 100; // millimetres

export const papers = { a4: { width: 210, height: 297, page: 'A4' }, letter: { width: 215.9, height: 279.4, page: 'letter' } };
export type Paper = keyof typeof papers;

function drawing(tag: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}

const rectangle = (x: number, y: number, width: number, height: number, fill: string) => drawing('rect', { x, y, width, height, fill });

/** Its upper left corner, that of the rim, at (x, y). */
function card(x: number, y: number): SVGElement {
  const code = AR.DICTIONARIES[dictionary]!.codeList[cardId]!, bits = cellsAcross - 2, cells: SVGElement[] = [];
  for (let bit = 0; bit < bits * bits; ++bit) {
    if (!((code >> (bits * bits - 1 - bit)) & 1)) continue;
    cells.push(rectangle((2 + (bit % bits)) * cell, (2 + Math.floor(bit / bits)) * cell, cell, cell, '#fff'));
  }
  return drawing('g', { transform: `translate(${x} ${y})`, 'shape-rendering': 'crispEdges' },
    rectangle(0, 0, cardWithRim, cardWithRim, '#fff'), rectangle(cell, cell, cellsAcross * cell, cellsAcross * cell, '#000'), ...cells);
}

/** As large as its box. */
export const cardAlone = () => drawing('svg', { viewBox: `0 0 ${cardWithRim} ${cardWithRim}`, role: 'img', 'aria-label': say('The card for AR') }, card(0, 0));

export function cardSheet(paper: Paper): SVGElement {
  const { width, height } = papers[paper], left = (width - cardWithRim) / 2, top = 30, line = top + cardWithRim + 25, from = (width - ruler) / 2;
  const text = (y: number, words: string) => drawing('text', { x: width / 2, y, 'text-anchor': 'middle', 'font-size': 4.2, 'font-family': 'sans-serif' }, words);
  const ticks = Array.from({ length: ruler / 10 + 1 }, (_, i) => `M${from + 10 * i} ${line}v${i % 5 === 0 ? -4 : -2.5}`).join('');
  return drawing('svg', { xmlns: 'http://www.w3.org/2000/svg', width: `${width}mm`, height: `${height}mm`, viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': say('The card for AR') },
    rectangle(0, 0, width, height, '#fff'), text(20, say('limber: the card for AR. Print it at 100 %, not fitted to the page.')), card(left, top),
    drawing('rect', { x: left, y: top, width: cardWithRim, height: cardWithRim, fill: 'none', stroke: '#999', 'stroke-width': 0.2, 'stroke-dasharray': '2 2' }),
    drawing('path', { class: 'ruler', d: `M${from} ${line}h${ruler}${ticks}`, fill: 'none', stroke: '#000', 'stroke-width': 0.3 }),
    text(line + 8, say('This line is 100 mm long. If it is not, the models have another size.')),
    text(line + 18, say('Keep the white rim. Lay the card flat, in good light, without shine.')));
}
