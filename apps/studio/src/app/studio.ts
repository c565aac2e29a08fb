// Everything that a user can do, each a call on the engine's session; panels and the view call this and nothing else.
import { EngineClient, EngineError } from '../engine/client';
import type { Answer, Command, MethodKind, Ray, SessionState, Stance, Vector } from '../engine/messages';
import { noticeOf, type PageStore } from './state';

type Step = Answer<'run'>;

const mostFileSize = 500e6;
const progressDelay = 250; // milliseconds before a wait is shown

const stageNames: Record<string, string> = {
  'read': 'Reading the model', 'read geometry': 'Reading the surface', 'weld': 'Joining the surface',
  'rig': 'Finding handles', 'skin': 'Binding the surface', 'write rig': 'Finishing',
};

/** Whether its rig is a named skeleton's, whose joints can be corrected. */
export const hasTemplate = (session: SessionState) => !session.own_rig && session.rigger === 'template';

export class Studio {
  /** The joints stand anew; called for every frame of a drag. */
  onStance: (stance: Stance, ofClip: boolean) => void = () => {};
  /** A new model was opened: the camera goes to it. */
  onOpened: () => void = () => {};

  private underWay = 0;
  private engine = new EngineClient();
  private showTimer = 0;
  private stage = { stage: 'Starting', fraction: 0 };
  private wantedHandles: number | null = null;
  private askedHandles = 0;
  private dragUpdate: Command | null = null;
  private dragging: Promise<void> = Promise.resolve();
  private dragsLeft = 0;
  private comparing = false;
  private stance: Stance | null = null;
  private shownSource = '';
  private waitingMoment: number | null = null;
  private momentUnderWay = false;

  constructor(readonly page: PageStore) {
    this.engine.onBusy = (busy) => this.showWork(busy);
    this.engine.onProgress = (stage, fraction) => {
      this.stage = { stage: stageNames[stage.split(':')[0] ?? ''] ?? stage, fraction };
      if (page.now.work) page.set({ work: this.stage });
    };
  }

  /** Nothing that was begun is still under way. */
  get idle() { return this.underWay === 0 && this.dragsLeft === 0 && !this.momentUnderWay; }

  async openSample(name: string) {
    await this.guard(async () => this.opened(await this.engine.run({ do: 'open_sample', name })));
  }

  async openFile(file: File) {
    if (file.size > mostFileSize) {
      this.page.set({ notice: { kind: 'error', title: 'This file is too large for a browser', detail: file.name } });
      return;
    }
    if (/\.bvh$/i.test(file.name)) return this.openMotion(file);
    if (/\.json$/i.test(file.name)) return this.openLimits(file);
    await this.guard(async () => {
      const bytes = new Uint8Array(await file.arrayBuffer());
      if (/\.gl(b|tf)$/i.test(file.name)) return this.openBytes(bytes, file.name);
      if (/\.ply$/i.test(file.name)) await this.engine.ask({ kind: 'check-ply', bytes, name: file.name });
      const { toGlb } = await import('./import_model');
      await this.openBytes(await toGlb(bytes, file.name), file.name);
    });
  }

  /** Plays what moves in the file on the model; a model whose handles have no names is rigged by a template first. */
  async openMotion(file: File) {
    await this.guard(async () => {
      const bytes = new Uint8Array(await file.arrayBuffer());
      await this.play(await this.engine.ask({ kind: 'motion', bytes, name: file.name }));
    });
  }

  /** One that the engine makes itself. */
  async openSampleMotion(name: string) {
    await this.guard(async () => this.play(await this.engine.run({ do: 'add_sample_motion', name })));
  }

  /** The motion that was opened last. */
  private async play(opened: Step) {
    this.apply(opened);
    const state = this.page.now.session, motion = state?.motions.at(-1);
    if (!state || !motion) return;
    const retarget = { do: 'retarget', motion: motion.name };
    const before = state.clips.length;
    try {
      await this.run1(retarget);
    } catch (error) {
      const fits = error instanceof EngineError && error.error.code === 'unsupported' && !state.own_rig && state.rigger !== 'template';
      if (!fits) throw error;
      await this.rigged({ do: 'choose_methods', rigger: 'template', skinning: state.skinning });
      await this.run1(retarget);
    }
    if ((this.page.now.session?.clips.length ?? 0) > before) this.page.set({ playing: true, display: 'surface', correcting: false });
  }

  /** How far joints may turn: a file of limits, for this model's joints. */
  async openLimits(file: File) {
    await this.guard(async () => {
      await this.run1({ do: 'set_limits', limits: await file.text() });
      this.page.set({ limits: true, display: 'handles' });
    });
  }

  private async run1(command: Command) { this.apply(await this.engine.run(command)); }

