// Begins augmented reality; fetched when the user asks for it.
import { ask } from '../ui/ask';
import { say } from '../words/say';
import { arPanel } from './ar_panel';
import { arProbe } from './ar_probe';
import { ArView } from './ar_view';
import type { Desk } from './desk';
import type { Sight } from './sight';
import { WebXrSight } from './webxr_sight';

/** Resolves once the models are seen in the real place, or the browser has refused: `refused` says what then. */
export async function beginAr(desk: Desk, sight: Sight, refused: (why: unknown) => Promise<void>) {
  if (desk.page.now.ar || !desk.page.now.session) return;
  const { studio, page } = desk, panel = arPanel(desk), askAtDesk = studio.ask;
  document.body.append(panel.root);
  const view = new ArView(desk, sight, panel.root);
  panel.show(view);
  view.onEnd = (byItself) => {
    studio.ask = askAtDesk;
    delete globalThis.limberStudio?.ar;
    panel.close();
    if (byItself) page.set({ notice: { kind: 'note', title: say('The device has ended augmented reality'), detail: say('Everything is as you left it.') } });
  };
  try {
    await sight.start(view);
  } catch (error) {
    view.close(false);
    return refused(error);
  }
  studio.ask = (title, detail, yes) => ask(title, detail, yes, panel.root);
  view.begin();
  if (globalThis.limberStudio) globalThis.limberStudio.ar = arProbe(view);
  if (sight instanceof WebXrSight && !sight.hasOverlay && sight.session?.interactionMode !== 'screen-space') (await import('./headset/headset')).beginHeadset(view, sight);
}
