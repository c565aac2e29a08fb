// What the page begins with: reloaded, what this tab had; else ?model=address, ?scene=name or ?sample=name; else what was worked on
// last, or the first sample, so that there is something to take hold of.
import type { Request } from '../engine/messages';
import { documentOfTab, mayHaveDocuments } from './remembered';
import { openSample, samples } from './samples';

const parameters = new URLSearchParams(location.search);
export const asked = { address: parameters.get('model') || null, scene: parameters.get('scene') || null, sample: parameters.get('sample'), live: parameters.has('live') };

const [visit] = performance.getEntriesByType('navigation') as PerformanceNavigationTiming[];
/** The document that this tab had before it was reloaded. */
export const documentBefore = visit?.type === 'reload' ? documentOfTab() : null;

export const firstSample = asked.sample ?? samples[0][0];

/** What the engine will be asked first, as far as that is known at once. */
export function likelyFirst(): Request | null {
  const { address, scene, sample } = asked, other = documentBefore !== null || address !== null || scene !== null || (sample === null && mayHaveDocuments());
  return other ? null : { kind: 'run', command: openSample(firstSample) };
}
