// What is the matter in augmented reality, else what to do next.
import type { ArState, PageState } from '../app/state';
import { say } from '../words/say';

/** `hands`: on a headset, by hands or controllers; else by fingers on a screen. */
export function helpLine({ ar, display, mode }: PageState, hands: boolean): string {
  if (!ar) return say('Starting');
  if (ar.trouble === 'lost' && ar.sight === 'card') return say('The card is not seen. Point the camera at it: all of it in the picture, in good light');
  if (ar.trouble) return troubles()[ar.trouble];
  if (ar.large && display !== 'handles') return say('It is larger than the view. Fit it in, or make it smaller with two fingers');
  if (ar.sight === 'camera') {
    if (ar.step === 'placing') return ar.surface ? say('Tap to place the model here') : say('Point the device down, at the floor');
    if (display === 'handles' && mode === 'move') return say('Drag a handle; it keeps its distance from the device');
    if (display !== 'handles' && ar.realSize) return say('Turn the device to look round; walking does not move the view. Tap to pose, drag to move');
  }
  const step = ar.step === 'placing' ? (ar.surface ? 'place' : 'search') : display !== 'handles' ? (ar.realSize ? 'view' : 'size') : mode;
  return (hands ? byHands : byFingers)()[step];
}

const byFingers = () => ({
  place: say('Tap to place the model here'),
  search: say('Point the device at the floor or a table, and move it slowly'),
  view: say('Tap to pose it, drag to move it, two fingers turn and scale it'),
  size: say('Not its real size'),
  move: say('Drag a handle; walk with it to push or pull'),
  turn: say('Drag a handle to turn it about its parent'),
  scale: say('Drag a handle: up makes it larger, down smaller'),
});

const byHands = () => ({
  place: say('Pinch, or press the trigger, to place the model here'),
  search: say('Point at the floor or a table'),
  view: say('Point at the model and pinch to pose it. Hold it to move it, with both hands to turn and scale it'),
  size: say('Not its real size'),
  move: say('Pinch a handle and carry it, or drag it from afar with the ray'),
  turn: say('A near handle goes and turns with the hand. With the ray it turns about its parent'),
  scale: say('Drag a handle with the ray: up makes it larger, down smaller'),
});

const troubles = (): Record<NonNullable<ArState['trouble']>, string> => ({
  'no-surface': say('No surface found yet. Look at one with a pattern and enough light, or place the model before you'),
  lost: say('The place is lost for the moment. Move the device slowly, back to where it was'),
  hidden: say('Waiting. Everything is as you left it'),
  hand: say('The hand was out of sight. What it held stays as it is'),
});
