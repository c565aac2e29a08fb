// What the panel in space says and offers: the phone's actions, and what the page tells beside them.
import { samples } from '../../app/samples';
import type { PageState } from '../../app/state';
import { limbState, limbStates } from '../../panels/follow_switch';
import { mostHandlesOf } from '../../panels/pose_panel';
import { counted } from '../../ui/counted';
import { offer, type IconName } from '../../ui/dom';
import { say } from '../../words/say';
import { arActions, dragModes, isPlacing, isPosing, type ArAction, type ArActions } from '../actions';
import { plainBackground } from '../ar_picture';
import type { ArView } from '../ar_view';
import { helpLine } from '../help_line';

export interface Cell {
  id: string;
  text: string;
  icon?: IconName;
  act(): void;
  enabled: boolean;
  pressed: boolean;
  primary: boolean;
}

export interface PanelContent {
  title: string;
  /** Below it, smaller. */
  detail: string;
  error: boolean;
  rows: Cell[][];
}

interface Question { title: string; detail: string; yes: string; answer(agreed: boolean): void }

const listRows = 3; // above the one that leaves the list
const handleStep = 0.2; // of the handles that there are, for a press

export class PanelContents {
  onChange = () => {};
  private readonly actions: ArActions;
  private question: Question | null = null;
  /** What a list is shown of, instead of the tools. */
  private choosing: 'sample' | 'member' | null = null;

  constructor(private ar: ArView) { this.actions = arActions(ar.desk, () => ar); }

  /** Asks here, where it is seen. */
  ask(title: string, detail: string, yes: string): Promise<boolean> {
    this.question?.answer(false);
    return new Promise((resolve) => {
      const answer = (agreed: boolean) => {
        this.question = null;
        this.onChange();
        resolve(agreed);
      };
      this.question = { title, detail, yes, answer };
      this.onChange();
    });
  }

  /** Nobody is there any more to answer. */
  close() { this.question?.answer(false); }

  of(now: PageState): PanelContent {
    const { question } = this, { notice, work } = now, { page } = this.ar.desk;
    if (question) {
      const { title, detail, yes, answer } = question;
      return { title, detail, error: false, rows: [[this.cell('ask-no', say('Leave it as it is'), () => answer(false)), this.cell('ask-yes', yes, () => answer(true), { primary: true })]] };
    }
    if (notice) {
      return { title: notice.title, detail: notice.detail, error: notice.kind === 'error', rows: [[this.cell('close-notice', say('Close'), () => page.set({ notice: null }))]] };
    }
    const line = work ? `${work.stage}\u2026` : helpLine(now, true);
    return { title: line, detail: '', error: now.ar?.trouble != null, rows: this.rows(now) };
  }

  private rows(now: PageState): Cell[][] {
    if (isPlacing(now) || !this.choosing) return this.tools(now);
    return this.choosing === 'sample' ? this.samples() : this.members(now);
  }

  private tools(now: PageState): Cell[][] {
    const { leave, history, place, tools } = this.actions, { studio, page } = this.ar.desk;
    const add = this.cell('open-add', say('Add'), () => this.choose('sample'), { icon: 'add' });
    const others = this.cell('open-members', say('Models'), () => this.choose('member'), { enabled: (now.session?.members.length ?? 0) > 1 });
    const picture = this.cell('ar-picture', say('Picture'), () => void this.takePicture(), { icon: 'camera' });
    const step = (text: string, id: string, by: 1 | -1) => this.cell(id, text, () => {
      const count = studio.handleCount();
      void studio.setHandles(Math.max(1, Math.min(mostHandlesOf(now), count + by * Math.max(1, Math.round(handleStep * count)))));
    });
    const count = this.cell('handles', counted(studio.handleCount(), 'handle'), () => {}, { enabled: false });
    const modes = dragModes().map(({ value, text, icon }) => this.cell(`mode-${value}`, text, () => page.set({ mode: value }), { icon, pressed: now.mode === value }));
    const limbs = limbStates().map(({ value, text }) =>
      this.cell(`limb-${value}`, text, () => void studio.setIk(value === 'follow'), { pressed: limbState(now.session) === value }));
    return [
      [place, ...tools].filter((action) => action.shown(now)).map((action) => this.cellOf(action, now, action === place)).concat(isPlacing(now) ? [] : [add]),
      ...(isPosing(now) ? [[step('\u2212', 'fewer-handles', -1), count, step('+', 'more-handles', 1)], modes, limbs] : []),
      [...history.map((action) => this.cellOf(action, now)), ...(isPlacing(now) ? [] : [others, picture]), this.cellOf(leave, now)],
    ];
  }

  private samples(): Cell[][] {
    const { studio } = this.ar.desk;
    return this.list(samples.map(([name, text]) => this.chosen(`sample-${name}`, say(text), () => void studio.addSample(name, false))));
  }

  private members({ session }: PageState): Cell[][] {
    const { studio } = this.ar.desk;
    return this.list((session?.members ?? []).map(({ name }, member) =>
      this.chosen(`member-${member}`, name, () => void studio.chooseMember(member), { pressed: member === session?.member })));
  }

  private chosen(id: string, text: string, act: () => void, more: Partial<Cell> = {}): Cell {
    return this.cell(id, text, () => {
      this.choose(null);
      act();
    }, more);
  }

  /** In as few rows as the panel has room for. */
  private list(cells: Cell[]): Cell[][] {
    const wide = Math.max(3, Math.ceil(cells.length / listRows));
    const rows = Array.from({ length: Math.ceil(cells.length / wide) }, (_, row) => cells.slice(row * wide, (row + 1) * wide));
    return [...rows, [this.cell('close-list', say('Cancel'), () => this.choose(null))]];
  }

  /** On a colour where the browser keeps what the eyes see to itself. */
  private async takePicture() {
    const picture = await this.ar.picture(null) ?? await this.ar.picture(plainBackground);
    if (!picture) return;
    offer(picture, 'image/png', `${say('AR picture')}.png`);
    this.ar.desk.page.set({ notice: { kind: 'note', title: say('The picture is saved'), detail: '' } });
  }

  private choose(choosing: 'sample' | 'member' | null) {
    this.choosing = choosing;
    this.onChange();
  }

  private cellOf(action: ArAction, now: PageState, primary = false): Cell {
    return this.cell(action.id, action.text, action.act, {
      enabled: action.enabled?.(now) ?? true, pressed: action.pressed?.(now) ?? false, primary, ...(action.icon ? { icon: action.icon(now) } : {}),
    });
  }

  private cell(id: string, text: string, act: () => void, more: Partial<Cell> = {}): Cell {
    return { id, text, act, enabled: true, pressed: false, primary: false, ...more };
  }
}
