// The parts of the surface: asked for where they are shown, and anew where the rig or its weights are others.
import type { SessionState } from '../../engine/messages';
import type { Core } from './core';

export function bindParts(core: Core) {
  const { page, engine } = core;
  let askedFor: SessionState | null = null;
  page.watch(({ display, session, parts }) => {
    if (display !== 'parts' || !session || parts || askedFor === session) return;
    askedFor = session;
    void core.guard(() => engine.ask({ kind: 'parts' })).then((found) => {
      if (askedFor !== session) return;
      askedFor = null;
      if (!found) page.set({ display: 'surface' });
      else if (page.now.session === session) page.set({ parts: found });
      else page.set({}); // a newer document asks again
    });
  });
}
