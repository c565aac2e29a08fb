// What all calls share: the engine, the store, and how a step of the one comes into the other.
import { EngineClient, EngineError } from '../../engine/client';
import type { Command, Crowd, PaintedWeights, SessionState, Stance, Step } from '../../engine/messages';
import { stageName } from '../../words/engine';
import { say } from '../../words/say';
import { keysThere } from '../keys';
import { noticeOf, type PageStore } from '../state';

const progressDelay = 250; // milliseconds before a wait is shown

/** Whether its rig is a named skeleton's, whose joints can be corrected. */
export const hasTemplate = (session: SessionState) => !session.own_rig && session.rigger === 'template';

export class Core {
  /** The joints stand anew; called for every frame of a drag. */
  onStance: (stance: Stance, ofClip: boolean) => void = () => {};
  /** The weights alone are others. */
  onWeights: (weights: PaintedWeights) => void = () => {};
  /** A new model was opened: the camera goes to it. */
  onOpened: () => void = () => {};
  /** Files of poses were brought. */
  onPoses: (files: File[]) => Promise<void> = async () => {};
  /** A file of many bodies was opened. */
  onCrowd: (crowd: Crowd, name: string) => Promise<void> = async () => {};
  /** Something is to be replaced: whether the user agrees. */
  ask: (title: string, detail: string, yes: string) => Promise<boolean> = async () => true;

  readonly engine = new EngineClient();
  /** As the joints stand now. */
  stance: Stance | null = null;

  private underWay = 0;
  private showTimer = 0;
  private stage = { stage: say('Starting'), fraction: 0 };
  /** Panels that show how joints stand. */
  private readers = new Set<(stance: Stance) => void>();
  private followers: (() => void)[] = [];
  private runners: ((command: Command) => Promise<void>)[] = [];

  constructor(readonly page: PageStore) {
    this.engine.onBusy = (busy) => this.showWork(busy);
    this.engine.onProgress = (stage, fraction) => {
      this.stage = { stage: stageName(stage), fraction };
      if (page.now.work) page.set({ work: this.stage });
    };
  }

  /** Live motion has carried the model away, and the camera with it: what comes next puts both back. */
  isCarried = false;

  /** Nothing that was begun is still under way. */
  get idle() { return this.underWay === 0; }

  /** Told as often as onStance, until what it gives is called. */
  readStance(reader: (stance: Stance) => void): () => void {
    this.readers.add(reader);
    return () => { this.readers.delete(reader); };
  }
  /** What stands beside the document goes with it: called once a step is in the store. */
  followSteps(follow: () => void) { this.followers.push(follow); }
  /** Called behind each command that went well. */
  followCommands(follow: (command: Command) => Promise<void>) { this.runners.push(follow); }

  /** Throws where the engine refuses. */
  async carryOut(command: Command) {
    this.take(await this.engine.run(command));
    for (const follow of this.runners) await follow(command);
  }

  async run(command: Command) { await this.guard(() => this.carryOut(command)); }

  /** What goes wrong is told; the page goes on. */
  async guard<T>(act: () => Promise<T>): Promise<T | null> {
    return this.counted(async () => {
      try {
        return await act();
      } catch (error) {
        const told = error instanceof EngineError
          ? error.error : { code: 'page', message: String(error), where: '', remedy: '' };
        if (told.code !== 'cancelled') this.page.set({ notice: noticeOf(told) });
        return null;
      }
    });
  }

  /** Under way until it is done. */
  async counted<T>(act: () => Promise<T>): Promise<T> {
    ++this.underWay;
    try {
      return await act();
    } finally {
      --this.underWay;
    }
  }

  /** The document as it stands after a step. */
  take({ state, stance, model, weights, others }: Step) {
    const before = this.page.now;
    if (state && model) {
      const another = state.members[state.member]?.name !== before.session?.members[before.session.member]?.name;
      const selected = another ? null : before.selected;
      if (another) this.page.set({ also: new Set(), hiddenParts: new Set(), comparison: null, painting: false, placing: false, paths: null, ghostsShown: [], curve: null });
      this.page.set({
        session: state, model, parts: null, others: others ?? (state.members.length > 1 ? before.others : []), seconds: state.seconds, playing: false, hovered: null,
        correcting: before.correcting && hasTemplate(state), chosenKeys: [],
        selected: selected !== null && selected < state.joints.length ? selected : null,
      });
    } else if (state) {
      const sameClip = state.clip === before.session?.clip;
      this.page.set({ session: state, seconds: state.seconds, chosenKeys: sameClip ? keysThere(before.chosenKeys, state) : [] });
    }
    if (weights) this.changeWeights(weights);
    const back = this.isCarried && state !== null && state.member === before.session?.member;
    if (state) this.isCarried = false;
    const another = back || (!model && state !== null && (state.clip !== before.session?.clip || state.seconds !== before.session?.seconds));
    this.showStance(stance, another);
    if (state) this.followers.forEach((follow) => follow());
  }

  private changeWeights(weights: PaintedWeights) {
    this.onWeights(weights);
    if (this.page.now.parts) this.page.set({ parts: null });
  }

  showStance(stance: Stance, ofClip: boolean) {
    this.stance = stance;
    if (stance.pinned.join() !== this.page.now.pinned.join()) this.page.set({ pinned: stance.pinned });
    this.onStance(stance, ofClip);
    this.readers.forEach((read) => read(stance));
  }

  jointName(joint: number) { return this.page.now.session?.joints[joint]?.name ?? ''; }

  /** The others that are selected, where the joint is. */
  besides(joint: number): number[] {
    const { selected, also } = this.page.now;
    return joint === selected || also.has(joint) ? [...also, selected ?? joint].filter((other) => other !== joint) : [];
  }

  /** With all that are selected. */
  namedWith(joint: number) {
    return { joint: this.jointName(joint), with: this.besides(joint).map((other) => this.jointName(other)) };
  }

  private showWork(busy: boolean) {
    clearTimeout(this.showTimer);
    this.stage = { stage: say('Working'), fraction: 0 };
    if (busy) this.showTimer = window.setTimeout(() => this.page.set({ work: this.stage }), progressDelay);
    else if (this.page.now.work) this.page.set({ work: null });
  }
}