  async openAddress(address: string) {
    await this.guard(async () => {
      const response = await fetch(address).catch(() => null);
      if (!response?.ok) {
        throw new EngineError({
          code: 'file', message: 'the model cannot be fetched', where: address,
          remedy: 'the other site must allow it (CORS); or save the file and drop it here',
        });
      }
      const name = decodeURIComponent(new URL(address, location.href).pathname.split('/').pop() ?? 'model.glb');
      await this.openBytes(new Uint8Array(await response.arrayBuffer()), name);
    });
  }

  /** A session that this browser kept. */
  async openKept(bytes: Uint8Array, name: string) { await this.guard(() => this.openBytes(bytes, name)); }

  private async openBytes(bytes: Uint8Array, name: string) {
    await this.opened(await this.engine.ask({ kind: 'open', bytes, name }));
  }

  /** The last count asked for counts; those that a slider passes on its way are left out. */
  async setHandles(count: number) {
    const underWay = this.wantedHandles !== null;
    this.wantedHandles = count;
    if (underWay) return;
    await this.guard(async () => {
      for (let next = count; ; next = this.wantedHandles ?? next) {
        await this.rigged({ do: 'set_handles', count: next });
        this.askedHandles = next;
        if (this.wantedHandles === next) return;
      }
    });
    this.wantedHandles = null;
    this.page.set({});
  }

  /** Whether a count is on its way. */
  get settingHandles() { return this.wantedHandles !== null; }

  /** What was asked for: a rig can have a handle more, where two come at once. */
  get handleCount() {
    if (this.wantedHandles !== null) return this.wantedHandles;
    const joints = this.page.now.session?.joints.length ?? 0;
    return joints === this.askedHandles + 1 ? this.askedHandles : joints;
  }

  async loadMethods() {
    await this.guard(async () => this.page.set({ methods: await this.engine.ask({ kind: 'methods' }) }));
  }

  async chooseMethods(change: { rigger?: string; skinning?: string }) {
    const session = this.page.now.session;
    if (!session) return;
    const { rigger, skinning } = { ...session, ...change };
    await this.guard(() => this.rigged({ do: 'choose_methods', rigger, skinning }));
  }

  /** Joints are corrected on the model as it is bound, so it stands at rest. */
  async correct(on: boolean) {
    if (!on) return this.page.set({ correcting: false });
    await this.guard(async () => {
      this.page.set({ playing: false });
      if (this.page.now.session?.clip != null) await this.run1({ do: 'choose_clip', clip: '' });
      if (this.page.now.session?.posed) await this.run1({ do: 'reset_pose' });
      this.page.set({ correcting: true, mode: 'move', display: 'handles' });
    });
  }

  async pinJoint(joint: number, position: Vector) {
    await this.guard(() => this.rigged({ do: 'pin_joint', joint: this.jointName(joint), position }));
  }
  async unpinJoint(joint: string) { await this.guard(() => this.rigged({ do: 'unpin_joint', joint })); }

  async chooseSolver(solver: string) {
    await this.run({ do: 'set_ik', on: this.page.now.session?.ik ?? false, solver });
  }

  /** The document beside what other methods of that kind make of it. */
  async compare(kind: MethodKind, names: string[]) {
    this.page.set({ comparison: { kind, names, variants: [], measures: null } });
    await this.makeVariants();
  }

  async endComparison() {
    this.page.set({ comparison: null });
    await this.guard(async () => { await this.engine.ask({ kind: 'compare', commands: [] }); });
  }

  /** Anew after each change of the document; the newest wish counts. */
  private async makeVariants() {
    if (this.comparing) return;
    this.comparing = true;
    await this.guard(async () => {
      for (let wanted = this.page.now.comparison; wanted; wanted = this.page.now.comparison) {
        const { session } = this.page.now;
        const { kind, names } = wanted;
        const commands = names.map((name) => this.commandFor(kind, name)).filter((command) => command !== null);
        const { measures, variants, stance } = await this.engine.ask({ kind: 'compare', commands });
        if (this.page.now.session !== session || this.page.now.comparison !== wanted) continue;
        this.page.set({ comparison: { kind, names, measures, variants } });
        this.showStance(stance, false);
        return;
      }
    });
    this.comparing = false;
  }

  private commandFor(kind: MethodKind, name: string): Command | null {
    const session = this.page.now.session;
    if (!session) return null;
    const { rigger, skinning } = session;
    switch (kind) {
      case 'rigger': return { do: 'choose_methods', rigger: name, skinning };
      case 'skinning': return { do: 'choose_methods', rigger, skinning: name };
      case 'solver': return { do: 'set_ik', on: true, solver: name };
      case 'retargeting': {
        const source = session.clips[session.clip ?? -1]?.source;
        return source ? { do: 'retarget', ...source, method: name, map: JSON.stringify({ matches: session.match }) } : null;
      }
    }
  }

