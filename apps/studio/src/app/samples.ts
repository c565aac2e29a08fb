// Models that the engine makes itself: its name for each, and what a person calls it.
import type { Command } from '../engine/messages';
import type { Words } from '../words/say';

export const samples = [
  ['winged', 'Dragon'], ['quadruped', 'Fox'], ['biped', 'Person'], ['theropod', 'Dinosaur'], ['robot', 'Robot'], ['stool', 'Stool'], ['footstool', 'Footstool'], ['flying', 'Flying dragon'],
] as const satisfies [string, Words][];

export const openSample = (name: string): Command => ({ do: 'open_sample', name, limbs_follow: true });

/** What can be made of them: lists of commands in samples/scenes, by the names of their files. */
export const scenes = [
  ['dancing-stool', 'Dancing stool'], ['standing-dinosaur', 'Standing dinosaur'], ['eating-dinosaur', 'Eating dinosaur'], ['sitting-dragon', 'Sitting dragon'],
] as const satisfies [string, Words][];

const records = import.meta.glob<{ limber_commands: number; commands: Command[] }>('../../../../samples/scenes/*.json', { import: 'default' });

/** Fetched when it is asked for; null where there is no scene of that name. */
export async function sceneRecord(name: string) {
  const fetched = Object.entries(records).find(([path]) => path.endsWith(`/${name}.json`));
  return fetched ? fetched[1]() : null;
}
