import type { Limber } from './limber.d.mts';
export type * from './limber.d.mts';
export type { Command, KeyOfJoint, PoseKey, Ray, SurfaceDab, Vector } from './commands.js';

export interface LoadOptions {
  /** The bytes of limber/wasm, or the code compiled, where it is at hand; else it is read or fetched. */
  wasmBinary?: BufferSource | WebAssembly.Module;
  /** How far a call is: the fraction, 0 to 1, of the stage. What it throws stops the call, and is thrown by it. */
  onProgress?: (stage: string, fraction: number) => void;
  /** How errors name options: existingRig: 'replace' (as they do if nothing is said), or --replace-rig. */
  optionNames?: 'javascript' | 'program';
}

/** The engine, on this thread. */
export function load(options?: LoadOptions): Promise<Limber>;
