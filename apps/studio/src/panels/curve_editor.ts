// How the selected joint turns or moves over the clip, as curves; its keys can be dragged in time and in value.
import { extentOf, frame, keysOf, onFrame } from '../app/keys';
import type { KeyPlace, PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Curve, Tangent, Vector } from '../engine/messages';
import { choice, element, svg } from '../ui/dom';
import { jointTitle } from '../words/parts';
import { number, say } from '../words/say';
import { slopeTo, tangentGrips, type CurveScale, type Place } from './curve_tangents';
import { chosenClip, shownSeconds } from './moments';

const axes = ['x', 'y', 'z'] as const;
const height = 132, margin = 14; // pixels
const inset = 8; // pixels left and right, as the slider above has them
const leastDrag = 4; // pixels
type Part = 'turn' | 'offset';
/** The least that the height shows, so that a joint that hardly moves does not look as if it did: degrees, metres. */
const leastRange: Record<Part, number> = { turn: 20, offset: 0.1 };
const unit: Record<Part, string> = { turn: '\u00b0', offset: ' m' };

interface Grabbed {
  key: KeyPlace;
  axis: number;
  x: number;
  y: number;
  dot: SVGElement;
}

/** A grip of a tangent that is held, and how steep it makes the curve. */
interface Pulled {
  key: KeyPlace;
  tangent: Tangent;
  axis: number;
  side: 1 | -1;
  slope: number;
}

