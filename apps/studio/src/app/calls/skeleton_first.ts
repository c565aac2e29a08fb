// What needs joints that have names, on a model whose handles have none.
import { EngineError } from '../../engine/client';
import { canBeNamed, type Trial } from '../../engine/messages';
import { counted } from '../../ui/counted';
import { warningText } from '../../words/engine';
import { say } from '../../words/say';
import type { Core } from './core';

/** What is tried beside the document fits it then. A model whose handles have no names gets a skeleton first, where the
 *  user agrees; else all stays as it was: null. */
export async function withSkeleton(core: Core, title: string, attempt: (named: boolean) => Promise<Trial>): Promise<Trial | null> {
  const state = core.page.now.session;
  let trial = await attempt(false);
  if (state && canBeNamed(trial.error, state)) {
    const refused = trial.error;
    trial = await attempt(true);
    if (trial.error) throw new EngineError(refused ?? trial.error);
    const agreed = await core.ask(title,
      [
        say('Its {handles} will be replaced by a skeleton of {joints} with names.', { handles: counted(state.joints.length, 'handle'), joints: counted(trial.joints, 'joint') }),
        ...trial.warnings.map((warning) => say('Please look at the result: {warning}.', { warning: warningText(warning) })),
        say('Undo takes it back.'),
      ].join(' '),
      say('Give it a skeleton'));
    if (!agreed) return null;
    core.take(await core.engine.run({ do: 'choose_methods', rigger: 'template', skinning: state.skinning }));
  }
  if (trial.error) throw new EngineError(trial.error);
  return trial;
}
