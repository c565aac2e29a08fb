// Everything that a user can do, each a call on the engine's session; panels and the view call this and nothing else.
import { EngineClient, EngineError, refusal } from '../engine/client';
import { canBeNamed } from '../engine/messages';
import type {
  Command, LimberError, MethodKind, MotionPreview, MotionRequest, Placement, PreviewRig, Ray, Request, SessionState, Stance, Step, SurfaceHit,
  Trial, Vector, WeightArrays,
} from '../engine/messages';
import { counted } from '../ui/counted';
import { sorted, withBuffers, type Brought } from './files';
import type { Journal, KeptDocument } from './journal';
import { fromLimberFile, toLimberFile } from './limber_file';
import { changedTime, keysThere, type KeyChange } from './keys';
import { chosenClip, momentOf } from './clips';
import { noticeOf, type DragMode, type KeyPlace, type Notice, type PageStore } from './state';
import type { Motion } from './trials';
import { stageName, told, warningText } from '../words/engine';
import { say } from '../words/say';

const mostFileSize = 500e6;
/** Commands that leave the model in another pose, set by hand. */
const poses = new Set(['end_drag', 'place_joint', 'set_turn', 'turn_joint', 'move_joint', 'reset_joint', 'reset_pose', 'mirror_pose', 'apply_pose']);
const nudgePause = 1000; // milliseconds: presses of keys that follow each other sooner are one step to undo
const ahead: Vector = [0, 0, -1];
const previewRate = 12; // frames a second of a motion on the shelf; between them it is blended
const previewSeconds = 5; // of a user's motion
const progressDelay = 250; // milliseconds before a wait is shown

const lostSteps = (failed: number, all: number, error: LimberError | null): Notice => ({
  kind: 'error', title: say('{steps} of {all} could not be brought back', { steps: counted(failed, 'step'), all }), detail: error ? told(error).title : '',
});
const openTwice = (name: string): Notice => ({
  kind: 'note', title: say('This model is open in another tab as well'), detail: say('What you do here is kept as a copy of {name}', { name }),
});

const noModel = (): Notice => ({ kind: 'error', title: say('There is no model in it'), detail: say('Open GLB, glTF, VRM, OBJ, FBX, STL, PLY or BVH') });

const sampleMotion = (name: string): MotionRequest => ({ kind: 'run', command: { do: 'add_sample_motion', name } });
const motionOf = async (file: File): Promise<MotionRequest> =>
  ({ kind: 'motion', bytes: new Uint8Array(await file.arrayBuffer()), name: file.name });

type DragUpdate =
  | { do: 'update_drag'; ray: Ray; view: Vector; snap: boolean }
  | { do: 'turn_drag'; axis: Vector; degrees: number };

/** Whether its rig is a named skeleton's, whose joints can be corrected. */
export const hasTemplate = (session: SessionState) => !session.own_rig && session.rigger === 'template';

export class Studio {
  /** The joints stand anew; called for every frame of a drag. */
  onStance: (stance: Stance, ofClip: boolean) => void = () => {};
  /** Panels that show how joints stand, told as often. */
  private readers = new Set<(stance: Stance) => void>();
  /** The weights alone are others. */
  onWeights: (weights: WeightArrays) => void = () => {};
  /** A new model was opened: the camera goes to it. */
  onOpened: () => void = () => {};
  /** Files of poses were brought. */
  onPoses: (files: File[]) => Promise<void> = async () => {};
  /** Something is to be replaced: whether the user agrees. */
  ask: (title: string, detail: string, yes: string) => Promise<boolean> = async () => true;

  private underWay = 0;
  private engine = new EngineClient();
  private showTimer = 0;
  private stage = { stage: say('Starting'), fraction: 0 };
  private wantedHandles: number | null = null;
  private askedHandles = 0;
  private dragUpdate: DragUpdate | null = null;
  private dragAsked: DragUpdate | null = null;
  private dragging: Promise<void> = Promise.resolve();
  private dragsLeft = 0;
  private lastNudge = { of: '', at: -Infinity };
  private comparing = false;
  private stance: Stance | null = null;
  private shownSource = '';
  private openings = 0;
  private afterOpening: Notice | null = null;
  private opening: Promise<unknown> = Promise.resolve();
  private waitingMoment: Command | null = null;
  private momentUnderWay = false;

