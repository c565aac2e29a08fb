// What needs joints that have names, on a model whose handles have none.
import { EngineError } from '../../engine/client';
import { canBeNamed, type Trial } from '../../engine/messages';
import { counted } from '../../ui/counted';
import { warningText } from '../../words/engine';
import { say } from '../../words/say';
import type { Core } from './core';

/** Does it; where the model's handles have no names for it, with a skeleton first, where the user agrees. Where it cannot be
 *  done all stays as it was. `trial`: whether it could be done with a skeleton. */
export async function withSkeleton(core: Core, title: string, act: () => Promise<void>, trial: () => Promise<Trial>) {
  const state = core.page.now.session;
  try {
    return await act();
  } catch (refused) {
    if (!state || !(refused instanceof EngineError) || !canBeNamed(refused.error, state)) throw refused;
    const { error, joints, warnings } = await trial();
    if (error) throw refused;
    const agreed = await core.ask(title,
      [
        say('Its {handles} will be replaced by a skeleton of {joints} with names.', { handles: counted(state.joints.length, 'handle'), joints: counted(joints, 'joint') }),
        ...warnings.map((warning) => say('Please look at the result: {warning}.', { warning: warningText(warning) })),
        say('Undo takes it back.'),
      ].join(' '),
      say('Give it a skeleton'));
    if (!agreed) return;
    core.take(await core.engine.run({ do: 'choose_methods', rigger: 'template', skinning: state.skinning }));
  }
  try {
    await act();
  } catch (refused) {
    core.take(await core.engine.run({ do: 'undo' }));
    throw refused;
  }
}
