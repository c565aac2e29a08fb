// Which joints are selected, and what a tap on the surface means.
import type { Ray } from '../../engine/messages';
import type { Core } from './core';
import type { JointCalls } from './joints';
import type { MemberCalls } from './members';
import type { RigCalls } from './rig';

export type SelectionCalls = ReturnType<typeof selectionCalls>;

export function selectionCalls(core: Core, { placeJoint }: JointCalls, { chooseMember, memberUnder }: MemberCalls, { pinJoint }: RigCalls) {
  const { page, engine } = core;
  page.watch((now, before) => {
    if (now.selected !== before.selected && now.also === before.also && now.also.size > 0) page.set({ also: new Set() });
  });

  /** Another joint that goes along with those that are selected, or no longer does. */
  function selectAlso(joint: number) {
    const { selected, also } = page.now;
    if (selected === null) return page.set({ selected: joint, also: new Set() });
    if (selected === joint) {
      const [next = null, ...rest] = also;
      return page.set({ selected: next, also: new Set(rest) });
    }
    const others = new Set(also);
    if (!others.delete(joint)) others.add(joint);
    page.set({ also: others });
  }

  return {
    selectAlso,

    /** The joint that holds the surface under the pointer; while joints are corrected, the selected one goes in there. */
    async selectSurface(ray: Ray, slope: number, besides = false) {
      if (page.now.placing) return placeJoint(ray);
      await core.guard(async () => {
        if ((page.now.session?.members.length ?? 0) > 1 && !page.now.correcting) {
          const met = await memberUnder(ray);
          if (met !== null && met !== page.now.session?.member) return chooseMember(met);
        }
        const hit = await engine.ask({ kind: 'pick', ray, slope });
        const { correcting, selected } = page.now;
        if (correcting && selected !== null && hit && !hit.on_handle) return pinJoint(selected, hit.inside);
        if (!besides) return page.set({ selected: hit?.joint ?? null });
        if (hit) selectAlso(hit.joint);
      });
    },
  };
}
