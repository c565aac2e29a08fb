// Joints added, deleted, hung elsewhere, named and locked by hand, and the surface that the brush paints.
import type { Command, Ray, SurfaceHit } from '../../engine/messages';
import type { Core } from './core';

export type JointCalls = ReturnType<typeof jointCalls>;

export function jointCalls(core: Core) {
  const { page, engine } = core;

  /** Joints of another rig have other numbers. */
  function selectNamed(name: string) {
    const joint = page.now.session?.joints.findIndex((known) => known.name === name) ?? -1;
    page.set({ selected: joint < 0 ? null : joint });
  }

  /** Where rays meet the surface. */
  const surface = async (rays: Ray[]): Promise<(SurfaceHit | null)[]> =>
    await core.guard(() => engine.ask({ kind: 'surface', rays })) ?? rays.map(() => null);

  return {
    surface,

    /** Shows what a stroke would leave; null: what there is. */
    async previewStroke(stroke: Command | null) {
      await core.guard(async () => core.onWeights(await engine.ask({ kind: 'preview', stroke })));
    },

    /** A new joint inside the surface there, below the selected one. */
    async placeJoint(ray: Ray) {
      const [hit] = await surface([ray]), { selected, session } = page.now;
      if (!hit || selected === null || !session) return;
      page.set({ placing: false });
      const names = session.joints.map(({ name }) => name);
      await core.run({ do: 'add_joint', parent: core.jointName(selected), position: hit.inside });
      const added = page.now.session?.joints.findIndex(({ name }) => !names.includes(name)) ?? -1;
      if (added >= 0) page.set({ selected: added });
    },

    async toggleLock(joint: number) {
      await core.run({ do: 'lock_weights', ...core.namedWith(joint), on: !page.now.session?.locked.includes(joint) });
    },

    async renameJoint(joint: number, name: string) { await core.run({ do: 'rename_joint', joint: core.jointName(joint), name }); },

    async deleteJoint(joint: number) {
      const parent = page.now.session?.joints[joint]?.parent ?? -1, name = parent < 0 ? '' : core.jointName(parent);
      await core.run({ do: 'delete_joint', joint: core.jointName(joint) });
      selectNamed(name);
    },

    async hangJoint(joint: number, parent: string) {
      const name = core.jointName(joint);
      await core.run({ do: 'reparent_joint', joint: name, parent });
      selectNamed(name);
    },
  };
}
