// Models and documents opened, and models added to the scene: from files, addresses, samples, and what the browser kept.
import { EngineError, refusal } from '../../engine/client';
import type { Request, Step } from '../../engine/messages';
import { counted } from '../../ui/counted';
import { told } from '../../words/engine';
import { say } from '../../words/say';
import { isCrowd, sorted, withBuffers, withPictures, type Brought } from '../files';
import type { Journal, KeptDocument } from '../journal';
import { fromLimberFile, toLimberFile } from '../limber_file';
import { openSample, sceneRecord } from '../samples';
import type { Notice } from '../state';
import type { ClipCalls } from './clips';
import type { ComparingCalls } from './comparing';
import type { Core } from './core';
import type { MotionCalls } from './motions';
import type { RigCalls } from './rig';

const mostFileSize = 500e6; // bytes

const noModel = (): Notice => ({ kind: 'error', title: say('There is no model in it'), detail: say('Open GLB, glTF, VRM, OBJ, FBX, STL, PLY or BVH') });

export type OpeningCalls = ReturnType<typeof openingCalls>;

export function openingCalls(
  core: Core, journal: Journal, { forgetMoment }: ClipCalls, { openMotions }: MotionCalls, { openLimits }: RigCalls, { openReport }: ComparingCalls,
) {
  const { page, engine } = core;
  let openings = 0, opening: Promise<unknown> = Promise.resolve();
  engine.onChange = (request, place) => journal.add(request, place);

  /** Of models that are asked for while another one is being opened the last is opened, the others never. */
  async function open(make: () => Promise<Opened | null>) {
    const mine = ++openings, before = opening;
    page.set({ playing: false });
    forgetMoment();
    opening = core.guard(async () => {
      await before;
      if (mine !== openings) return;
      page.set({ notice: null }); // before, not after: what cannot be kept is told while it opens
      const opened = await make();
      if (opened) show(opened);
    });
    await opening;
  }

  interface Opened {
    step: Step;
    notice?: Notice | null;
  }

  function show({ step, notice = null }: Opened) {
    page.set({
      others: [], arranging: false,
      selected: null, hovered: null, comparison: null, hiddenParts: new Set(), correcting: false, painting: false, placing: false, selecting: false, display: 'handles',
      ...notice && { notice },
    });
    core.take(step);
    core.onOpened();
  }

  /** A crowd is to be looked at; the model that is worked on stays. */
  async function openBytes(bytes: Uint8Array, name: string): Promise<Opened | null> {
    if (!isCrowd(bytes)) return { step: await engine.ask({ kind: 'open', bytes, name, limbsFollow: true }) };
    await core.onCrowd(await engine.ask({ kind: 'crowd', bytes, name }), name);
    return null;
  }

  /** A document by all that was done; one that was kept goes on where it is. */
  async function restore(requests: Request[], name: string, kept: KeptDocument | null = null): Promise<Opened> {
    const { step, failed, error } = await engine.restore(requests);
    if (!step) throw error ? new EngineError(error) : refusal(say('There is no model in it'), name);
    const all = engine.requests;
    const own = kept ? await journal.resume(kept, all, requests.length) : journal.begin(name, all);
    if (failed > 0) {
      const title = say('{steps} of {all} could not be brought back', { steps: counted(failed, 'step'), all: requests.length });
      return { step, notice: { kind: 'error', title, detail: error ? told(error).title : '' } };
    }
    if (own) return { step };
    return { step, notice: {
      kind: 'note', title: say('This model is open in another tab as well'), detail: say('What you do here is kept as a copy of {name}', { name }),
    } };
  }

  async function broughtBy(files: File[]): Promise<Brought | null> {
    const large = files.find(({ size }) => size > mostFileSize);
    if (!large) return core.guard(() => sorted(files));
    page.set({ notice: { kind: 'error', title: say('This file is too large for a browser'), detail: say('{name} has more than {size} MB. Make it smaller, or rig it with the program: limber rig', { name: large.name, size: mostFileSize / 1e6 }) } });
    return null;
  }

  /** What the engine reads of it. */
  async function readModel(file: File, beside: Map<string, File>): Promise<{ bytes: Uint8Array; name: string }> {
    const { name } = file, bytes = new Uint8Array(await file.arrayBuffer());
    if (/\.(glb|vrm)$/i.test(name)) return { bytes, name };
    if (/\.gltf$/i.test(name)) return { bytes: await withBuffers(bytes, beside), name };
    if (/\.fbx$/i.test(name)) return { bytes: await withPictures(bytes, name, beside), name };
    if (/\.ply$/i.test(name)) await engine.ask({ kind: 'check-ply', bytes, name });
    const { toGlb } = await import('../import_model');
    return { bytes: await toGlb(bytes, name, beside), name };
  }

  async function openModel(file: File, beside: Map<string, File>) {
    await open(async () => {
      if (/\.limber$/i.test(file.name)) return restore(fromLimberFile(new Uint8Array(await file.arrayBuffer()), file.name), file.name);
      const { bytes, name } = await readModel(file, beside);
      return openBytes(bytes, name);
    });
  }

  async function join(make: () => Promise<Step>) {
    if (!page.now.session) return;
    page.set({ playing: false, comparison: null });
    forgetMoment(); // it was another model's
    await core.guard(async () => {
      core.take(await make());
      core.onOpened();
    });
  }

  return {
    async openSample(name: string) { await open(async () => ({ step: await engine.run(openSample(name)) })); },

    /** One of samples/scenes, done again command by command: each can be undone. */
    async openScene(name: string, title: string) {
      await open(async () => {
        const record = await sceneRecord(name).catch(() => null);
        if (!record) throw refusal(say('the scene cannot be fetched'), name, say('look at the connection, and try again'));
        return restore(record.commands.map((command) => ({ kind: 'run', command })), title);
      });
    },

    /** A model with what belongs to it, motions for it, poses, limits, or a study's report. */
    async openFiles(files: File[]) {
      const brought = await broughtBy(files);
      if (!brought) return;
      const { model, motions, poses, limits, report, beside } = brought;
      if (model) await openModel(model, beside);
      await openMotions(motions);
      if (poses.length > 0) await core.onPoses(poses);
      if (limits) await openLimits(limits);
      if (report) await openReport(report);
      if (files.length > 0 && !model && motions.length === 0 && poses.length === 0 && !limits && !report) page.set({ notice: noModel() });
    },

    async openAddress(address: string) {
      await open(async () => {
        const response = await fetch(address).catch(() => null);
        if (!response?.ok) {
          throw refusal(say('the model cannot be fetched'), address, say('the other site must allow it (CORS); or save the file and drop it here'));
        }
        const name = decodeURIComponent(new URL(address, location.href).pathname.split('/').pop() ?? 'model.glb');
        return openBytes(new Uint8Array(await response.arrayBuffer()), name);
      });
    },

    /** A document that this browser kept, as it was left. */
    async openKept(document: KeptDocument) {
      await open(async () => restore(await journal.requestsOf(document.id), document.name, document));
    },

    changing: () => engine.changing,
    stepCount: () => engine.requests.length,

    /** Everything, to go on with here or elsewhere. */
    limberFile: (): Uint8Array => toLimberFile(engine.requests),

    /** Another model beside those that are there; as a prop without joints of its own. */
    async addSample(name: string, asProp: boolean) {
      await join(() => engine.run({ do: 'add_sample', name, limbs_follow: !asProp, as_prop: asProp }));
    },
    async addFiles(files: File[], asProp: boolean) {
      const brought = await broughtBy(files);
      if (!brought) return;
      const { model, beside } = brought;
      if (!model || /\.limber$/i.test(model.name)) return page.set({ notice: noModel() });
      await join(async () => {
        const { bytes, name } = await readModel(model, beside);
        return engine.ask({ kind: 'add', bytes, name, limbsFollow: !asProp, asProp });
      });
    },
  };
}
