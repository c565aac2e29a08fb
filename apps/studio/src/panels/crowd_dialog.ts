// A crowd's file, to look at: all its bodies, moving.
import { Vector3 } from 'three';
import type { Crowd, Vector } from '../engine/messages';
import { CrowdView } from '../scene/crowd_view';
import { Viewport } from '../scene/viewport';
import { counted } from '../ui/counted';
import { button, element, setIcon } from '../ui/dom';
import { inSeconds, number, say } from '../words/say';

/** What a program that drives the page can ask of it. */
export interface CrowdProbe {
  crowd: Crowd;
  /** Milliseconds that the page took to place all joints of all bodies, of the last hundred frames. */
  placing: number[];
  /** The crowd as it is drawn at a moment, or what is drawn without it: pixels, row by row from below, four bytes each. */
  pixels(seconds: number, drawn: boolean): { width: number; height: number; bytes: Uint8Array };
  /** Where a point of the world is drawn among them. */
  pixelOf(point: Vector): { x: number; y: number };
}

declare global {
  var limberCrowd: CrowdProbe | undefined;
}

/** Opens over the page, and is gone once it is closed. */
export function showCrowd(crowd: Crowd, name: string, into: HTMLElement) {
  const view = new CrowdView(crowd), viewport = new Viewport(), placing: number[] = [];
  viewport.canvas.setAttribute('aria-label', say('The crowd'));
  viewport.scene.add(view.root);
  view.onChange = () => viewport.draw();
  let seconds = 0, playing = true, before = performance.now(), running = 0;

  const play = button('', () => { playing ? stop() : start(); }, { icon: 'pause', label: say('Pause'), id: 'play-crowd' });
  const scrub = element('input', { type: 'range', id: 'scrub-crowd', min: 0, max: crowd.seconds, step: 'any', 'aria-label': say('Moment of the clip') });
  const time = element('output', { class: 'time' }, '');
  const dialog: HTMLDialogElement = element('dialog', { class: 'crowd', id: 'crowd', 'aria-label': name },
    element('h2', {}, `${name}: ${counted(crowd.bodies.length, 'bodie')}`), viewport.canvas,
    element('div', { class: 'row' }, play, scrub, time, button(say('Close'), () => dialog.close(), { kind: 'primary', id: 'close-crowd' })));

  function show(moment: number) {
    seconds = moment;
    const begun = performance.now();
    view.show(seconds);
    placing.push(performance.now() - begun);
    if (placing.length > 100) placing.shift();
    scrub.value = String(seconds);
    time.textContent = `${number(seconds, 2)} / ${inSeconds(crowd.seconds, 2)}`;
    viewport.draw();
  }
  function step(now: number) {
    show((seconds + Math.max(0, now - before) / 1000) % crowd.seconds);
    before = now;
    running = requestAnimationFrame(step);
  }
  function start() {
    playing = true;
    before = performance.now();
    running = requestAnimationFrame(step);
    setIcon(play, 'pause');
    play.setAttribute('aria-label', say('Pause'));
  }
  function stop() {
    playing = false;
    cancelAnimationFrame(running);
    setIcon(play, 'play');
    play.setAttribute('aria-label', say('Play'));
  }
  scrub.addEventListener('input', () => {
    const to = scrub.valueAsNumber; // before it is drawn where it was
    stop();
    show(to);
  });
  dialog.addEventListener('close', () => {
    stop();
    view.dispose();
    viewport.controls.dispose(); // it listens on the page
    viewport.renderer.dispose();
    viewport.renderer.forceContextLoss();
    dialog.remove();
    delete globalThis.limberCrowd;
  });
  globalThis.limberCrowd = {
    crowd, placing,
    pixels(moment, drawn) {
      stop();
      show(moment);
      view.root.visible = drawn;
      viewport.drawNow();
      view.root.visible = true;
      const context = viewport.renderer.getContext(), { drawingBufferWidth: width, drawingBufferHeight: height } = context;
      const bytes = new Uint8Array(4 * width * height);
      context.readPixels(0, 0, width, height, context.RGBA, context.UNSIGNED_BYTE, bytes);
      return { width, height, bytes };
    },
    pixelOf(point) {
      const { x, y } = new Vector3(...point).project(viewport.camera), { width, height } = viewport.canvas;
      return { x: ((x + 1) / 2) * width, y: ((y + 1) / 2) * height };
    },
  };
  into.append(dialog);
  dialog.showModal();
  viewport.frame(view.box);
  start();
}
