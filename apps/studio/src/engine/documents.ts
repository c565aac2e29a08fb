// The scene that is worked on, whose chosen member is the session, and what stands beside it: models that motions came with, and what other methods
// make of the document. All show the same moment.
import type { Failure, loadLimber, Session } from '@engine/limber.mjs';
import { chosenClip, momentOf } from '../app/clips';
import {
  canBeNamed, opensModel, type Answers, type Command, type ExportFormat, type LimberError, type MotionPreview, type MotionRequest,
  type OtherMember, type Ray, type Request, type SaveAs, type SessionState, type Stance, type Step, type Trial, type Variant, type Vector,
} from './messages';

type Limber = Awaited<ReturnType<typeof loadLimber>>;
type Taken = { state: SessionState | null; skin: Float32Array; pinned: number[] };

/** An engine's error on its way to the page. */
export class EngineFailure extends Error {
  constructor(readonly failure: Failure) {
    super(failure.error.message);
  }
}

function orThrow<T extends { ok: true }>(result: T | Failure): T {
  if (!result.ok) throw new EngineFailure(result);
  return result;
}

/** The motion in a document, as its newest clip, or why not. */
function putOn(session: Session, request: MotionRequest, method = 'limb-ik'): { error: LimberError | null; state: SessionState | null } {
  const added = orThrow(request.kind === 'motion' ? session.addMotion(request.bytes, request.name) : session.run(request.command));
  const put = session.run({ do: 'retarget', motion: added.state?.motions.at(-1)?.name ?? '', method });
  return put.ok ? { error: null, state: put.state } : { error: put.error, state: null };
}

/** The motion's first `most` seconds on a document. */
function framesOf(session: Session, request: MotionRequest, most: number, rate: number): Omit<MotionPreview, 'named'> {
  const { error, state } = putOn(session, request);
  if (error) return { error, seconds: 0, frames: [] };
  const seconds = Math.min(most, state?.clips[state.clip ?? -1]?.duration ?? 0);
  const count = Math.max(1, Math.round(seconds * rate));
  const frames = Array.from({ length: count }, (_, frame) => {
    const { skin } = orThrow(session.run({ do: 'set_time', seconds: (seconds * frame) / count }));
    return { skin, middle: middleOf(orThrow(session.handles()).handles) };
  });
  return { error: null, seconds, frames };
}

/** A document in that pose. */
function frameIn(session: Session, pose: string): Omit<MotionPreview, 'named'> {
  const put = session.run({ do: 'apply_pose', pose });
  if (!put.ok) return { error: put.error, seconds: 0, frames: [] };
  return { error: null, seconds: 0, frames: [{ skin: put.skin, middle: middleOf(orThrow(session.handles()).handles) }] };
}

/** Of x, y, z and radius of each joint: roots that stay behind while the hips walk away count little. */
function middleOf(handles: Float32Array): Vector {
  const sum: Vector = [0, 0, 0];
  handles.forEach((value, i) => { if (i % 4 < 3) sum[i % 4]! += value; });
  return sum.map((value) => (4 * value) / handles.length) as Vector;
}

/** What may make another rig, and with it another surface. */
const changesRig = new Set([
  'open_sample', 'open_file', 'set_handles', 'choose_methods', 'set_deformer', 'pin_joint', 'unpin_joint', 'set_rest_pose', 'rename_joint',
  'add_joint', 'delete_joint', 'reparent_joint', 'rig_from_animation',
  'undo', 'redo', 'add_sample', 'add_file', 'choose_member', 'remove_member',
]);
/** What shows all members at another moment. */
const movesAll = new Set(['set_clock']);
const drawnRate = 30, mostDrawn = 600; // moments a second of paths and curves, and of a whole clip
const changesWeights = new Set(['paint_weights', 'mirror_weights']);
const withModel = /\.(glb|gltf|vrm)$/i;
const none = new Float32Array();
const dragged: LimberError = { code: 'bad-argument', kind: 'joint-dragged', values: {}, message: 'a joint is being dragged', where: '', remedy: '' };

export class Documents {
  private session: Session;
  private state: SessionState | null = null;
  private seconds = 0;
  private pinned: number[] = [];
  /** By the motion's name. */
  private sources = new Map<string, { session: Session; state: SessionState }>();
  private shownSource = '';
  private shownOthers = '';
  private variants: { session: Session; clip: boolean }[] = [];
  /** The document with the rig of a named skeleton, or why there is none; made when a motion asks for it. */
  private named: { session: Session; state: SessionState } | EngineFailure | null = null;

  constructor(private limber: Limber) {
    this.session = limber.createSession();
  }

