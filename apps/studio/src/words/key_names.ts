import { say, type Words } from './say';

const named: readonly Words[] = ['Ctrl', 'Shift', 'Del', 'Space', 'Home', 'Escape'];

/** "Ctrl+Z" as the keyboards of the language have it. */
export const keyNames = (keys: string) => keys.replace(/[A-Z][a-z]+/g, (word) => {
  const known = named.find((name) => name === word);
  return known ? say(known) : word;
});
