// Keys of the chosen clip, and what is drawn of the whole clip: paths and curves.
import type { Vector } from '../../engine/messages';
import { chosenClip } from '../clips';
import { changedTime, keysThere, type KeyChange, type PoseKey } from '../keys';
import type { KeyPlace } from '../state';
import type { Core } from './core';

/** Commands that leave the model in another pose, set by hand. */
const poses = new Set(['end_drag', 'place_joint', 'set_turn', 'set_scale', 'reset_joint', 'reset_pose', 'mirror_pose', 'apply_pose', 'apply_tasks']);

export type KeyingCalls = ReturnType<typeof keyingCalls>;

export function keyingCalls(core: Core) {
  const { page, engine } = core;
  const draw = () => void core.guard(drawClip);
  core.followSteps(draw);
  core.followCommands(async (command) => {
    const { autoKey, session } = page.now;
    if (autoKey && session?.clip != null && poses.has(command.do)) await setKey();
  });
  page.watch((now, before) => {
    const curve = now.keyEditor === 'curves' && (now.selected !== before.selected || now.keyEditor !== before.keyEditor);
    if (curve || now.ghosts !== before.ghosts) draw();
  });

  async function drawClip() {
    const { session, ghosts, keyEditor, selected } = page.now;
    const clip = chosenClip(session), still = session?.dragged === null;
    if (!clip || clip.duration <= 0) return page.set({ paths: null, curve: null });
    if (!still) return;
    const [paths, curve] = await Promise.all([
      ghosts ? engine.ask({ kind: 'paths' }) : null,
      keyEditor === 'curves' && selected !== null ? engine.ask({ kind: 'curve', joint: selected }) : null,
    ]);
    const now = page.now;
    if (now.session === session && now.selected === selected && now.ghosts === ghosts && now.keyEditor === keyEditor) page.set({ paths, curve });
  }

  /** On recorded motion the correction comes and goes, instead of a jump of one frame. */
  async function setKey() {
    const { session, span } = page.now;
    await core.run({ do: 'set_key', span: chosenClip(session)?.recorded ? span : 0 });
  }

  const named = (keys: readonly KeyPlace[]) => keys.map(({ joint, seconds }) => ({ joint: core.jointName(joint), seconds }));

  return {
    setKey,

    /** They are the chosen ones afterwards. */
    async editKeys(keys: readonly KeyPlace[], change: KeyChange) {
      await core.run({ do: 'edit_keys', keys: named(keys), ...change });
      page.set({ chosenKeys: keysThere(keys.map(({ joint, seconds }) => ({ joint, seconds: changedTime(seconds, change) })), page.now.session) });
    },
    async deleteKeys(keys: readonly KeyPlace[]) { await core.run({ do: 'delete_keys', keys: named(keys) }); },

    /** How curves run through keys: as a smooth spline, or level. */
    async setTangents(keys: readonly KeyPlace[], tangents: 'auto' | 'flat') {
      await core.run({ do: 'set_tangents', keys: named(keys), tangents });
    },
    /** What its curves change by in a second there: degrees about x, y and z, and metres. */
    async setSlope(key: KeyPlace, turn: Vector, offset: Vector) {
      await core.run({ do: 'set_tangents', keys: named([key]), tangents: 'free', turn, offset });
    },

    /** The chosen clip's poses, as the texts of files. */
    async posesAt(moments: number[]): Promise<string[] | null> { return core.guard(() => engine.ask({ kind: 'poses-at', moments })); },
    /** Joints of such poses as keys; they are the chosen ones afterwards. */
    async pasteKeys(keys: readonly PoseKey[]) {
      await core.run({ do: 'paste_keys', keys: keys.map((key) => ({ ...key, joints: key.joints.map((joint) => core.jointName(joint)) })) });
      const pasted = keys.flatMap(({ joints, seconds }) => joints.map((joint) => ({ joint, seconds })));
      page.set({ chosenKeys: keysThere(pasted, page.now.session) });
    },

    /** From its rest pose: degrees about x, y and z, and metres. */
    async setJointKey({ joint, seconds }: KeyPlace, turn: Vector, offset: Vector) {
      await core.run({ do: 'set_joint_key', joint: core.jointName(joint), seconds, turn, offset });
    },
  };
}
