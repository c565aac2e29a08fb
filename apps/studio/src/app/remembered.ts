// What of the page's look this browser keeps from visit to visit, and which document is whose.
const prefix = 'limber.';

/** Whatever was put there; empty where there is nothing. */
export function rememberedText(name: string): string {
  try {
    return localStorage.getItem(prefix + name) ?? '';
  } catch {
    return '';
  }
}

/** A browser that keeps nothing, or text that is not what was put there, gives `otherwise`. */
export function remembered<T extends string>(name: string, known: readonly T[], otherwise: T): T {
  const kept = rememberedText(name);
  return known.find((value) => value === kept) ?? otherwise;
}

export function remember(name: string, value: string) {
  try {
    localStorage.setItem(prefix + name, value);
  } catch {
    // it is as on a first visit then
  }
}

const document = `${prefix}document`;
/** The one that this tab had last. */
export function documentOfTab(): string | null {
  try {
    return sessionStorage.getItem(document);
  } catch {
    return null;
  }
}
export function noteDocumentOfTab(id: string) {
  try {
    sessionStorage.setItem(document, id);
  } catch {
    // a reload brings back what was changed last, in whatever tab
  }
}

const documents = 'documents';
/** Known without a wait, and sometimes wrong: the journal has the truth. */
export const mayHaveDocuments = () => rememberedText(documents) !== '';
export const noteDocuments = (any: boolean) => remember(documents, any ? 'some' : '');