  /** Commands that leave the rig as it is. */
  async run(command: Command) {
    await this.guard(async () => this.apply(await this.engine.run(command)));
  }

  /** With another method, map, or how far hands reach; the clip stays in its place. */
  async retarget(change: { method?: string; reach?: number; contacts?: boolean; map?: string }) {
    const session = this.page.now.session;
    const source = session?.clips[session.clip ?? -1]?.source;
    if (!session || !source) return;
    const map = change.map ?? JSON.stringify({ matches: session.match });
    await this.run({ do: 'retarget', ...source, ...change, map });
  }

  /** At most one moment is on its way; the newest waits. */
  showMoment(seconds: number) {
    this.page.set({ seconds });
    this.waitingMoment = seconds;
    if (this.momentUnderWay) return;
    this.momentUnderWay = true;
    void this.guard(async () => {
      while (this.waitingMoment !== null) {
        const next: number = this.waitingMoment;
        this.waitingMoment = null;
        const { stance } = await this.engine.run({ do: 'set_time', seconds: next });
        this.showStance(stance, true);
      }
    }).finally(() => { this.momentUnderWay = false; });
  }

  async setKey() { await this.run({ do: 'set_key' }); }
  async chooseClip(clip: string) { await this.run({ do: 'choose_clip', clip }); }

  async addClip() {
    const names = new Set(this.page.now.session?.clips.map((clip) => clip.name));
    let number = 1;
    while (names.has(`clip ${number}`)) ++number;
    await this.run({ do: 'add_clip', clip: `clip ${number}` });
  }

  async renameJoint(joint: number, name: string) {
    await this.guard(() => this.rigged({ do: 'rename_joint', joint: this.jointName(joint), name }));
  }

  /** Pictures of a clip at even moments, each once the scene stands there. */
  async eachMoment(count: number, draw: (seconds: number) => void) {
    const { session, seconds } = this.page.now;
    const clip = session?.clips[session.clip ?? -1];
    if (!clip) return;
    this.page.set({ playing: false });
    await this.guard(async () => {
      const show = async (moment: number) => {
        const { stance } = await this.engine.run({ do: 'set_time', seconds: moment });
        this.onStance(stance, false);
      };
      for (let i = 0; i < count; ++i) {
        const moment = (clip.duration * i) / Math.max(1, count - 1);
        await show(moment);
        draw(moment);
      }
      await show(seconds);
    });
  }

  async renameClip(clip: string, name: string) { await this.run({ do: 'rename_clip', clip, name }); }
  async clearTarget(joint: number) { await this.run({ do: 'clear_target', joint: this.jointName(joint) }); }

  async setRestPose() { await this.guard(() => this.rigged({ do: 'set_rest_pose' })); }

  async undo() { await this.guard(() => this.rigged({ do: 'undo' })); }
  async redo() { await this.guard(() => this.rigged({ do: 'redo' })); }
  async toggleIk() {
    const { session } = this.page.now;
    if (session) await this.run({ do: 'set_ik', on: !session.ik, solver: session.solver });
  }
  async resetPose() { await this.run({ do: 'reset_pose' }); }
  async mirrorPose() { await this.run({ do: 'mirror_pose', from: 'both' }); }

  async resetJoint(joint: number) {
    await this.run({ do: 'reset_joint', joint: this.jointName(joint) });
  }

  async nudge(joint: number, offset: Vector) {
    await this.run({ do: 'move_joint', joint: this.jointName(joint), offset });
  }

  async turn(joint: number, axis: Vector, degrees: number) {
    await this.run({ do: 'turn_joint', joint: this.jointName(joint), axis, degrees });
  }

  async togglePin(joint: number, position: Vector) {
    const pinned = this.page.now.session?.targets.some((target) => target.joint === joint);
    const name = this.jointName(joint);
    await this.run(pinned ? { do: 'clear_target', joint: name } : { do: 'set_target', joint: name, position });
  }

  beginDrag(joint: number, ray: Ray, view: Vector, mode = this.page.now.mode) {
    const command = { do: 'begin_drag', joint: this.jointName(joint), mode: this.page.now.correcting ? 'move' : mode, ray, view };
    if (this.page.now.playing) this.page.set({ playing: false });
    this.page.set({ selected: joint });
    this.then(() => this.run(command));
  }

  /** At most one update is on its way; the newest waits. */
  updateDrag(ray: Ray, view: Vector) { this.dragTo({ do: 'update_drag', ray, view }); }

  /** About the dragged joint's own place, from how it stood when the drag began. */
  turnDrag(axis: Vector, degrees: number) { this.dragTo({ do: 'turn_drag', axis, degrees }); }

