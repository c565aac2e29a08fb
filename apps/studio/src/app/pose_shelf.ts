// What a user does with whole poses: copies and pastes them, keeps them under a name, brings and takes them as files.
import { EngineError } from '../engine/client';
import type { KeptPose, PoseStore } from './pose_store';
import { noticeOf, type PageStore } from './state';
import type { Studio } from './studio';
import { say } from '../words/say';

const mostSize = 4e6; // bytes of a file, as the engine has it
const ending = '.pose.json';

const newId = () => `${Date.now().toString(36)}-${Math.random().toString(36).slice(2, 8)}`;

/** The text of a file with that name in it. */
export function poseFile({ name, pose }: Pick<KeptPose, 'name' | 'pose'>): { file: string; text: string } {
  const text = JSON.stringify({ ...JSON.parse(pose), name }, null, 1);
  return { file: `${name.replace(/[\\/:*?"<>|]/g, '_')}${ending}`, text };
}

export class PoseShelf {
  private pasting = false;

  constructor(private studio: Studio, private page: PageStore, private store: PoseStore) {
    studio.onPoses = (files) => this.open(files);
  }

  async copy() {
    if (!this.page.now.session) return;
    const copiedPose = await this.studio.copyPose('');
    if (copiedPose !== null) this.page.set({ copiedPose });
  }

  async paste({ mirrored = false } = {}) {
    const { copiedPose, session } = this.page.now;
    if (copiedPose === null || !session || this.pasting) return;
    this.pasting = true;
    await this.studio.applyPose(copiedPose, { mirrored });
    this.pasting = false;
  }

  /** What another tab kept is there as well; what could not be kept stays while the page lives. */
  async load() {
    const before = new Set(this.page.now.ownPoses.map(({ id }) => id));
    const kept = await this.store.list().catch(() => []), ids = new Set(kept.map(({ id }) => id));
    const unkept = this.page.now.ownPoses.filter(({ id }) => !ids.has(id) && (this.unkept.has(id) || !before.has(id)));
    this.page.set({ ownPoses: [...unkept, ...kept] });
  }
  private unkept = new Set<string>();

  /** The pose that is shown; without a name it gets a number. */
  async save(name: string) {
    const pose = await this.studio.copyPose(name);
    if (pose !== null) await this.add([{ id: newId(), name: this.freeName(name || say('Pose')), pose, picture: '', made: Date.now() }]);
  }

  async rename(kept: KeptPose, name: string) { await this.change({ ...kept, name }); }
  async describe(kept: KeptPose, picture: string) { await this.change({ ...kept, picture }); }

  async forget({ id }: KeptPose) {
    this.page.set({ ownPoses: this.page.now.ownPoses.filter((kept) => kept.id !== id) });
    await this.store.forget(id).catch(() => {}); // it was never kept then
  }

  /** One that was forgotten, in its place again: the newest come first. */
  async bringBack(pose: KeptPose) {
    this.page.set({ ownPoses: [...this.page.now.ownPoses, pose].sort((a, b) => b.made - a.made) });
    await this.keep([pose]);
  }

  /** Kept, and one that comes alone is put on the model at once. */
  private async open(files: File[]) {
    const poses: KeptPose[] = [];
    for (const file of files) {
      const pose = await this.checked(file);
      if (pose) poses.push({ id: newId(), name: this.freeName(nameIn(pose, file.name)), pose, picture: '', made: Date.now() });
    }
    if (poses.length === 0) return;
    await this.add(poses);
    if (files.length > 1) this.page.set({ poseLibrary: true });
    else await this.studio.applyPose(poses[0]!.pose);
  }

  /** The text of a file that holds a pose; what is wrong with it is told. */
  private async checked(file: File): Promise<string | null> {
    const refuse = (error: EngineError['error']) => {
      this.page.set({ notice: noticeOf({ ...error, where: [file.name, error.where].filter((text) => text !== '').join(': ') }) });
      return null;
    };
    if (file.size > mostSize) return refuse({ code: 'page', message: say('The pose is larger than 4 MB'), where: '', remedy: '' });
    const pose = await file.text(), preview = await this.studio.previewPose(pose);
    const error = preview?.error;
    // A pose for another kind of body is one all the same.
    return error && error.code !== 'unsupported' ? refuse(error) : pose;
  }

  private async add(poses: KeptPose[]) {
    this.page.set({ ownPoses: [...poses, ...this.page.now.ownPoses] });
    await this.keep(poses);
  }

  private async change(changed: KeptPose) {
    this.page.set({ ownPoses: this.page.now.ownPoses.map((kept) => (kept.id === changed.id ? changed : kept)) });
    await this.keep([changed]);
  }

  private async keep(poses: KeptPose[]) {
    try {
      await this.store.put(poses);
      poses.forEach(({ id }) => this.unkept.delete(id));
    } catch (error) {
      poses.forEach(({ id }) => this.unkept.add(id));
      const why = error instanceof Error ? error.message : String(error);
      this.page.set({ notice: {
        kind: 'error', title: say('This browser cannot keep your poses'), detail: say('Save them as files before you leave ({why})', { why }),
      } });
    }
  }

  private freeName(wanted: string): string {
    const names = new Set(this.page.now.ownPoses.map(({ name }) => name));
    if (!names.has(wanted)) return wanted;
    let number = 2;
    while (names.has(`${wanted} ${number}`)) ++number;
    return `${wanted} ${number}`;
  }
}

/** As the file says, else what it is called. */
function nameIn(pose: string, file: string): string {
  const { name } = JSON.parse(pose) as { name?: unknown };
  return typeof name === 'string' && name !== '' ? name : file.replace(/(\.pose)?\.json$/i, '');
}
