// How much time the timeline and what opens below it show.
import type { SessionState } from '../engine/messages';

export type Clip = SessionState['clips'][number];

const room = 2; // seconds that a clip made by hand shows at least, so that keys can be set behind its last one

export const chosenClip = (session: SessionState | null): Clip | null => session?.clips[session.clip ?? -1] ?? null;
export const shownSeconds = (clip: Clip, seconds: number) => Math.max(clip.duration, clip.recorded ? 0 : room, seconds, ...clip.keys);
