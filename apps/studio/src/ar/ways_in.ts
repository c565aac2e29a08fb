// Takes one of the ways that the device has, and says what is left where that fails. Fetched when AR is asked for, with all
// that a tap must find at hand: what asks for leave (camera, sensors) has to do so within the tap.
import type { Notice } from '../app/state';
import { say } from '../words/say';
import { beginAr } from './begin';
import { CardSight } from './card_sight';
import type { Desk } from './desk';
import { openQuickLook, openSceneViewer, shareModel } from './device_viewers';
import { NoOrientation, OrientationSight } from './orientation_sight';
import { PictureSight } from './picture_sight';
import { findWays, waysOf, type Way, type Ways } from './ways';
import { waysDialog } from './ways_dialog';
import { WebXrSight } from './webxr_sight';

/** Those that failed since the page was opened: offered last from then on. */
const failed = new Set<Way>();
/** Without the camera none of them. */
const looksThrough: ReadonlySet<Way> = new Set<Way>(['card', 'camera']);

/** At once where there is but one way, or the one that needs no other; else the user chooses. That a card is needed is said
 *  first. */
export async function viewInAr(desk: Desk) {
  const ways = await findWays(desk.page.now), there = waysOf(ways), untried = there.filter((way) => !failed.has(way));
  const clear = untried.includes('webxr') ? 'webxr' : there.length === 1 && there[0] !== 'card' ? there[0] : undefined;
  if (clear) await take(desk, clear);
  else offerWays(desk, ways);
}

/** All that the device has, and why it has not the others. */
export async function listWays(desk: Desk) { offerWays(desk, await findWays(desk.page.now)); }

function offerWays(desk: Desk, ways: Ways, trouble: Notice | null = null) {
  const later = (way: Way) => (failed.has(way) ? 1 : 0);
  waysDialog(waysOf(ways).sort((a, b) => later(a) - later(b)), ways, trouble, (way) => void take(desk, way));
}

/** Asks for leave before it waits for anything. */
function take(desk: Desk, way: Way): Promise<void> {
  const refused = (why: unknown) => fallBack(desk, way, why);
  switch (way) {
    case 'webxr': return beginAr(desk, new WebXrSight(), refused);
    case 'card': return beginAr(desk, new PictureSight(new CardSight()), refused);
    case 'camera': return beginAr(desk, new PictureSight(new OrientationSight()), refused);
    case 'quick-look': return openQuickLook(desk).catch(refused);
    case 'scene-viewer': return openSceneViewer(desk).catch(refused);
    case 'share': return shareModel(desk).catch(refused);
  }
}

/** What else there is, with what happened; where there is nothing else, what happened. */
async function fallBack(desk: Desk, way: Way, why: unknown) {
  if (looksThrough.has(way) && !(why instanceof NoOrientation)) looksThrough.forEach((one) => failed.add(one));
  else failed.add(way);
  const ways = await findWays(desk.page.now), trouble: Notice = { kind: 'error', ...reason(way, why) };
  if (waysOf(ways).some((other) => !failed.has(other))) offerWays(desk, ways, trouble);
  else desk.page.set({ notice: trouble });
}

function reason(way: Way, why: unknown): Pick<Notice, 'title' | 'detail'> {
  const name = why instanceof DOMException ? why.name : '';
  if (why instanceof NoOrientation) {
    return why.refused
      ? { title: say('The motion sensors are not allowed'), detail: say('Reload the page and allow them, or allow them in the settings of the browser.') }
      : { title: say('This device does not say how it is turned'), detail: say('Camera view needs motion sensors.') };
  }
  if (looksThrough.has(way)) {
    if (name === 'NotAllowedError' || name === 'SecurityError') return { title: say('The camera is not allowed'), detail: say('Allow it for this page in the settings of the browser, and try again.') };
    if (name === 'NotFoundError' || name === 'OverconstrainedError') return { title: say('There is no camera'), detail: say('Connect one, and try again.') };
    if (name === 'NotReadableError' || name === 'AbortError') return { title: say('The camera is in use'), detail: say('Close the other program that uses it, and try again.') };
  }
  if (way === 'scene-viewer') return { title: say('This device has no Scene Viewer'), detail: say('It comes with the Google app.') };
  if (way === 'webxr') return { title: say('This browser does not begin augmented reality'), detail: say('Allow it the camera and motion sensors, and try again. Everything else works as before.') };
  return { title: say('The model was not handed over'), detail: why instanceof Error ? why.message : String(why) };
}
