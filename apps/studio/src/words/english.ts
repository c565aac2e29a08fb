// English is written where it is said; here stand only the forms of what is counted.
import type { Forms } from './forms';
import type { Counted } from './say';

export const english: Record<Counted, Forms> = {
  '{count} vertices': { one: '{count} vertex', other: '{count} vertices' },
  '{count} triangles': { one: '{count} triangle', other: '{count} triangles' },
  '{count} handles': { one: '{count} handle', other: '{count} handles' },
  '{count} joints': { one: '{count} joint', other: '{count} joints' },
  '{count} bodies': { one: '{count} body', other: '{count} bodies' },
  '{count} parts': { one: '{count} part', other: '{count} parts' },
  '{count} keys': { one: '{count} key', other: '{count} keys' },
  '{count} keys chosen': { one: '{count} key chosen', other: '{count} keys chosen' },
  '{count} steps': { one: '{count} step', other: '{count} steps' },
  '{count} moments of {clip}': { one: '{count} moment of {clip}', other: '{count} moments of {clip}' },
  'Search {count} motions': { one: 'Search {count} motion', other: 'Search {count} motions' },
};