  constructor(readonly page: PageStore, private journal: Journal) {
    page.watch((now, before) => {
      if (now.selected !== before.selected && now.also === before.also && now.also.size > 0) page.set({ also: new Set() });
      if (now.keyEditor === 'curves' && (now.selected !== before.selected || now.keyEditor !== before.keyEditor)) void this.guard(() => this.drawClip());
    });
    this.engine.onChange = (request, place) => journal.add(request, place);
    this.engine.onBusy = (busy) => this.showWork(busy);
    this.engine.onProgress = (stage, fraction) => {
      this.stage = { stage: stageName(stage), fraction };
      if (page.now.work) page.set({ work: this.stage });
    };
  }

  /** Nothing that was begun is still under way. */
  get idle() { return this.underWay === 0 && this.dragsLeft === 0 && !this.momentUnderWay; }

  async openSample(name: string) { await this.open(() => this.engine.run({ do: 'open_sample', name, limbs_follow: true })); }

  /** Of models that are asked for while another one is being opened the last is opened, the others never. */
  private async open(make: () => Promise<Step | null>) {
    const mine = ++this.openings, before = this.opening;
    this.page.set({ playing: false });
    this.waitingMoment = null;
    this.opening = this.guard(async () => {
      await before;
      if (mine !== this.openings) return;
      const step = await make();
      if (step) this.opened(step);
    });
    await this.opening;
  }

  /** Another model beside those that are there; as a prop without joints of its own. */
  async addSample(name: string, asProp: boolean) {
    await this.joining(() => this.engine.run({ do: 'add_sample', name, limbs_follow: !asProp, as_prop: asProp }));
  }

  async addFiles(files: File[], asProp: boolean) {
    const brought = await this.broughtBy(files);
    if (!brought) return;
    const { model, beside } = brought;
    if (!model || /\.limber$/i.test(model.name)) return this.page.set({ notice: noModel() });
    await this.joining(async () => {
      const { bytes, name } = await this.readModel(model, beside);
      return this.engine.ask({ kind: 'add', bytes, name, limbsFollow: !asProp, asProp });
    });
  }

  private async joining(make: () => Promise<Step>) {
    if (!this.page.now.session) return;
    this.page.set({ playing: false, comparison: null });
    await this.guard(async () => {
      this.take(await make());
      this.onOpened();
    });
  }

  /** The member whose surface a ray meets first. */
  async memberUnder(ray: Ray): Promise<number | null> {
    const met = await this.guard(() => this.engine.ask({ kind: 'pick-member', ray }));
    return met?.member ?? null;
  }

  async chooseMember(member: number) {
    const { session } = this.page.now;
    if (session && member !== session.member) await this.run({ do: 'choose_member', member: this.memberName(member) });
  }
  async placeMember(member: number, placement: Placement) {
    await this.run({ do: 'place_member', member: this.memberName(member), ...placement });
  }
  async attachMember(member: number, to: number, joint: string, snap: boolean) {
    await this.run({ do: 'attach_member', member: this.memberName(member), to: this.memberName(to), joint, snap });
  }
  async detachMember(member: number) { await this.run({ do: 'detach_member', member: this.memberName(member) }); }
  async removeMember(member: number) { await this.run({ do: 'remove_member', member: this.memberName(member) }); }
  async renameMember(member: number, name: string) {
    await this.run({ do: 'rename_member', member: this.memberName(member), name });
  }
  private memberName(member: number) { return this.page.now.session?.members[member]?.name ?? ''; }

  private async broughtBy(files: File[]): Promise<Brought | null> {
    const large = files.find(({ size }) => size > mostFileSize);
    if (!large) return this.guard(() => sorted(files));
    this.page.set({ notice: { kind: 'error', title: say('This file is too large for a browser'), detail: large.name } });
    return null;
  }

  /** A model with what belongs to it, motions for it, or limits. */
  async openFiles(files: File[]) {
    const brought = await this.broughtBy(files);
    if (!brought) return;
    const { model, motions, poses: poseFiles, limits, beside } = brought;
    if (model) await this.openModel(model, beside);
    await this.openMotions(motions);
    if (poseFiles.length > 0) await this.onPoses(poseFiles);
    if (limits) await this.openLimits(limits);
    if (files.length > 0 && !model && motions.length === 0 && poseFiles.length === 0 && !limits) {
      this.page.set({ notice: noModel() });
    }
  }