  open(bytes: Uint8Array, name: string, limbsFollow = false): Answers['open'] {
    return this.shown(this.take({ kind: 'open', bytes, name, limbsFollow }), true);
  }

  add(request: Extract<Request, { kind: 'add' }>): Answers['add'] { return this.shown(this.take(request), true); }

  addMotion(request: Extract<Request, { kind: 'motion' }>): Answers['motion'] { return this.shown(this.take(request), false); }

  transfer(request: Extract<Request, { kind: 'transfer' }>): Answers['transfer'] { return this.shown(this.take(request), true); }

  run(command: Command): Answers['run'] {
    const step = this.shown(this.take({ kind: 'run', command }), changesRig.has(command.do));
    if (movesAll.has(command.do)) step.stance.others = this.otherSkins();
    if (!changesWeights.has(command.do)) return step;
    return { ...step, weights: { ...orThrow(this.session.weights()).weights, deformation: orThrow(this.session.deformation()).deformation } };
  }

  liveBegin(skeleton: string): Answers['live-begin'] {
    orThrow(this.session.liveBegin(skeleton));
    return null;
  }
  liveFrame(pose: Float32Array, seconds: number): Answers['live-frame'] { return this.liveStance(this.session.liveFrame(pose, seconds)); }
  liveEnd(): Answers['live-end'] { return this.liveStance(this.session.liveEnd()); }
  liveRecorded(): Answers['live-recorded'] { return orThrow(this.session.liveRecorded()).bytes; }

  private liveStance(made: ReturnType<Session['liveEnd']>): Stance {
    const { skin, pinned } = orThrow(made);
    this.pinned = pinned;
    const stance = this.stance(skin);
    if (this.standing() !== '') stance.others = this.otherSkins();
    return stance;
  }

  restore(requests: Request[]): Answers['restore'] {
    this.session.free();
    this.session = this.limber.createSession();
    this.forgetNamed();
    this.state = null;
    this.forgetOthers();
    let failed = 0, error: LimberError | null = null;
    for (const request of requests) {
      try {
        this.take(request);
      } catch (thrown) {
        if (!(thrown instanceof EngineFailure)) throw thrown;
        ++failed;
        error ??= thrown.failure.error;
      }
    }
    const told = this.state as SessionState | null;
    if (!told) return { step: null, failed, error };
    const { skin } = orThrow(this.session.skin());
    this.state = { ...told, seconds: momentOf(chosenClip(told), this.seconds) }; // of a moment the engine tells no state
    return { step: this.shown({ state: this.state, skin }, true), failed, error };
  }

  /** By the method that takes the least time: all need the same joints. */
  tryMotion(request: MotionRequest): Trial { return this.tryNamed((fork) => putOn(fork, request, 'aligned').error); }
  tryPose(pose: string): Trial { return this.tryNamed((fork) => frameIn(fork, pose).error); }

  private tryNamed(act: (fork: Session) => LimberError | null): Trial {
    const { session, state } = this.withNames();
    return { error: this.onFork(session, act), joints: state.joints.length, warnings: state.warnings };
  }

  previewMotion(request: MotionRequest, most: number, rate: number): MotionPreview {
    return this.previewOf((fork) => framesOf(fork, request, most, rate));
  }
  previewPose(pose: string): MotionPreview { return this.previewOf((fork) => frameIn(fork, pose)); }

  private previewOf(frames: (fork: Session) => Omit<MotionPreview, 'named'>): MotionPreview {
    const own = this.onFork(this.session, frames);
    if (!canBeNamed(own.error, this.state)) return { ...own, named: false };
    try {
      const named = this.onFork(this.withNames().session, frames);
      return named.error ? { ...own, named: false } : { ...named, named: true };
    } catch (error) {
      if (error instanceof EngineFailure) return { ...own, named: false };
      throw error;
    }
  }

  previewMoments(moments: number[]): Float32Array[] {
    return this.onFork(this.session, (fork) => moments.map((seconds) => orThrow(fork.run({ do: 'set_time', seconds })).skin));
  }

  previewRig(): Answers['preview-rig'] {
    if (!this.named || this.named instanceof EngineFailure) return null;
    return { model: orThrow(this.named.session.model()).model, joints: this.named.state.joints.length };
  }

  sampleMotions() { return this.limber.sampleMotions(); }
  samplePoses() { return this.limber.samplePoses(); }
  pose(name: string) { return orThrow(this.session.pose(name)).pose; }

  private withNames(): { session: Session; state: SessionState } {
    this.named ??= this.rigWithNames();
    if (this.named instanceof EngineFailure) throw this.named;
    return this.named;
  }

