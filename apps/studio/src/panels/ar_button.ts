// The way into augmented reality, shown where the device has one, and what is in the menu about it.
import type { Desk } from '../ar/desk';
import { findWays, waysOf } from '../ar/ways';
import { button } from '../ui/dom';
import { say } from '../words/say';
import type { MenuEntry } from './more_menu';

const waysIn = () => import('../ar/ways_in'), cards = () => import('../ar/card/card_dialogs');

export function arButton(desk: Desk): HTMLElement {
  const view = button(say('View in AR'), () => void waysIn().then(({ viewInAr }) => viewInAr(desk)), {
    kind: 'primary', label: say('View in AR: the models in the real place that the camera sees'), id: 'view-in-ar',
  });
  view.hidden = true;
  let asked = '';
  const look = () => void findWays(desk.page.now).then((ways) => { view.hidden = waysOf(ways).length === 0; });
  // A way can depend on the model, and on a camera or a headset that is plugged in.
  desk.page.watch(({ session }) => {
    const name = session?.name ?? '';
    if (name === asked) return;
    asked = name;
    look();
  });
  for (const devices of [navigator.mediaDevices, navigator.xr]) devices?.addEventListener('devicechange', look);
  return view;
}

export const arMenu = (desk: Desk): MenuEntry[] => [
  { id: 'ar-ways', text: say('Ways to view in AR'), act: () => void waysIn().then(({ listWays }) => listWays(desk)) },
  { id: 'ar-print-card', text: say('Print the card'), act: () => void cards().then(({ printCardDialog }) => printCardDialog()) },
  { id: 'ar-show-card', text: say('Show the card'), act: () => void cards().then(({ showCardDialog }) => showCardDialog()) },
];