  private async openModel(file: File, beside: Map<string, File>) {
    await this.open(async () => {
      if (/\.limber$/i.test(file.name)) return this.restore(fromLimberFile(new Uint8Array(await file.arrayBuffer()), file.name), file.name);
      const { bytes, name } = await this.readModel(file, beside);
      return this.openBytes(bytes, name);
    });
  }

  /** What the engine reads of it. */
  private async readModel(file: File, beside: Map<string, File>): Promise<{ bytes: Uint8Array; name: string }> {
    const { name } = file, bytes = new Uint8Array(await file.arrayBuffer());
    if (/\.glb$/i.test(name)) return { bytes, name };
    if (/\.gltf$/i.test(name)) return { bytes: await withBuffers(bytes, beside), name };
    if (/\.ply$/i.test(name)) await this.engine.ask({ kind: 'check-ply', bytes, name });
    const { toGlb } = await import('./import_model');
    return { bytes: await toGlb(bytes, name, beside), name };
  }

  /** One is put on the model at once; of several the user chooses on the shelf, where they stay while the page lives. */
  async openMotions(files: File[]) {
    if (files.length === 0) return;
    if (files.length === 1) {
      this.page.set({ shelf: false });
      return this.openMotion(files[0]!);
    }
    const before = this.page.now.ownMotions.filter(({ name }) => !files.some((file) => file.name === name));
    this.page.set({ ownMotions: [...before, ...files], shelf: true });
  }

  /** Plays what moves in the file on the model. */
  async openMotion(file: File) {
    await this.guard(async () => this.play(await motionOf(file)));
  }

  /** One that the engine makes itself. */
  async openSampleMotion(name: string) {
    await this.guard(() => this.play(sampleMotion(name)));
  }

  /** How a motion would look on the model as it is; null where the page is told to stop. */
  async previewMotion(of: Motion): Promise<MotionPreview | null> {
    try {
      const motion = of instanceof File ? await motionOf(of) : sampleMotion(of.name);
      return await this.engine.ask({ kind: 'preview-motion', motion, most: of instanceof File ? previewSeconds : of.seconds, rate: previewRate });
    } catch (error) {
      const known = error instanceof EngineError ? error : refusal(say('the file cannot be read'));
      return known.cancelled ? null : { error: known.error, named: false, seconds: 0, frames: [] };
    }
  }

  /** What previews with a named skeleton move. */
  async previewRig(): Promise<PreviewRig | null> {
    return this.engine.ask({ kind: 'preview-rig' }).catch(() => null);
  }

  private async play(motion: MotionRequest) {
    if (!this.page.now.session) return;
    const title = say('The model needs a skeleton for this motion');
    const trial = await this.withSkeleton(title, (named) => this.engine.ask({ kind: 'try-motion', motion, named }));
    if (!trial) return;
    const before = this.page.now.session?.clips.length ?? 0;
    this.take(await this.engine.ask(motion));
    this.take(await this.engine.run({ do: 'retarget', motion: trial.motion }));
    if ((this.page.now.session?.clips.length ?? 0) > before) this.page.set({ playing: true, display: 'surface', correcting: false });
  }

  /** What is tried beside the document fits it then. A model whose handles have no names gets a skeleton first, where the
   *  user agrees; else all stays as it was: null. */
  private async withSkeleton(title: string, attempt: (named: boolean) => Promise<Trial>): Promise<Trial | null> {
    const state = this.page.now.session;
    let trial = await attempt(false);
    if (state && canBeNamed(trial.error, state)) {
      const refused = trial.error;
      trial = await attempt(true);
      if (trial.error) throw new EngineError(refused ?? trial.error);
      const agreed = await this.ask(title,
        [
          say('Its {handles} will be replaced by a skeleton of {joints} with names.', { handles: counted(state.joints.length, 'handle'), joints: counted(trial.joints, 'joint') }),
          ...trial.warnings.map((warning) => say('Please look at the result: {warning}.', { warning: warningText(warning) })),
          say('Undo takes it back.'),
        ].join(' '),
        say('Give it a skeleton'));
      if (!agreed) return null;
      this.take(await this.engine.run({ do: 'choose_methods', rigger: 'template', skinning: state.skinning }));
    }
    if (trial.error) throw new EngineError(trial.error);
    return trial;
  }

  /** The pose that is shown, as the text of a file. */
  async copyPose(name: string): Promise<string | null> {
    return this.guard(() => this.engine.ask({ kind: 'pose', name }));
  }