export function curveEditor(studio: Studio, page: PageStore): HTMLElement {
  let part: Part = 'turn', grabbed: Grabbed | null = null, pulled: Pulled | null = null, end = 1, low = 0, high = 1, drawn: unknown = null;
  const parts = choice<Part>(say('Curves of'), [{ value: 'turn', text: say('Turn') }, { value: 'offset', text: say('Move') }], (value) => {
    part = value;
    draw();
  });
  const title = element('strong', { class: 'label' }), hint = element('p', { class: 'empty-keys' });
  const legend = element('div', { class: 'legend' }, ...axes.map((axis) => element('span', { class: axis }, axis)));
  const plot = svg('svg', { class: 'plot', id: 'curves', role: 'img' }), tangents = svg('g');
  const root = element('div', { class: 'curves', hidden: true }, element('div', { class: 'side-label' }, title, parts.root, legend), plot, hint);

  const width = () => Math.max(40, plot.clientWidth);
  const xOf = (seconds: number) => inset + (seconds / end) * (width() - 2 * inset);
  const yOf = (value: number) => margin + ((high - value) / (high - low)) * (height - 2 * margin);
  const valueOf = (curve: Curve, moment: number, axis: number) => curve.values[6 * moment + (part === 'turn' ? 0 : 3) + axis]!;
  const momentOf = (curve: Curve, { seconds }: KeyPlace) =>
    curve.moments.reduce((best, at, i) => (Math.abs(at - seconds) < Math.abs(curve.moments[best]! - seconds) ? i : best), 0);

  const draw = () => {
    const { session, curve, selected, seconds } = page.now;
    const clip = chosenClip(session), ready = clip !== null && curve !== null && curve.joint === selected && curve.moments.length > 1;
    parts.show(part);
    const joint = session?.joints[selected ?? -1];
    title.textContent = jointTitle(joint);
    plot.style.display = ready ? '' : 'none';
    hint.hidden = ready;
    hint.textContent = joint ? say('No curve yet: it takes keys at two moments.') : say('Select a joint to see its curves.');
    if (!ready || !clip || !curve) return;
    end = shownSeconds(clip, seconds);
    const values = curve.moments.flatMap((_, i) => axes.map((_axis, axis) => valueOf(curve, i, axis)));
    const middle = (Math.min(...values) + Math.max(...values)) / 2, half = Math.max(leastRange[part], Math.max(...values) - Math.min(...values)) / 2;
    [low, high] = [middle - 1.08 * half, middle + 1.08 * half];
    plot.setAttribute('aria-label', say(part === 'turn' ? 'Turn of {joint} over the clip' : 'Movement of {joint} over the clip', { joint: title.textContent }));
    drawTangents();
    plot.replaceChildren(...scale(), ...axes.map((axis, a) => svg('polyline', {
      class: axis, points: curve.moments.map((at, i) => `${xOf(at).toFixed(1)},${yOf(valueOf(curve, i, a)).toFixed(1)}`).join(' '),
    })), ...keysOf(session).filter((key) => key.joint === selected).flatMap((key) => axes.map((axis, a) => {
      const dot = svg('circle', { class: axis, r: 5, cx: xOf(key.seconds), cy: yOf(valueOf(curve, momentOf(curve, key), a)) });
      dot.addEventListener('pointerdown', (event) => take(event, key, a, dot));
      return dot;
    })), tangents, svg('line', { class: 'now', x1: xOf(seconds), x2: xOf(seconds), y1: 0, y2: height }));
  };
  /** Of the chosen key of the curves that are drawn. */
  const drawTangents = () => {
    const { curve, chosenKeys, selected } = page.now;
    const key = chosenKeys.find(({ joint }) => joint === selected);
    const at = key && curve?.tangents.find(({ seconds }) => Math.abs(seconds - key.seconds) < frame / 4);
    tangents.replaceChildren(...!key || !at || !curve ? [] : axes.flatMap((axis, a) => {
      const slope = pulled?.axis === a ? pulled.slope : at[part][a]!;
      return tangentGrips(placeOf(curve, key, a), slope, scaleOf(), axis, (event, side) => {
        event.preventDefault();
        pulled = { key, tangent: at, axis: a, side, slope };
        plot.setPointerCapture(event.pointerId);
      });
    }));
  };
  const placeOf = (curve: Curve, key: KeyPlace, axis: number): Place => ({ x: xOf(key.seconds), y: yOf(valueOf(curve, momentOf(curve, key), axis)) });
  const scaleOf = (): CurveScale => ({ second: (width() - 2 * inset) / end, unit: (height - 2 * margin) / (high - low) });
  const pull = ({ clientX, clientY }: PointerEvent) => {
    const { curve } = page.now, { left, top } = plot.getBoundingClientRect();
    if (!pulled || !curve) return;
    const { x, y } = placeOf(curve, pulled.key, pulled.axis);
    pulled.slope = slopeTo(clientX - left - x, clientY - top - y, pulled.side, scaleOf());
    drawTangents();
  };
  const letGo = (act: boolean) => {
    const done = pulled!;
    pulled = null;
    if (!act || done.slope === done.tangent[part][done.axis]) return drawTangents();
    const slopes = { turn: [...done.tangent.turn] as Vector, offset: [...done.tangent.offset] as Vector };
    slopes[part][done.axis] = done.slope;
    void studio.setSlope(done.key, slopes.turn, slopes.offset);
  };
  /** The least, the middle and the most, each with its line. */
  const scale = () => [high - (high - low) * 0.04, (low + high) / 2, low + (high - low) * 0.04].flatMap((value) => {
    const text = svg('text', { x: inset, y: yOf(value) - 3 });
    text.textContent = `${number(value, part === 'turn' ? 0 : 2)}${unit[part]}`;
    return [svg('line', { class: 'grid', x1: 0, x2: width(), y1: yOf(value), y2: yOf(value) }), text];
  });

  const take = (event: PointerEvent, key: KeyPlace, axis: number, dot: SVGElement) => {
    event.preventDefault();
    page.set({ chosenKeys: [key] });
    grabbed = { key, axis, x: event.clientX, y: event.clientY, dot };
    plot.setPointerCapture(event.pointerId);
  };
  /** A key goes one way at a time: earlier and later, or up and down. */
  const wayOf = ({ x, y }: Grabbed, event: PointerEvent) => {
    const [across, up] = [event.clientX - x, y - event.clientY];
    if (Math.hypot(across, up) < leastDrag) return {};
    return Math.abs(across) > Math.abs(up)
      ? { seconds: (across / (width() - 2 * inset)) * end } : { value: (up / (height - 2 * margin)) * (high - low) };
  };
  plot.addEventListener('pointermove', (event) => {
    const { curve } = page.now;
    if (pulled) return pull(event);
    if (!grabbed || !curve) return;
    const { seconds = 0, value = 0 } = wayOf(grabbed, event), { key, axis, dot } = grabbed;
    dot.setAttribute('cx', String(xOf(Math.max(0, key.seconds + seconds))));
    dot.setAttribute('cy', String(yOf(valueOf(curve, momentOf(curve, key), axis) + value)));
  });
  const finish = (act: boolean) => (event: PointerEvent) => {
    const { curve } = page.now, done = grabbed;
    if (pulled) return letGo(act);
    grabbed = null;
    if (!done || !curve) return;
    const { seconds, value } = wayOf(done, event), { key, axis } = done;
    if (act && seconds !== undefined) {
      const shift = Math.max(onFrame(key.seconds + seconds) - key.seconds, -extentOf([key])[0]);
      if (Math.abs(shift) > frame / 4) return void studio.editKeys([key], { shift });
    } else if (act && value !== undefined) {
      const from = 6 * momentOf(curve, key), standing = [...curve.values.subarray(from, from + 6)];
      standing[(part === 'turn' ? 0 : 3) + axis]! += value;
      return void studio.setJointKey(key, standing.slice(0, 3) as Vector, standing.slice(3) as Vector);
    }
    draw();
  };
  plot.addEventListener('pointerup', finish(true));
  plot.addEventListener('pointercancel', finish(false));
  new ResizeObserver(draw).observe(root);

  page.watch(({ session, curve, selected, seconds, keyEditor, chosenKeys }, before) => {
    if (keyEditor !== 'curves' || grabbed || pulled) return;
    if (chosenKeys !== before.chosenKeys) drawTangents();
    const now = `${selected} ${session?.clip}`;
    if (drawn === curve && plot.dataset['of'] === now && plot.isConnected) {
      const line = plot.querySelector('.now');
      line?.setAttribute('x1', String(xOf(seconds)));
      line?.setAttribute('x2', String(xOf(seconds)));
      if (curve !== null) return;
    }
    drawn = curve;
    plot.dataset['of'] = now;
    draw();
  });
  return root;
}
