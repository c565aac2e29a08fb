// How much time the timeline and what opens below it show.
import type { Clip } from '../app/clips';

export { chosenClip, type Clip } from '../app/clips';

const room = 2; // seconds that a clip made by hand shows at least, so that keys can be set behind its last one

export const shownSeconds = (clip: Clip, seconds: number) => Math.max(clip.duration, clip.recorded ? 0 : room, seconds, ...clip.keys);