  /** Joints: these alone. */
  async applyPose(pose: string, { joints = [], mirrored = false }: { joints?: readonly number[]; mirrored?: boolean } = {}) {
    if (this.page.now.playing) this.page.set({ playing: false });
    await this.guard(async () => {
      const names = joints.map((joint) => this.jointName(joint));
      const trial = await this.withSkeleton(say('The model needs a skeleton for this pose'), (named) => this.engine.ask({ kind: 'try-pose', pose, named }));
      if (trial) await this.run({ do: 'apply_pose', pose, joints: names, mirrored });
    });
  }

  /** How the model would look in that pose; null where the page is told to stop. */
  async previewPose(pose: string): Promise<MotionPreview | null> {
    try {
      return await this.engine.ask({ kind: 'preview-pose', pose });
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      return error.cancelled ? null : { error: error.error, named: false, seconds: 0, frames: [] };
    }
  }

  /** How far joints may turn: a file of limits, for this model's joints. */
  async openLimits(file: File) {
    await this.guard(async () => {
      this.take(await this.engine.run({ do: 'set_limits', limits: await file.text() }));
      this.page.set({ limits: true, display: 'handles' });
    });
  }

  async openAddress(address: string) {
    await this.open(async () => {
      const response = await fetch(address).catch(() => null);
      if (!response?.ok) {
        throw refusal(say('the model cannot be fetched'), address, say('the other site must allow it (CORS); or save the file and drop it here'));
      }
      const name = decodeURIComponent(new URL(address, location.href).pathname.split('/').pop() ?? 'model.glb');
      return this.openBytes(new Uint8Array(await response.arrayBuffer()), name);
    });
  }

  /** A document that this browser kept, as it was left. */
  async openKept(document: KeptDocument) {
    await this.open(async () => this.restore(await this.journal.requestsOf(document.id), document.name, document));
  }

  /** A document by all that was done; one that was kept goes on where it is. */
  private async restore(requests: Request[], name: string, kept: KeptDocument | null = null): Promise<Step> {
    const { step, failed, error } = await this.engine.restore(requests);
    if (!step) throw error ? new EngineError(error) : refusal(say('There is no model in it'), name);
    const all = this.engine.requests;
    const own = kept ? await this.journal.resume(kept, all, requests.length) : this.journal.begin(name, all);
    this.afterOpening = failed > 0 ? lostSteps(failed, requests.length, error) : own ? null : openTwice(name);
    return step;
  }

  /** Everything, to go on with here or elsewhere. */
  limberFile(): Uint8Array { return toLimberFile(this.engine.requests); }

  private openBytes(bytes: Uint8Array, name: string) { return this.engine.ask({ kind: 'open', bytes, name, limbsFollow: true }); }

  /** Whether what is asked for may replace the rig that the model came with. */
  private async mayReplaceRig(): Promise<boolean> {
    const { session } = this.page.now;
    if (session && !session.own_rig && session.edited_rig) {
      return this.ask(say('Replace the rig that you changed?'), say('Painted weights and joints changed by hand go. Undo brings them back.'), say('Replace it'));
    }
    if (!session?.own_rig) return true;
    return this.ask(say('Replace the rig of this model?'),
      say('It came with {joints} that have names; they and its clips go. Undo brings them back.', { joints: counted(session.joints.length, 'joint') }),
      say('Replace it'));
  }

