// Cards that stand in rows.

export interface FocusedCard {
  root: HTMLElement;
  press: HTMLElement;
}

/** Arrows go from card to card, over the ends of rows. */
export function arrowsMoveFocus(event: KeyboardEvent, cards: readonly FocusedCard[], from: FocusedCard) {
  const shown = cards.filter(({ root }) => !root.hidden), at = shown.indexOf(from);
  const inRow = shown.filter(({ root }) => root.offsetTop === from.root.offsetTop && root.parentElement === from.root.parentElement).length;
  const way = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -inRow, ArrowDown: inRow }[event.key];
  if (way === undefined) return;
  event.preventDefault();
  shown[at + way]?.press.focus();
}
