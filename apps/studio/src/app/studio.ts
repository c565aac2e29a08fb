// Everything that a user can do, each a call on the engine's session; panels and the view call this and nothing else.
// What belongs to one idea is in one file of calls/.
import type { ExportFormat, SaveAs, SavedModel } from '../engine/messages';
import { clipCalls } from './calls/clips';
import { comparingCalls } from './calls/comparing';
import { Core } from './calls/core';
import { dragCalls } from './calls/drags';
import { ghostCalls } from './calls/ghosts';
import { jointCalls } from './calls/joints';
import { keyingCalls } from './calls/keying';
import { liveCalls } from './calls/live';
import { memberCalls } from './calls/members';
import { motionCalls } from './calls/motions';
import { bindParts } from './calls/parts';
import { openingCalls } from './calls/opening';
import { posingCalls } from './calls/posing';
import { rigCalls } from './calls/rig';
import { selectionCalls } from './calls/selection';
import { undoNotices } from './calls/undo_notices';
import type { Journal } from './journal';
import type { PageStore } from './state';

/** What leaves the engine, and how it is stopped. */
const outcomeCalls = (core: Core) => ({
  async exportFile(format: ExportFormat): Promise<Uint8Array | null> { return core.guard(() => core.engine.ask({ kind: 'export', format })); },
  async targets(): Promise<string[] | null> { return core.guard(() => core.engine.ask({ kind: 'targets' })); },
  async saveModel(as: SaveAs): Promise<SavedModel | null> { return core.guard(() => core.engine.ask({ kind: 'save', as })); },
  async record(): Promise<string | null> { return core.guard(() => core.engine.ask({ kind: 'record' })); },
  async stop() {
    core.page.set({ comparison: null });
    await core.engine.cancel();
  },
});

function allCalls(core: Core, journal: Journal) {
  const comparing = comparingCalls(core), keying = keyingCalls(core), motions = motionCalls(core);
  const posing = posingCalls(core), { told } = undoNotices(core, posing.undo);
  const clips = clipCalls(core), rig = rigCalls(core, told), joints = jointCalls(core), members = memberCalls(core);
  return {
    ...openingCalls(core, journal, clips, motions, rig, comparing), ...members, ...motions, ...clips, ...keying, ...ghostCalls(core),
    ...posing, ...dragCalls(core, rig), ...selectionCalls(core, joints, members, rig), ...rig, ...joints, ...comparing,
    ...liveCalls(core, motions), ...outcomeCalls(core),
  };
}

export type Studio = ReturnType<typeof allCalls> &
  Pick<Core, 'run' | 'guard' | 'idle' | 'readStance' | 'onStance' | 'onWeights' | 'onOpened' | 'onPoses' | 'onCrowd' | 'ask'>;

export function createStudio(page: PageStore, journal: Journal): Studio {
  const core = new Core(page);
  bindParts(core);
  return Object.assign(core, allCalls(core, journal));
}
