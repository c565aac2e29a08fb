// The models of a scene: which is chosen, where they stand, what hangs on what.
import type { Placement, Ray } from '../../engine/messages';
import type { Core } from './core';

export function memberCalls(core: Core) {
  const { page } = core;
  const nameOf = (member: number) => page.now.session?.members[member]?.name ?? '';
  return {
    /** The member whose surface a ray meets first. */
    async memberUnder(ray: Ray): Promise<number | null> {
      const met = await core.guard(() => core.engine.ask({ kind: 'pick-member', ray }));
      return met?.member ?? null;
    },
    async chooseMember(member: number) {
      const { session } = page.now;
      if (session && member !== session.member) await core.run({ do: 'choose_member', member: nameOf(member) });
    },
    async placeMember(member: number, placement: Placement) { await core.run({ do: 'place_member', member: nameOf(member), ...placement }); },
    async attachMember(member: number, to: number, joint: string, snap: boolean) {
      await core.run({ do: 'attach_member', member: nameOf(member), to: nameOf(to), joint, snap });
    },
    async detachMember(member: number) { await core.run({ do: 'detach_member', member: nameOf(member) }); },
    async removeMember(member: number) { await core.run({ do: 'remove_member', member: nameOf(member) }); },
    async renameMember(member: number, name: string) { await core.run({ do: 'rename_member', member: nameOf(member), name }); },
  };
}

export type MemberCalls = ReturnType<typeof memberCalls>;
