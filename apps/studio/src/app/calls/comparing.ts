// The document beside what other methods make of it.
import { refusal } from '../../engine/client';
import type { Command } from '../../engine/messages';
import { say } from '../../words/say';
import { chosenClip } from '../clips';
import { obstacleOf, reportRows, rigCommands } from '../report_rows';
import type { Comparison } from '../state';
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
        const commands = names.map((name) => commandsFor(kind, name));
        const { measures, variants, stance } = await engine.ask({ kind: 'compare', commands });
        if (page.now.session !== session || page.now.comparison !== wanted) continue;
        page.set({ comparison: { kind, names, measures, variants } });
        core.showStance(stance, false);
        return;
      }
    });
    underWay = false;
  }

  /** None: it cannot be made of this document. */
  function commandsFor(kind: Comparison['kind'], name: string): Command[] {
    const { session } = page.now;
    if (!session) return [];
    const { rigger, skinning } = session;
    switch (kind) {
      case 'rigger': return [{ do: 'choose_methods', rigger: name, skinning }];
      case 'skinning': return [{ do: 'choose_methods', rigger, skinning: name }];
      case 'deformer': return [{ do: 'set_deformer', deformer: name }];
      case 'solver': return [{ do: 'set_ik', on: true, solver: name }];
      case 'retargeting': {
        const source = chosenClip(session)?.source;
        return source ? [{ do: 'retarget', ...source, method: name, map: JSON.stringify({ matches: session.match }) }] : [];
      }
      case 'report': {
        const row = page.now.report.find((one) => one.name === name);
        if (!row) return [];
        return row.kind === 'rig' ? rigCommands(row) : commandsFor('retargeting', row.retargeting);
      }
    }
  }

  async function compare(kind: Comparison['kind'], names: string[]) {
    page.set({ comparison: { kind, names, variants: [], measures: null } });
    await makeVariants();
  }

  return {
    compare,

    /** A study's cells.json: its first row that the page can do stands beside the model. */
    async openReport(file: File) {
      const rows = await core.guard(async () => {
        const read = reportRows(await file.text());
        if (!read?.length) throw refusal(say('It holds no rows of a study\u2019s report'), file.name, say('limber study writes them as cells.json'));
        return read;
      });
      const { session, methods } = page.now;
      if (!rows) return;
      if (!session || !methods) return page.set({ notice: { kind: 'note', title: say('A report needs a model to compare with'), detail: say('open a model first') } });
      page.set({ report: rows });
      const hasMotion = Boolean(chosenClip(session)?.source);
      const first = rows.find((row) => obstacleOf(row, methods, hasMotion) === null);
      if (first) return compare('report', [first.name]);
      page.set({ notice: { kind: 'note', title: say('The page can do none of the report\u2019s rows with this model'), detail: rows.map(({ name }) => name).join('; ') } });
    },

    async endComparison() {
      page.set({ comparison: null });
      await core.guard(async () => { await engine.ask({ kind: 'compare', commands: [] }); });
    },
  };
}
