// Keys of the chosen clip, each of one joint at one moment.
import type { SessionState } from '../engine/messages';
import type { KeyPlace } from './state';

export const frame = 1 / 30; // seconds that keys snap to
const same = 5e-4; // seconds: the engine takes keys closer together than this for one

/** As the command edit_keys has it. */
export interface KeyChange {
  shift?: number;
  scale?: number;
  pivot?: number;
  copy?: boolean;
}

/** Joints of a pose, to be keys at a moment. */
export interface PoseKey {
  pose: string;
  joints: number[];
  seconds: number;
}

export const changedTime = (seconds: number, { shift = 0, scale = 1, pivot = 0 }: KeyChange) => pivot + scale * (seconds - pivot) + shift;
export const onFrame = (seconds: number) => Math.round(seconds / frame) * frame;
export const sameKey = (a: KeyPlace, b: KeyPlace) => a.joint === b.joint && Math.abs(a.seconds - b.seconds) < same;

export function keysOf(session: SessionState | null): KeyPlace[] {
  const clip = session?.clips[session.clip ?? -1];
  return clip?.joint_keys.flatMap(({ joint, seconds }) => seconds.map((at) => ({ joint, seconds: at }))) ?? [];
}

/** Of these, those that the chosen clip has, at the moment that the engine knows them by. */
export function keysThere(keys: readonly KeyPlace[], session: SessionState | null): KeyPlace[] {
  if (keys.length === 0) return [];
  return keysOf(session).filter((there) => keys.some((key) => sameKey(key, there)));
}

/** First and last moment. */
export const extentOf = (keys: readonly KeyPlace[]): [number, number] => [
  Math.min(...keys.map(({ seconds }) => seconds)), Math.max(...keys.map(({ seconds }) => seconds)),
];
