import type { Limber } from './limber.d.mts';
export type * from './limber.d.mts';
export type { Command, KeyOfJoint, PoseKey, Ray, SurfaceDab, Vector } from './commands.js';

/** The engine. wasmBinary: the bytes of limber/wasm, where they are at hand; else they are read or fetched. */
export function load(options?: { wasmBinary?: Uint8Array | ArrayBuffer }): Promise<Limber>;