  private rigWithNames(): { session: Session; state: SessionState } | EngineFailure {
    const session = this.fork(this.session);
    const rigged = session.run({ do: 'choose_methods', rigger: 'template', skinning: this.state?.skinning });
    if (rigged.ok && rigged.state) return { session, state: rigged.state };
    session.free();
    return new EngineFailure(rigged.ok ? { ok: false, error: { code: 'engine', message: 'nothing came of it', where: '', remedy: '' } } : rigged);
  }

  private forgetNamed() {
    if (this.named && !(this.named instanceof EngineFailure)) this.named.session.free();
    this.named = null;
  }

  private fork(session: Session): Session {
    const fork = this.limber.forkSession(session);
    if (!fork) throw new EngineFailure({ ok: false, error: dragged });
    return fork;
  }

  private onFork<T>(session: Session, act: (fork: Session) => T): T {
    const fork = this.fork(session);
    try {
      return act(fork);
    } finally {
      fork.free();
    }
  }

  posesAt(moments: number[]): Answers['poses-at'] {
    return this.onFork(this.session, (fork) => moments.map((seconds) => {
      orThrow(fork.run({ do: 'set_time', seconds }));
      return orThrow(fork.pose('keys')).pose;
    }));
  }

  pick(ray: Ray, slope: number) { return orThrow(this.session.pick(ray, slope)).hit; }
  paths(): Answers['paths'] {
    const { moments, places } = orThrow(this.session.paths(drawnRate, mostDrawn));
    return { moments, places };
  }
  curve(joint: number): Answers['curve'] {
    const { moments, values, tangents } = orThrow(this.session.curve(joint, drawnRate, mostDrawn));
    return { joint, moments, values, tangents };
  }
  pickMember(ray: Ray) { return orThrow(this.session.pickMember(ray)).hit; }
  surface(rays: Ray[]) { return rays.map((ray) => orThrow(this.session.surface(ray)).hit); }
  preview(stroke: Command | null) { return orThrow(stroke ? this.session.preview(stroke) : this.session.weights()).weights; }
  parts() { return orThrow(this.session.parts()).parts; }
  rigCheck(): Answers['rig-check'] { return orThrow(this.session.rigCheck()).check; }
  crowd(bytes: Uint8Array, name: string): Answers['crowd'] { return orThrow(this.limber.crowd(bytes, name)).crowd; }
  checkPly(bytes: Uint8Array, name: string) { orThrow(this.limber.checkPly(bytes, name)); }
  methods() { return this.limber.methods(); }
  export(format: ExportFormat) { return orThrow(this.session.export(format)).bytes; }
  targets(): Answers['targets'] { return this.limber.rigChoices().target.map(({ name }) => name); }
  save({ format, target, clip }: SaveAs): Answers['save'] { return orThrow(this.session.saveModel(`.${format}`, target, clip)); }
  record() { return JSON.stringify(this.session.record(), null, 1); }

  sourceModel(): Answers['source-model'] {
    const motion = this.state?.clips[this.state.clip ?? -1]?.source?.motion ?? '';
    const source = this.sources.get(motion);
    if (!source) return null;
    return { motion, model: orThrow(source.session.model()).model, joints: source.state.joints.length };
  }

  compare(lists: Command[][]): Answers['compare'] {
    this.endComparison();
    const variants = lists.map((commands): Variant | LimberError => {
      const session = this.limber.forkSession(this.session);
      if (!session) return dragged;
      let state: SessionState | null = null, error: LimberError = { code: 'engine', message: 'nothing came of it', where: '', remedy: '' };
      for (const command of commands) {
        const step = session.run(command);
        state = step.ok ? step.state : null;
        if (!step.ok) error = step.error;
        if (!state) break;
      }
      if (!state) {
        session.free();
        return error;
      }
      this.variants.push({ session, clip: state.clip !== null });
      return { model: orThrow(session.model()).model, state, measures: orThrow(session.measures()).measures };
    });
    const { skin } = orThrow(this.session.skin());
    return { measures: orThrow(this.session.measures()).measures, variants, stance: this.stance(skin) };
  }

  /** One request, carried out on the document. */
  private take(request: Request): Taken {
    const taken = this.carryOut(request);
    if (request.kind !== 'run' || !['set_time', 'set_clock'].includes(request.command.do)) this.forgetNamed();
    this.pinned = taken.pinned;
    if (taken.state) {
      this.state = taken.state;
      this.seconds = taken.state.seconds;
    }
    return taken;
  }