  private dragTo(command: Command) {
    const waiting = this.dragUpdate !== null;
    this.dragUpdate = command;
    if (waiting) return;
    this.then(async () => {
      const command = this.dragUpdate;
      this.dragUpdate = null;
      if (command) await this.run(command);
    });
  }

  endDrag() { this.then(() => (this.page.now.correcting ? this.pinDragged() : this.run({ do: 'end_drag' }))); }

  /** Where the dragged joint is becomes where the rig has it. */
  private async pinDragged() {
    const joint = this.page.now.session?.dragged ?? null, handles = this.stance?.handles;
    await this.run({ do: 'cancel_drag' });
    if (joint === null || !handles) return;
    await this.pinJoint(joint, [handles[4 * joint]!, handles[4 * joint + 1]!, handles[4 * joint + 2]!]);
  }

  cancelDrag() {
    this.dragUpdate = null;
    this.then(() => this.run({ do: 'cancel_drag' }));
  }

  /** The steps of a drag go one after the other. */
  private then(step: () => Promise<void>) {
    ++this.dragsLeft;
    this.dragging = this.dragging.then(step).finally(() => { --this.dragsLeft; });
  }

  /** The joint that holds the surface under the pointer; while joints are corrected, the selected one goes in there. */
  async selectSurface(ray: Ray, slope: number) {
    await this.guard(async () => {
      const hit = await this.engine.ask({ kind: 'pick', ray, slope });
      const { correcting, selected } = this.page.now;
      if (correcting && selected !== null && hit && !hit.on_handle) return this.pinJoint(selected, hit.inside);
      this.page.set({ selected: hit?.joint ?? null });
    });
  }

  async exportFile(format: 'glb' | 'obj' | 'stl' | 'bvh' | 'session'): Promise<Uint8Array | null> {
    return this.guard(() => this.engine.ask({ kind: 'export', format }));
  }

  async record(): Promise<string | null> {
    return this.guard(() => this.engine.ask({ kind: 'record' }));
  }

  async stop() {
    this.page.set({ comparison: null });
    await this.engine.cancel();
  }

  private jointName(joint: number) { return this.page.now.session?.joints[joint]?.name ?? ''; }

  private async opened(answer: Step) {
    this.page.set({ selected: null, hovered: null, notice: null, comparison: null, hiddenParts: new Set(), correcting: false });
    await this.showRig(answer);
    this.onOpened();
  }

  private async rigged(command: Command) {
    await this.showRig(await this.engine.run(command));
  }

  private async showRig(answer: Step) {
    const model = await this.engine.ask({ kind: 'model' });
    const count = answer.state?.joints.length ?? 0;
    const { selected } = this.page.now;
    const correcting = this.page.now.correcting && (answer.state ? hasTemplate(answer.state) : false);
    this.page.set({
      correcting, session: answer.state, model, seconds: answer.state?.seconds ?? 0, playing: false, hovered: null, selected: selected !== null && selected < count ? selected : null,
    });
    this.showStance(answer.stance, false);
    this.followUp();
  }

  private showStance(stance: Stance, ofClip: boolean) {
    this.stance = stance;
    this.onStance(stance, ofClip);
  }

  /** What stands beside the document goes with it. */
  private followUp() {
    const { session, comparison } = this.page.now;
    if (comparison && session?.dragged === null) void this.makeVariants();
    void this.guard(async () => {
      const motion = session?.clips[session.clip ?? -1]?.source?.motion ?? '';
      if (motion === this.shownSource) return;
      this.shownSource = motion;
      this.page.set({ sourceModel: motion === '' ? null : await this.engine.ask({ kind: 'source-model' }) });
      if (this.stance) this.onStance(this.stance, false);
    });
  }

  private apply({ state, stance }: Step) {
    const before = this.page.now.session;
    const another = state !== null && (state.clip !== before?.clip || state.seconds !== before.seconds);
    if (state) this.page.set({ session: state, seconds: state.seconds });
    this.showStance(stance, another);
    if (state) this.followUp();
  }

  private showWork(busy: boolean) {
    clearTimeout(this.showTimer);
    this.stage = { stage: 'Working', fraction: 0 };
    if (busy) this.showTimer = window.setTimeout(() => this.page.set({ work: this.stage }), progressDelay);
    else if (this.page.now.work) this.page.set({ work: null });
  }

  /** What goes wrong is told; the page goes on. */
  private async guard<T>(act: () => Promise<T>): Promise<T | null> {
    ++this.underWay;
    try {
      return await act();
    } catch (error) {
      const told = error instanceof EngineError
        ? error.error : { code: 'page', message: String(error), where: '', remedy: '' };
      if (told.code !== 'cancelled') this.page.set({ notice: noticeOf(told) });
      return null;
    } finally {
      --this.underWay;
    }
  }
}
