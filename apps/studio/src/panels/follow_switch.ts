// Whether a dragged handle takes its limb along or stretches the surface alone: the same switch at the desk and in augmented reality.
import type { Studio } from '../app/studio';
import type { SessionState } from '../engine/messages';
import { choice } from '../ui/dom';
import { say } from '../words/say';

type LimbState = 'follow' | 'alone';

export const limbStates = (): { value: LimbState; text: string; label: string; keys: string }[] => [
  { value: 'follow', text: say('Follow'), keys: 'I', label: say('Follow: a dragged handle takes its limb along (inverse kinematics)') },
  { value: 'alone', text: say('Stretch'), keys: 'I', label: say('Stretch: a dragged handle moves alone, and the surface stretches') },
];
export const limbState = (session: SessionState | null): LimbState => (session?.ik ? 'follow' : 'alone');

export function followSwitch(studio: Studio, id: string) {
  const { root, show } = choice<LimbState>(say('What happens to the limb of a dragged handle'), limbStates(), (value) => void studio.setIk(value === 'follow'));
  root.id = id;
  return {
    root,
    show(session: SessionState | null) {
      show(limbState(session));
      root.querySelectorAll('button').forEach((each) => { each.disabled = !session; });
    },
  };
}
