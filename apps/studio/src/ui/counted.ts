import { say, type Words } from '../words/say';

type Noun<W> = W extends `{count} ${infer N}s` ? N : never;

/** "1 joint", "3 joints". */
export const counted = (count: number, noun: Noun<Words>) => say(`{count} ${noun}s`, { count });
