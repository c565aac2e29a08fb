// What the page says, in the language of the browser. English is written where it is said; every other language is one
// table from the English words to its own, and a text that a table lacks does not compile.
import { german } from './german';

export type Words = keyof typeof german;

const tables: Record<string, Record<Words, string>> = { de: german };
export const languages = ['en', ...Object.keys(tables)];

/** ?language=de in the address, else the first language of the browser that is known, else English. */
function chosenLanguage(): string {
  const asked = new URLSearchParams(location.search).get('language');
  const wanted = [asked, ...navigator.languages].flatMap((tag) => tag?.split('-')[0]?.toLowerCase() ?? []);
  return wanted.find((tag) => languages.includes(tag)) ?? 'en';
}

export const language = chosenLanguage();
const table = tables[language];

/** The words, with each {name} in them replaced by its value. */
export function say(words: Words, values: Record<string, string | number> = {}): string {
  return (table?.[words] ?? words).replace(/\{(\w+)\}/g, (whole, name: string) => {
    const value = values[name];
    return typeof value === 'number' ? value.toLocaleString(language) : value ?? whole;
  });
}
