// The way into augmented reality, shown where the device has one.
import type { Desk } from '../ar/desk';
import { button } from '../ui/dom';
import { say } from '../words/say';

export function arButton(desk: () => Desk): HTMLElement {
  const view = button(say('View in AR'), () => void import('../ar/begin').then(({ beginAr }) => beginAr(desk())), {
    kind: 'primary', label: say('View in AR: the models in the real place that the camera sees'), id: 'view-in-ar',
  });
  view.hidden = true;
  void canView().then((can) => { view.hidden = !can; });
  return view;
}

const canView = async () => await navigator.xr?.isSessionSupported('immersive-ar').catch(() => false) ?? false;
