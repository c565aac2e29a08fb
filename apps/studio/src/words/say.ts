// What the page says, in the language that is chosen in "More", else in that of the browser. English is written where it
// is said; every other language is one table from the English words to its own, and a text that a table lacks does not
// compile. Texts that the engine makes are in engine.ts, parts of bodies in parts.ts.
import { remembered } from '../app/remembered';
import { english } from './english';
import type { Forms } from './forms';
import type { german } from './german';

export type Words = keyof typeof german;
/** Those that have a singular and plurals, by {count}. */
export type Counted = { [W in Words]: (typeof german)[W] extends string ? never : W }[Words];

/** By their tags, as they call themselves. */
export const languages = { en: 'English', de: 'Deutsch' };
export type Language = keyof typeof languages;
const tags = Object.keys(languages) as Language[];
type Table = Partial<Record<Words, string | Forms>>;
/** Fetched where they are spoken. */
const tables: Record<Language, () => Promise<Table>> = {
  en: async () => english,
  de: async () => (await import('./german')).german satisfies Record<Words, string | Forms>,
};

/** What was chosen on this machine; "system" is the browser's own. */
export const languageChoices = ['system', ...tags] as const;
export const keptLanguage = () => remembered('language', languageChoices, 'system');

/** ?language=de in the address, else what was chosen, else the first language of the browser that is known, else English. */
function chosenLanguage(): Language {
  const asked = new URLSearchParams(location.search).get('language');
  const wanted = [asked, keptLanguage(), ...navigator.languages].flatMap((tag) => tag?.split('-')[0]?.toLowerCase() ?? []);
  for (const tag of wanted) {
    const known = tags.find((one) => one === tag);
    if (known) return known;
  }
  return 'en';
}

export const language = chosenLanguage();
const table = await tables[language](), plurals = new Intl.PluralRules(language);

export type Values = Record<string, string | number>;

/** The words, with each {name} in them replaced by its value. */
export function say(words: Words, values: Values = {}): string {
  const entry = table[words] ?? words;
  const text = typeof entry === 'string' ? entry : entry[plurals.select(Number(values['count']))] ?? entry.other;
  return text.replace(/\{(\w+)\}/g, (whole, name: string) => {
    const value = values[name];
    return typeof value === 'number' ? value.toLocaleString(language) : value ?? whole;
  });
}

/** With so many digits behind the point, or the comma. */
export const number = (value: number, digits = 0) =>
  value.toLocaleString(language, { minimumFractionDigits: digits, maximumFractionDigits: digits });
export const percent = (value: number) =>
  value.toLocaleString(language, { style: 'percent', minimumFractionDigits: 1, maximumFractionDigits: 1 });
export const inSeconds = (value: number, digits: number) => `${number(value, digits)} s`;
