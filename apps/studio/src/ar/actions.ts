// What can be done in augmented reality by buttons: on the screen of a phone, and on the panel in space of a headset.
import { sceneDuration } from '../app/clips';
import { togglePlaying } from '../app/player';
import type { DragMode, PageState } from '../app/state';
import type { IconName } from '../ui/dom';
import { say } from '../words/say';
import type { ArView } from './ar_view';
import type { Desk } from './desk';

export interface ArAction {
  id: string;
  /** Empty where the icon says it. */
  text: string;
  label: string;
  icon?: (now: PageState) => IconName;
  act(): void;
  shown(now: PageState): boolean;
  enabled?(now: PageState): boolean;
  pressed?(now: PageState): boolean;
}

export interface ArActions {
  leave: ArAction;
  history: ArAction[];
  place: ArAction;
  tools: ArAction[];
}

export const isPlacing = ({ ar }: PageState) => ar?.step !== 'placed';
export const isPosing = (now: PageState) => !isPlacing(now) && now.display === 'handles';

/** What stands on a card has no place while the card is not seen; elsewhere there is a floor. */
export const hasFloor = ({ ar }: PageState) => ar !== null && !(ar.sight === 'card' && ar.trouble === 'lost');

export const dragModes = (): { value: DragMode; text: string; icon: IconName }[] => [
  { value: 'move', text: say('Move'), icon: 'move' }, { value: 'turn', text: say('Turn'), icon: 'turn' },
  { value: 'scale', text: say('Scale'), icon: 'scale' },
];

export function arActions({ studio, page }: Desk, view: () => ArView | null): ArActions {
  const always = () => true, placed = (now: PageState) => !isPlacing(now);
  return {
    leave: { id: 'ar-close', text: say('Close'), label: say('Back to the desk'), act: () => void view()?.leave(), shown: always },
    history: [
      { id: 'ar-undo', text: '', label: say('Undo'), icon: () => 'undo', act: () => void studio.undo(), shown: always, enabled: ({ session }) => Boolean(session?.undo) },
      { id: 'ar-redo', text: '', label: say('Redo'), icon: () => 'redo', act: () => void studio.redo(), shown: always, enabled: ({ session }) => Boolean(session?.redo) },
    ],
    place: { id: 'ar-place', text: say('Place it here'), label: say('Place it here'), act: () => void view()?.settle(), shown: (now) => isPlacing(now) && hasFloor(now) },
    tools: [
      {
        id: 'ar-pose', text: say('Pose'), label: say('Show handles to pose the model'), icon: () => 'motions', shown: placed, pressed: ({ display }) => display === 'handles',
        act: () => page.set({ display: page.now.display === 'handles' ? 'surface' : 'handles' }),
      },
      {
        id: 'ar-play', text: '', label: say('Play'), icon: ({ playing }) => (playing ? 'pause' : 'play'), act: () => togglePlaying(studio, page),
        shown: (now) => placed(now) && sceneDuration(now.session) > 0,
      },
      {
        id: 'ar-fit', text: say('Fit it in'), label: say('Make it small enough to be seen whole'), act: () => view()?.fitView(),
        shown: (now) => placed(now) && !isPosing(now) && Boolean(now.ar?.large),
      },
      { id: 'ar-again', text: say('Move it'), label: say('Look for another place for it'), icon: () => 'pin', act: () => view()?.placeAgain(), shown: placed },
    ],
  };
}
