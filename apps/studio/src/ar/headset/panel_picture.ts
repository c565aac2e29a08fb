// Draws a panel's content, and tells which cell is where.
import { CanvasTexture, SRGBColorSpace } from 'three';
import { element, iconPath } from '../../ui/dom';
import type { Cell, PanelContent } from './panel_content';

/** Millimetres, as everything here. */
export const panelSize = { width: 300, height: 280 };
const density = 3.4; // pixels to a millimetre: at 0.6 m 36 a degree, where headsets show about 25
/** At 0.6 m an em of 13 is 1.24 degrees, of which capitals are 0.9, and a button of 34 is 3.2 degrees high. */
const text = 13, smallText = 10.5, lineHeight = 1.28, button = 34, gap = 6, edge = 12, corner = 7, iconSize = 16;
const colors = { back: '#171c26', cell: '#2c3444', hovered: '#41506d', pressed: '#2563eb', primary: '#2563eb', down: '#5b8bff', words: '#ffffff', quiet: '#9aa5b8', error: '#ffb4ab' };

/** From the panel's upper left corner. */
interface Box { x: number; y: number; width: number; height: number }

export class PanelPicture {
  readonly texture: CanvasTexture;
  private readonly context: CanvasRenderingContext2D;
  private boxes: { cell: Cell; box: Box }[] = [];

  constructor() {
    const canvas = element('canvas', { width: Math.round(panelSize.width * density), height: Math.round(panelSize.height * density) });
    this.context = canvas.getContext('2d')!;
    this.context.scale(density, density);
    this.texture = new CanvasTexture(canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.anisotropy = 4;
  }

  /** The one at a point, as far as it can be pressed. */
  cellAt(x: number, y: number): Cell | null {
    const found = this.boxes.find(({ box }) => x >= box.x - gap / 2 && x <= box.x + box.width + gap / 2 && y >= box.y - gap / 2 && y <= box.y + box.height + gap / 2);
    return found?.cell.enabled ? found.cell : null;
  }

  middleOf(id: string): { x: number; y: number } | null {
    const found = this.boxes.find(({ cell }) => cell.id === id);
    return found ? { x: found.box.x + found.box.width / 2, y: found.box.y + found.box.height / 2 } : null;
  }

  draw({ title, detail, error, rows }: PanelContent, hovered: ReadonlySet<string>, down: ReadonlySet<string>) {
    const { context } = this, { width, height } = panelSize;
    context.clearRect(0, 0, width, height);
    this.fill({ x: 0, y: 0, width, height }, 14, colors.back);
    const above = this.write(title, edge, text, error ? colors.error : colors.words, detail === '' ? 3 : 2);
    if (detail !== '') this.write(detail, above + smallText / 2, smallText, colors.quiet, 4);
    const shown = rows.filter((row) => row.length > 0);
    this.boxes = shown.flatMap((row, r) => {
      const y = height - edge - (shown.length - r) * (button + gap) + gap, wide = (width - 2 * edge - (row.length - 1) * gap) / row.length;
      return row.map((cell, c) => ({ cell, box: { x: edge + c * (wide + gap), y, width: wide, height: button } }));
    });
    for (const { cell, box } of this.boxes) this.drawCell(cell, box, hovered.has(cell.id), down.has(cell.id));
    this.texture.needsUpdate = true;
  }

  private drawCell({ text: words, icon, enabled, pressed, primary, id }: Cell, box: Box, hovered: boolean, down: boolean) {
    const { context } = this, { x, y, width, height } = box, tells = !enabled && id === 'handles';
    if (!tells) this.fill(box, corner, down ? colors.down : pressed ? colors.pressed : primary ? colors.primary : hovered ? colors.hovered : colors.cell);
    if (hovered && (pressed || primary)) this.outline(box);
    const color = enabled || tells ? colors.words : colors.quiet;
    const size = this.fitting(words, width - (icon ? iconSize + gap : 0) - 2 * gap);
    const wide = context.measureText(words).width, all = wide + (icon ? iconSize + (words === '' ? 0 : gap) : 0);
    let at = x + (width - all) / 2;
    if (icon) {
      this.drawIcon(icon, at, y + (height - iconSize) / 2, color);
      at += iconSize + gap;
    }
    if (words === '') return;
    context.fillStyle = color;
    context.textBaseline = 'middle';
    context.fillText(words, at, y + height / 2 + size * 0.04);
  }

  /** The size at which the words have room; it is the context's font then. */
  private fitting(words: string, room: number): number {
    this.font(text);
    const size = text * Math.min(1, room / Math.max(1, this.context.measureText(words).width));
    this.font(size);
    return size;
  }

  private drawIcon(icon: NonNullable<Cell['icon']>, x: number, y: number, color: string) {
    const { context } = this;
    context.save();
    context.translate(x, y);
    context.scale(iconSize / 20, iconSize / 20);
    context.strokeStyle = color;
    context.lineWidth = 1.8;
    context.lineCap = context.lineJoin = 'round';
    context.stroke(new Path2D(iconPath(icon)));
    context.restore();
  }

  /** Broken into lines; gives where the next one would begin. What does not fit ends in dots. */
  private write(words: string, y: number, size: number, color: string, most: number): number {
    const { context } = this, room = panelSize.width - 2 * edge, lines: string[] = [''];
    this.font(size);
    for (const word of words.split(/\s+/)) {
      const longer = `${lines.at(-1)!} ${word}`.trim();
      if (context.measureText(longer).width <= room || lines.at(-1) === '') lines[lines.length - 1] = longer;
      else lines.push(word);
    }
    if (lines.length > most) lines.splice(most - 1, lines.length, `${lines[most - 1]!}\u2026`);
    context.fillStyle = color;
    context.textBaseline = 'top';
    lines.forEach((line, l) => context.fillText(line, edge, y + l * size * lineHeight, room));
    return y + lines.length * size * lineHeight;
  }

  private font(size: number) { this.context.font = `500 ${size}px system-ui, sans-serif`; }

  private fill({ x, y, width, height }: Box, radius: number, color: string) {
    this.context.fillStyle = color;
    this.context.beginPath();
    this.context.roundRect(x, y, width, height, radius);
    this.context.fill();
  }

  private outline({ x, y, width, height }: Box) {
    this.context.strokeStyle = colors.words;
    this.context.lineWidth = 1;
    this.context.beginPath();
    this.context.roundRect(x, y, width, height, corner);
    this.context.stroke();
  }
}
