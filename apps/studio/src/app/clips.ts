// The clips of a scene on one clock.
import type { SessionState } from '../engine/messages';

export type Clip = SessionState['clips'][number];

export const chosenClip = (session: SessionState | null): Clip | null => session?.clips[session.clip ?? -1] ?? null;

/** What a clip shows that plays again and again; its end is shown once. As the engine has it (set_clock). */
export const momentOf = (clip: Clip | null, seconds: number) =>
  (!clip || clip.duration <= 0 || seconds <= clip.duration ? seconds : seconds % clip.duration);

/** Seconds of the longest clip that a member shows; 0 where nothing moves. */
export const sceneDuration = (session: SessionState | null) => Math.max(0, ...session?.members.map(({ duration }) => duration) ?? []);
