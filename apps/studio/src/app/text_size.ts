// How large the page writes, on top of what the browser is set to.
import { remember, remembered } from './remembered';

export const textSizes = ['normal', 'large', 'largest'] as const;
export type TextSize = (typeof textSizes)[number];

export const textSize = () => remembered('text', textSizes, 'normal');

export function setTextSize(size: TextSize) {
  remember('text', size);
  document.documentElement.dataset['text'] = size;
}
