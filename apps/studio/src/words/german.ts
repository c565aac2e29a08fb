// German, by the English words. Young people are addressed, so "du".
export const german = {
  'Both sides': 'Beide Seiten',
  'Leave it as it is': 'So lassen',
} as const satisfies Record<string, string>;
