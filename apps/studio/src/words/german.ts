import { germanScene } from './german_scene';

// German, by the English words. Young people are addressed, so "du".
export const german = {
  ...germanScene,
  'Both sides': 'Beide Seiten',
  'Leave it as it is': 'So lassen',
} as const satisfies Record<string, string>;
