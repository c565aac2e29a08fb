// Models that the engine makes itself: its name for each, and what a person calls it.
import type { Words } from '../words/say';

export const samples = [
  ['winged', 'Dragon'], ['quadruped', 'Fox'], ['biped', 'Person'], ['robot', 'Robot'], ['stool', 'Stool'],
] as const satisfies [string, Words][];