  /** The last count asked for counts; those that a slider passes on its way are left out. */
  async setHandles(count: number) {
    const underWay = this.wantedHandles !== null;
    this.wantedHandles = count;
    if (underWay) return;
    await this.guard(async () => {
      if (!await this.mayReplaceRig()) return;
      for (let next = count; ; next = this.wantedHandles ?? next) {
        this.take(await this.engine.run({ do: 'set_handles', count: next }));
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
    await this.guard(async () => this.page.set({
      methods: await this.engine.ask({ kind: 'methods' }), sampleMotions: await this.engine.ask({ kind: 'sample-motions' }),
      samplePoses: await this.engine.ask({ kind: 'sample-poses' }),
    }));
  }

  async chooseMethods(change: { rigger?: string; skinning?: string }) {
    const session = this.page.now.session;
    if (!session) return;
    const { rigger, skinning } = { ...session, ...change };
    await this.guard(async () => {
      if (await this.mayReplaceRig()) this.take(await this.engine.run({ do: 'choose_methods', rigger, skinning }));
    });
    this.page.set({}); // lists show again what is chosen
  }

  /** Joints are corrected on the model as it is bound, so it stands at rest. */
  async correct(on: boolean) {
    if (!on) return this.page.set({ correcting: false });
    await this.guard(async () => {
      this.page.set({ playing: false });
      if (this.page.now.session?.clip != null) this.take(await this.engine.run({ do: 'choose_clip', clip: '' }));
      if (this.page.now.session?.posed) this.take(await this.engine.run({ do: 'reset_pose' }));
      this.page.set({ correcting: true, mode: 'move', display: 'handles' });
    });
  }

  async pinJoint(joint: number, position: Vector) {
    if (this.page.now.session?.edited_rig && !await this.mayReplaceRig()) return;
    await this.run({ do: 'pin_joint', joint: this.jointName(joint), position });
  }
  async unpinJoint(joint: string) {
    if (this.page.now.session?.edited_rig && !await this.mayReplaceRig()) return;
    await this.run({ do: 'unpin_joint', joint });
  }

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

  async run(command: Command) {
    await this.guard(async () => {
      this.take(await this.engine.run(command));
      const { autoKey, session } = this.page.now;
      if (autoKey && session?.clip != null && poses.has(command.do)) await this.setKey();
    });
  }

  /** With another method, map, or how far hands reach; the clip stays in its place. */
  async retarget(change: { method?: string; reach?: number; contacts?: boolean; map?: string }) {
    const session = this.page.now.session;
    const source = session?.clips[session.clip ?? -1]?.source;
    if (!session || !source) return;
    const map = change.map ?? JSON.stringify({ matches: session.match });
    await this.run({ do: 'retarget', ...source, ...change, map });
    this.page.set({}); // what was refused is not shown any more
  }

  /** At most one moment is on its way; the newest waits. In a scene all members show what the clock says, each of its own clip. */
  showMoment(seconds: number, clock = seconds) {
    this.page.set({ seconds });
    this.waitingMoment = this.momentCommand(seconds, clock);
    if (this.momentUnderWay) return;
    this.momentUnderWay = true;
    void this.guard(async () => {
      while (this.waitingMoment !== null) {
        const next: Command = this.waitingMoment;
        this.waitingMoment = null;
        const { stance } = await this.engine.run(next);
        this.showStance(stance, true);
      }
    }).finally(() => { this.momentUnderWay = false; });
  }

  /** Behind the end of its clip the chosen member is alone: there is nothing to repeat, there its next key will be. */
  private momentCommand(seconds: number, clock = seconds): Command {
    const { session } = this.page.now, repeats = momentOf(chosenClip(session), clock) === seconds;
    return (session?.members.length ?? 0) > 1 && repeats ? { do: 'set_clock', seconds: clock } : { do: 'set_time', seconds };
  }

  /** On recorded motion the correction comes and goes, instead of a jump of one frame. */
  async setKey() {
    const { session, span } = this.page.now;
    await this.run({ do: 'set_key', span: session?.clips[session.clip ?? -1]?.recorded ? span : 0 });
  }

  /** They are the chosen ones afterwards. */
  async editKeys(keys: readonly KeyPlace[], change: KeyChange) {
    await this.run({ do: 'edit_keys', keys: this.named(keys), ...change });
    this.page.set({ chosenKeys: keysThere(keys.map(({ joint, seconds }) => ({ joint, seconds: changedTime(seconds, change) })), this.page.now.session) });
  }
  async deleteKeys(keys: readonly KeyPlace[]) { await this.run({ do: 'delete_keys', keys: this.named(keys) }); }

  /** From its rest pose: degrees about x, y and z, and metres. */
  async setJointKey({ joint, seconds }: KeyPlace, turn: Vector, offset: Vector) {
    await this.run({ do: 'set_joint_key', joint: this.jointName(joint), seconds, turn, offset });
  }

  private named(keys: readonly KeyPlace[]) {
    return keys.map(({ joint, seconds }) => ({ joint: this.jointName(joint), seconds }));
  }

  showGhosts(on: boolean) {
    this.page.set({ ghosts: on });
    this.followUp();
  }

  /** What is drawn of the whole clip goes with it. */
  private async drawClip() {
    const { session, ghosts, keyEditor, selected } = this.page.now;
    const clip = session?.clips[session.clip ?? -1], still = session?.dragged === null;
    if (!clip || clip.duration <= 0) return this.page.set({ paths: null, curve: null });
    if (!still) return;
    const [paths, curve] = await Promise.all([
      ghosts ? this.engine.ask({ kind: 'paths' }) : null,
      keyEditor === 'curves' && selected !== null ? this.engine.ask({ kind: 'curve', joint: selected }) : null,
    ]);
    const now = this.page.now;
    if (now.session === session && now.selected === selected && now.ghosts === ghosts && now.keyEditor === keyEditor) this.page.set({ paths, curve });
  }
  async chooseClip(clip: string) { await this.run({ do: 'choose_clip', clip }); }

  async addClip() {
    const names = new Set(this.page.now.session?.clips.map((clip) => clip.name));
    let number = 1;
    while (names.has(say('clip {number}', { number }))) ++number;
    await this.run({ do: 'add_clip', clip: say('clip {number}', { number }) });
  }

  async renameJoint(joint: number, name: string) {
    await this.run({ do: 'rename_joint', joint: this.jointName(joint), name });
  }

  /** Pictures of a clip at even moments, each once the scene stands there. */
  async eachMoment(count: number, draw: (seconds: number) => void | Promise<void>) {
    const { session, seconds } = this.page.now;
    const clip = session?.clips[session.clip ?? -1];
    if (!clip) return;
    this.page.set({ playing: false });
    await this.guard(async () => {
      const show = async (moment: number) => {
        const { stance } = await this.engine.run(this.momentCommand(moment));
        this.onStance(stance, false);
      };
      for (let i = 0; i < count; ++i) {
        const moment = (clip.duration * i) / Math.max(1, count - 1);
        await show(moment);
        await draw(moment);
      }
      await show(seconds);
    });
  }

  async renameClip(clip: string, name: string) { await this.run({ do: 'rename_clip', clip, name }); }
  async clearTarget(joint: number) { await this.run({ do: 'clear_target', joint: this.jointName(joint) }); }

  async setRestPose() { await this.run({ do: 'set_rest_pose' }); }

  async undo() { await this.run({ do: 'undo' }); }
  async redo() { await this.run({ do: 'redo' }); }
  async toggleIk() {
    const { session } = this.page.now;
    if (session) await this.run({ do: 'set_ik', on: !session.ik, solver: session.solver });
  }
  async resetPose() { await this.run({ do: 'reset_pose' }); }
  async mirrorPose() { await this.run({ do: 'mirror_pose', from: 'both' }); }

  /** Until what it gives is called. */
  readStance(reader: (stance: Stance) => void): () => void {
    this.readers.add(reader);
    return () => { this.readers.delete(reader); };
  }

  /** The others that are selected, where the joint is. */
  private besides(joint: number): number[] {
    const { selected, also } = this.page.now;
    return joint === selected || also.has(joint) ? [...also, selected ?? joint].filter((other) => other !== joint) : [];
  }

  /** With all that are selected, as the ones below. */
  async resetJoint(joint: number) { await this.run({ do: 'reset_joint', ...this.namedWith(joint) }); }

  /** Degrees about x, y and z, from the rest pose. */
  async setTurn(joint: number, turn: Vector) { await this.poseExactly({ do: 'set_turn', ...this.namedWith(joint), turn }); }

  /** In the world, in metres: the limb comes along where limbs follow. */
  async moveJointTo(joint: number, position: Vector) {
    await this.poseExactly({ do: 'place_joint', ...this.namedWith(joint), position });
  }

  private namedWith(joint: number) {
    return { joint: this.jointName(joint), with: this.besides(joint).map((other) => this.jointName(other)) };
  }

  private async poseExactly(command: Command) {
    const { bothSides, session } = this.page.now;
    await this.run({ ...command, mirrored: bothSides });
    // A model without two sides has been told so.
    if (bothSides && this.page.now.session === session) this.page.set({ bothSides: false });
  }

  /** What a drag that far does. */
  nudge(joint: number, offset: Vector) {
    this.dragByKey(joint, 'move', { do: 'update_drag', ray: { origin: offset, direction: ahead }, view: ahead });
  }

  turn(joint: number, axis: Vector, degrees: number) { this.dragByKey(joint, 'turn', { do: 'turn_drag', axis, degrees }); }

  private dragByKey(joint: number, mode: DragMode, update: Command) {
    const of = [mode, joint, ...this.besides(joint)].join(), at = performance.now();
    const goesOn = this.lastNudge.of === of && at - this.lastNudge.at < nudgePause;
    this.lastNudge = { of, at };
    this.beginDrag(joint, { origin: [0, 0, 0], direction: ahead }, ahead, mode);
    this.then(async () => {
      if (this.isDragging) await this.run(update);
    });
    this.endDrag(goesOn);
  }

  async togglePin(joint: number, position: Vector) {
    const pinned = this.page.now.session?.targets.some((target) => target.joint === joint), names = this.namedWith(joint);
    await this.run(pinned ? { do: 'clear_target', ...names } : { do: 'set_target', ...names, position });
  }

  beginDrag(joint: number, ray: Ray, view: Vector, mode = this.page.now.mode) {
    const { bothSides, correcting, playing } = this.page.now;
    const together = this.besides(joint);
    const command = {
      do: 'begin_drag', joint: this.jointName(joint), mode: correcting ? 'move' : mode, ray, view,
      with: correcting ? [] : together.map((other) => this.jointName(other)), mirrored: bothSides && !correcting,
    };
    if (playing) this.page.set({ playing: false });
    this.page.set({ selected: joint, also: new Set(together) });
    this.then(async () => {
      await this.run(command);
      // A model without two sides has been told so.
      if (!this.isDragging && bothSides) this.page.set({ bothSides: false });
    });
  }

  private get isDragging() { return this.page.now.session?.dragged != null; }

  /** Another joint that goes along with those that are selected, or no longer does. */
  selectAlso(joint: number) {
    const { selected, also } = this.page.now;
    if (selected === null) return this.page.set({ selected: joint, also: new Set() });
    if (selected === joint) {
      const [next = null, ...rest] = also;
      return this.page.set({ selected: next, also: new Set(rest) });
    }
    const others = new Set(also);
    if (!others.delete(joint)) others.add(joint);
    this.page.set({ also: others });
  }

  /** At most one update is on its way; the newest waits. */
  updateDrag(ray: Ray, view: Vector, snap = false) { this.dragTo({ do: 'update_drag', ray, view, snap }); }

  /** About the dragged joint's own place, from how it stood when the drag began. */
  turnDrag(axis: Vector, degrees: number) { this.dragTo({ do: 'turn_drag', axis, degrees }); }

  private dragTo(command: DragUpdate) {
    const waiting = this.dragUpdate !== null;
    this.dragUpdate = command;
    if (waiting) return;
    this.then(async () => {
      const command = this.dragUpdate;
      this.dragUpdate = null;
      if (!command || !this.isDragging) return;
      this.dragAsked = command;
      await this.run(command);
    });
  }

  /** What the joints that are shown during a drag answer to. */
  get shownDrag(): DragUpdate | null { return this.dragAsked; }

  endDrag(goesOn = false) {
    this.then(async () => {
      if (this.isDragging) await (this.page.now.correcting ? this.pinDragged() : this.run({ do: 'end_drag', goes_on: goesOn }));
    });
  }

  /** Where the dragged joint is becomes where the rig has it. */
  private async pinDragged() {
    const joint = this.page.now.session?.dragged ?? null, handles = this.stance?.handles;
    await this.run({ do: 'cancel_drag' });
    if (joint === null || !handles) return;
    await this.pinJoint(joint, [handles[4 * joint]!, handles[4 * joint + 1]!, handles[4 * joint + 2]!]);
  }

  cancelDrag() {
    this.dragUpdate = null;
    this.then(async () => {
      if (this.isDragging) await this.run({ do: 'cancel_drag' });
    });
  }

  /** The steps of a drag go one after the other. */
  private then(step: () => Promise<void>) {
    ++this.dragsLeft;
    this.dragging = this.dragging.then(step).finally(() => { --this.dragsLeft; });
  }

  /** Where rays meet the surface. */
  async surface(rays: Ray[]): Promise<(SurfaceHit | null)[]> {
    return await this.guard(() => this.engine.ask({ kind: 'surface', rays })) ?? rays.map(() => null);
  }

  /** Shows what a stroke would leave; null: what there is. */
  async previewStroke(stroke: Command | null) {
    await this.guard(async () => this.onWeights(await this.engine.ask({ kind: 'preview', stroke })));
  }

  /** A new joint inside the surface there, below the selected one. */
  private async placeJoint(ray: Ray) {
    const [hit] = await this.surface([ray]), { selected, session } = this.page.now;
    if (!hit || selected === null || !session) return;
    this.page.set({ placing: false });
    const names = session.joints.map(({ name }) => name);
    await this.run({ do: 'add_joint', parent: this.jointName(selected), position: hit.inside });
    const added = this.page.now.session?.joints.findIndex(({ name }) => !names.includes(name)) ?? -1;
    if (added >= 0) this.page.set({ selected: added });
  }

  async toggleLock(joint: number) {
    await this.run({ do: 'lock_weights', ...this.namedWith(joint), on: !this.page.now.session?.locked.includes(joint) });
  }

  async deleteJoint(joint: number) {
    const parent = this.page.now.session?.joints[joint]?.parent ?? -1, name = parent < 0 ? '' : this.jointName(parent);
    await this.run({ do: 'delete_joint', joint: this.jointName(joint) });
    this.selectNamed(name);
  }

  async hangJoint(joint: number, parent: string) {
    const name = this.jointName(joint);
    await this.run({ do: 'reparent_joint', joint: name, parent });
    this.selectNamed(name);
  }

  /** Joints of another rig have other numbers. */
  private selectNamed(name: string) {
    const joint = this.page.now.session?.joints.findIndex((known) => known.name === name) ?? -1;
    this.page.set({ selected: joint < 0 ? null : joint });
  }

  /** The joint that holds the surface under the pointer; while joints are corrected, the selected one goes in there. */
  async selectSurface(ray: Ray, slope: number, besides = false) {
    if (this.page.now.placing) return this.placeJoint(ray);
    await this.guard(async () => {
      if ((this.page.now.session?.members.length ?? 0) > 1 && !this.page.now.correcting) {
        const met = await this.engine.ask({ kind: 'pick-member', ray });
        if (met && met.member !== this.page.now.session?.member) return this.chooseMember(met.member);
      }
      const hit = await this.engine.ask({ kind: 'pick', ray, slope });
      const { correcting, selected } = this.page.now;
      if (correcting && selected !== null && hit && !hit.on_handle) return this.pinJoint(selected, hit.inside);
      if (!besides) return this.page.set({ selected: hit?.joint ?? null });
      if (hit) this.selectAlso(hit.joint);
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

  private opened(step: Step) {
    this.page.set({
      others: [], arranging: false,
      selected: null, hovered: null, notice: this.afterOpening, comparison: null, hiddenParts: new Set(), correcting: false, painting: false, placing: false, selecting: false, display: 'handles',
    });
    this.afterOpening = null;
    this.take(step);
    this.onOpened();
  }

  /** The document as it stands after a step. */
  private take({ state, stance, model, weights, others }: Step) {
    const before = this.page.now;
    if (state && model) {
      const another = state.members[state.member]?.name !== before.session?.members[before.session.member]?.name;
      const selected = another ? null : before.selected;
      if (another) this.page.set({ also: new Set(), hiddenParts: new Set(), comparison: null, painting: false, placing: false, paths: null, curve: null });
      this.page.set({
        session: state, model, others: others ?? (state.members.length > 1 ? before.others : []), seconds: state.seconds, playing: false, hovered: null,
        correcting: before.correcting && hasTemplate(state), chosenKeys: [],
        selected: selected !== null && selected < state.joints.length ? selected : null,
      });
    } else if (state) {
      const sameClip = state.clip === before.session?.clip;
      this.page.set({ session: state, seconds: state.seconds, chosenKeys: sameClip ? keysThere(before.chosenKeys, state) : [] });
    }
    if (weights) this.onWeights(weights);
    const another = !model && state !== null && (state.clip !== before.session?.clip || state.seconds !== before.session?.seconds);
    this.showStance(stance, another);
    if (state) this.followUp();
  }

  private showStance(stance: Stance, ofClip: boolean) {
    this.stance = stance;
    this.onStance(stance, ofClip);
    this.readers.forEach((read) => read(stance));
  }

  /** What stands beside the document goes with it. */
  private followUp() {
    const { session, comparison } = this.page.now;
    if (comparison && session?.dragged === null) void this.makeVariants();
    void this.guard(() => this.drawClip());
    void this.guard(async () => {
      const motion = session?.clips[session.clip ?? -1]?.source?.motion ?? '';
      if (motion === this.shownSource) return;
      this.shownSource = motion;
      const sourceModel = motion === '' ? null : await this.engine.ask({ kind: 'source-model' });
      if (this.shownSource !== motion) return;
      this.page.set({ sourceModel });
      if (this.stance) this.onStance(this.stance, false);
    });
  }

  private showWork(busy: boolean) {
    clearTimeout(this.showTimer);
    this.stage = { stage: say('Working'), fraction: 0 };
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