  private carryOut(request: Request): Taken {
    switch (request.kind) {
      case 'open': {
        const opened = orThrow(this.session.open(request.bytes, request.name, request.limbsFollow));
        this.forgetOthers();
        return opened;
      }
      case 'add': return orThrow(this.session.add(request.bytes, request.name, request.limbsFollow, request.asProp));
      case 'motion': {
        const added = orThrow(this.session.addMotion(request.bytes, request.name, request.retarget)), motion = added.state?.motions.at(-1);
        if (motion && withModel.test(request.name)) this.addSource(motion.name, request.bytes, request.name);
        return added;
      }
      case 'transfer': return orThrow(this.session.transferRig(request.bytes, request.name));
      case 'run': {
        const { command } = request, run = orThrow(this.session.run(command));
        if (opensModel(command)) this.forgetOthers();
        if (command.do === 'set_time' || command.do === 'set_clock') this.seconds = Number(command.seconds);
        return run;
      }
      default: throw new Error(`${request.kind} changes no document`);
    }
  }

  private shown({ state, skin }: Omit<Taken, 'pinned'>, rig: boolean): Step {
    const step: Step = {
      state, stance: this.stance(skin), model: rig ? orThrow(this.session.model()).model : null, weights: null, others: null,
    };
    const standing = this.standing();
    if (standing === this.shownOthers) return step;
    this.shownOthers = standing;
    step.others = this.others();
    step.stance.others = this.otherSkins();
    return step;
  }

  /** Those that are not chosen stay as they are while they are the same ones. */
  private standing() {
    const { member, members } = this.state ?? { member: 0, members: [] };
    return members.length > 1 ? JSON.stringify([member, members.map(({ name }) => name)]) : '';
  }

  /** Whether there is more to a place than a model in its own space. */
  private get isPlaced() {
    const members = this.state?.members ?? [], { position, turn, scale } = members[0]?.placement ?? {};
    return members.length > 1 || scale !== 1 || [...position ?? [], ...turn ?? []].some((value) => value !== 0);
  }

  /** All members but the chosen one. */
  private others(): OtherMember[] {
    return this.eachOther((member, { joints }) => ({ member, joints: joints.length, model: orThrow(this.session.memberModel(member)).model }));
  }
  private otherSkins(): Stance['others'] {
    return this.eachOther((member) => ({
      member, skin: orThrow(this.session.memberSkin(member)).skin, posed: orThrow(this.session.memberPosed(member)).posed,
    }));
  }
  private eachOther<T>(give: (member: number, of: SessionState['members'][number]) => T): T[] {
    return (this.state?.members ?? []).flatMap((of, member) => (member === this.state?.member ? [] : [give(member, of)]));
  }

  private addSource(motion: string, bytes: Uint8Array, name: string) {
    const session = this.limber.createSession();
    const opened = session.open(bytes, name);
    if (opened.ok && opened.state?.own_rig) this.sources.set(motion, { session, state: opened.state });
    else session.free();
  }

  private forgetOthers() {
    this.sources.forEach(({ session }) => session.free());
    this.sources.clear();
    this.shownSource = '';
    this.shownOthers = '';
    this.endComparison();
  }

  private endComparison() {
    this.variants.forEach(({ session }) => session.free());
    this.variants = [];
  }

  private stance(skin: Float32Array): Stance {
    const variants = this.variants.map(({ session, clip }) => {
      const { skin: moved } = orThrow(clip ? session.run({ do: 'set_time', seconds: this.seconds }) : session.skin());
      return { skin: moved, posed: orThrow(session.posed()).posed, handles: orThrow(session.handles()).handles };
    });
    return {
      skin, posed: orThrow(this.session.posed()).posed, handles: orThrow(this.session.handles()).handles, turns: orThrow(this.session.turns()).turns,
      scales: orThrow(this.session.scales()).scales, pinned: this.pinned, source: orThrow(this.session.sourceJoints()).places,
      sourceSkin: this.sourceSkin(), variants, places: this.isPlaced ? orThrow(this.session.places()).places : none, others: [],
    };
  }

  /** The other model at the same moment of the motion that it came with. */
  private sourceSkin(): Float32Array {
    const made = this.state?.clips[this.state.clip ?? -1]?.source;
    const source = made ? this.sources.get(made.motion) : undefined;
    if (!made || !source) return none;
    const { session, state } = source;
    const at = this.state?.motions.find(({ name }) => name === made.motion)?.clips.findIndex(({ name }) => name === made.clip) ?? -1;
    const clip = state.clips.find(({ name }) => name === made.clip) ?? state.clips[at];
    if (!clip) return none;
    const wanted = `${made.motion}\n${clip.name}`;
    if (this.shownSource !== wanted) orThrow(session.run({ do: 'choose_clip', clip: clip.name }));
    this.shownSource = wanted;
    return orThrow(session.run({ do: 'set_time', seconds: this.seconds })).skin;
  }
}
