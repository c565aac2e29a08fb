// Small pieces of page. Whatever text goes in becomes a text node, never markup.
import { keyNames } from '../words/key_names';

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | null>;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === false) continue;
    made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

export function svg<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Record<string, string | number> = {}): SVGElementTagNameMap[K] {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

const icons = {
  open: 'M3 17V5h5l2 2h7v10z',
  samples: 'M10 2.5 16.5 6v8L10 17.5 3.5 14V6zM3.5 6l6.5 3.5L16.5 6M10 9.5v8',
  undo: 'M8 4 4 8l4 4M4 8h8a4 4 0 0 1 0 8H9',
  redo: 'm12 4 4 4-4 4m4-4H8a4 4 0 0 0 0 8h3',
  move: 'M10 2v16M2 10h16M10 2 8 4m2-2 2 2M10 18l-2-2m2 2 2-2M2 10l2-2m-2 2 2 2m14-2-2-2m2 2-2 2',
  turn: 'M16 10a6 6 0 1 1-2-4.5M14 2v4h-4',
  scale: 'M3 17h6v-6H3zM9 3h8v8M17 3l-7 7',
  mirror: 'M10 2v16M7 5 2 15h5zM13 5l5 10h-5z',
  reset: 'M4 10a6 6 0 1 0 2-4.5M6 2v4h4',
  save: 'M10 3v9m-4-4 4 4 4-4M4 16h12',
  camera: 'M3 6h3l2-2h4l2 2h3v10H3zM10 8a3 3 0 1 0 .01 0',
  help: 'M7.5 7.5a2.5 2.5 0 1 1 3.5 2.3c-.7.3-1 .8-1 1.7M10 14.5v.5',
  brush: 'M17 3 9 11M9 11c-3 0-3 3-3 4s-1 2-3 2c4 1 8-1 8-4 0-1-1-2-2-2z',
  pin: 'M10 18v-6M6 12h8l-2-4V3H8v5z',
  motions: 'M11.5 2.5a1.5 1.5 0 1 0 .01 0M5 9l3-2 3 1 2 3h3M11 8l-2 4 3 2v4M9 12l-2 3H3',
  play: 'm6 4 10 6-10 6z',
  pause: 'M7 4v12M13 4v12',
  loop: 'M4 10a5 5 0 0 1 5-5h6m-3-3 3 3-3 3M16 10a5 5 0 0 1-5 5H5m3 3-3-3 3-3',
  key: 'm10 4 6 6-6 6-6-6z',
  erase: 'M5 6h10M8 6V4h4v2M6 6l1 11h6l1-11',
  add: 'M10 4v12M4 10h12',
  edit: 'M4 16l1-4 8-8 3 3-8 8z',
  compare: 'M3 5h6v10H3zM11 5h6v10h-6z',
  sequence: 'M2 4h10v5H2zM8 11h10v5H8z',
  sheet: 'M3 4h14v12H3zM3 10h14M8 4v12M13 4v12',
  eye: 'M2 10s3-5 8-5 8 5 8 5-3 5-8 5-8-5-8-5zM10 8a2 2 0 1 0 .01 0',
  recent: 'M10 3a7 7 0 1 0 .01 0M10 6v4l3 2',
  rows: 'M3 5h5M3 10h5M3 15h5m5-12 2 2-2 2-2-2zm-1 5 2 2-2 2-2-2zm3 5 2 2-2 2-2-2z',
  copy: 'M7 7h10v10H7zM13 7V3H3v10h4',
  paste: 'M5 4h10v13H5zM8 2h4v4H8z',
  ghosts: 'M4 17V8a4 4 0 0 1 8 0v9l-2-2-2 2-2-2zm10 0V8a4 4 0 0 0-3-3.9',
  select: 'M3 6V3h3m3 0h2m3 0h3v3m0 3v1M3 9v2m0 3v3h3m3 0h1M11 11l6.5 2.4-2.9 1.2-1.2 2.9z',
  magnet: 'M4 3v7a6 6 0 0 0 12 0V3h-4v7a2 2 0 0 1-4 0V3zM4 7h4m4 0h4',
  frame: 'M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4',
};
export type IconName = keyof typeof icons;

/** In a box of 20 by 20. */
export const iconPath = (name: IconName) => icons[name];

export function icon(name: IconName): SVGSVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 20 20');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', icons[name]);
  svg.append(path);
  return svg;
}

export function setIcon(of: HTMLElement, name: IconName) {
  of.querySelector('path')?.setAttribute('d', icons[name]);
}

export interface ButtonOptions {
  icon?: IconName;
  /** Said to a screen reader and shown on hover; the text of the button where there is none. */
  label?: string;
  keys?: string;
  id?: string;
  kind?: 'plain' | 'primary';
}

export function button(text: string, act: () => void, options: ButtonOptions = {}): HTMLButtonElement {
  const label = options.label ?? text;
  const made = element('button', {
    type: 'button', class: `button ${options.kind ?? 'plain'}`, id: options.id ?? null,
    'aria-label': text === '' ? label : null, title: options.keys ? `${label} (${keyNames(options.keys)})` : label,
  }, options.icon ? icon(options.icon) : null, text === '' ? null : element('span', {}, text));
  made.addEventListener('click', act);
  return made;
}

/** Where files are chosen, several at once; asked for by its click(). `folder`: all files of one. */
export function fileInput(id: string, { accept, folder = false }: { accept?: string; folder?: boolean }, take: (files: File[]) => void): HTMLInputElement {
  const input = element('input', { type: 'file', accept: accept ?? null, multiple: true, webkitdirectory: folder, hidden: true, id });
  input.addEventListener('change', () => {
    const files = [...input.files ?? []];
    if (files.length > 0) take(files);
    input.value = '';
  });
  return input;
}

/** Buttons of which one is pressed. */
export function choice<T extends string>(
  label: string, options: { value: T; text: string; icon?: IconName; keys?: string; label?: string }[], choose: (value: T) => void,
): { root: HTMLElement; show(value: T): void } {
  const buttons = options.map(({ value, text, ...rest }) => {
    const made = button(text, () => choose(value), rest);
    made.dataset['value'] = value;
    return made;
  });
  return {
    root: element('div', { class: 'choice', role: 'group', 'aria-label': label }, ...buttons),
    show: (value) => buttons.forEach((b) => b.setAttribute('aria-pressed', String(b.dataset['value'] === value))),
  };
}

export function offer(bytes: BlobPart, type: string, name: string) {
  const link = element('a', { href: URL.createObjectURL(new Blob([bytes], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
