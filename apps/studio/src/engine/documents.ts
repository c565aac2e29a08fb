// The session that is worked on, and those that stand beside it: models that motions came with, and what other methods
// make of the document. All show the same moment.
import type { Failure, loadLimber, Session } from '@engine/limber.mjs';
import type {
  Answers, Command, ExportFormat, LimberError, Ray, SessionState, Stance, SurfaceModel, Variant,
} from './messages';

type Limber = Awaited<ReturnType<typeof loadLimber>>;
type Step = { state: SessionState | null; skin: Float32Array };

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

const withModel = /\.(glb|gltf|vrm)$/i;
const none = new Float32Array();

export class Documents {
  private session: Session;
  private state: SessionState | null = null;
  private seconds = 0;
  /** By the motion's name. */
  private sources = new Map<string, { session: Session; state: SessionState }>();
  private shownSource = '';
  private variants: { session: Session; clip: boolean }[] = [];

  constructor(private limber: Limber) {
    this.session = limber.createSession();
  }

  open(bytes: Uint8Array, name: string): Answers['open'] {
    const step = orThrow(this.session.open(bytes, name));
    this.forgetOthers();
    return this.after(step);
  }

  addMotion(bytes: Uint8Array, name: string): Answers['motion'] {
    const answer = this.after(orThrow(this.session.addMotion(bytes, name)));
    const motion = answer.state.motions.at(-1);
    if (motion && withModel.test(name)) this.addSource(motion.name, bytes, name);
    return answer;
  }

  run(command: Command): Answers['run'] {
    const step = orThrow(this.session.run(command));
    if (String(command.do).startsWith('open_')) this.forgetOthers();
    if (command.do === 'set_time') this.seconds = Number(command.seconds);
    if (step.state) return this.after(step);
    return { state: null, stance: this.stance(step.skin) };
  }

  pick(ray: Ray, slope: number) { return orThrow(this.session.pick(ray, slope)).hit; }
  model(): SurfaceModel { return orThrow(this.session.model()).model; }
  checkPly(bytes: Uint8Array, name: string) { orThrow(this.limber.checkPly(bytes, name)); }
  methods() { return this.limber.methods(); }
  export(format: ExportFormat) { return orThrow(this.session.export(format)).bytes; }
  record() { return JSON.stringify(this.session.record(), null, 1); }

  sourceModel(): Answers['source-model'] {
    const motion = this.state?.clips[this.state.clip ?? -1]?.source?.motion ?? '';
    const source = this.sources.get(motion);
    if (!source) return null;
    return { motion, model: orThrow(source.session.model()).model, joints: source.state.joints.length };
  }

  compare(commands: Command[]): Answers['compare'] {
    this.endComparison();
    const variants = commands.map((command): Variant | LimberError => {
      const session = this.limber.forkSession(this.session);
      if (!session) return { code: 'bad-argument', message: 'a joint is being dragged', where: '', remedy: '' };
      const step = session.run(command);
      if (!step.ok || !step.state) {
        session.free();
        return step.ok ? { code: 'engine', message: 'nothing came of it', where: '', remedy: '' } : step.error;
      }
      this.variants.push({ session, clip: step.state.clip !== null });
      return { model: orThrow(session.model()).model, state: step.state, measures: orThrow(session.measures()).measures };
    });
    const { skin } = orThrow(this.session.skin());
    return { measures: orThrow(this.session.measures()).measures, variants, stance: this.stance(skin) };
  }

  private after(step: Step): { state: SessionState; stance: Stance } {
    if (step.state) {
      this.state = step.state;
      this.seconds = step.state.seconds;
    }
    return { state: this.state!, stance: this.stance(step.skin) };
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
    this.endComparison();
  }

  private endComparison() {
    this.variants.forEach(({ session }) => session.free());
    this.variants = [];
  }

  private stance(skin: Float32Array): Stance {
    const variants = this.variants.map(({ session, clip }) => {
      const { skin: moved } = orThrow(clip ? session.run({ do: 'set_time', seconds: this.seconds }) : session.skin());
      return { skin: moved, handles: orThrow(session.handles()).handles };
    });
    return {
      skin, handles: orThrow(this.session.handles()).handles, source: orThrow(this.session.sourceJoints()).places,
      sourceSkin: this.sourceSkin(), variants,
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
