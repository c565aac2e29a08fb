// The document beside what other methods make of it.
import type { Command, MethodKind } from '../../engine/messages';
import { chosenClip } from '../clips';
import type { Core } from './core';

export type ComparingCalls = ReturnType<typeof comparingCalls>;

export function comparingCalls(core: Core) {
  const { page, engine } = core;
  let underWay = false;
  core.followSteps(() => {
    const { session, comparison } = page.now;
    if (comparison && session?.dragged === null) void makeVariants();
  });

  /** Anew after each change of the document; the newest wish counts. */
  async function makeVariants() {
    if (underWay) return;
    underWay = true;
    await core.guard(async () => {
      for (let wanted = page.now.comparison; wanted; wanted = page.now.comparison) {
        const { session } = page.now;
        const { kind, names } = wanted;
        const commands = names.map((name) => commandFor(kind, name)).filter((command) => command !== null);
        const { measures, variants, stance } = await engine.ask({ kind: 'compare', commands });
        if (page.now.session !== session || page.now.comparison !== wanted) continue;
        page.set({ comparison: { kind, names, measures, variants } });
        core.showStance(stance, false);
        return;
      }
    });
    underWay = false;
  }

  function commandFor(kind: MethodKind, name: string): Command | null {
    const { session } = page.now;
    if (!session) return null;
    const { rigger, skinning } = session;
    switch (kind) {
      case 'rigger': return { do: 'choose_methods', rigger: name, skinning };
      case 'skinning': return { do: 'choose_methods', rigger, skinning: name };
      case 'deformer': return { do: 'set_deformer', deformer: name };
      case 'solver': return { do: 'set_ik', on: true, solver: name };
      case 'retargeting': {
        const source = chosenClip(session)?.source;
        return source ? { do: 'retarget', ...source, method: name, map: JSON.stringify({ matches: session.match }) } : null;
      }
    }
  }

  return {
    async compare(kind: MethodKind, names: string[]) {
      page.set({ comparison: { kind, names, variants: [], measures: null } });
      await makeVariants();
    },

    async endComparison() {
      page.set({ comparison: null });
      await core.guard(async () => { await engine.ask({ kind: 'compare', commands: [] }); });
    },
  };
}
