// Who calls for the next frame: the window or, while it draws frames of its own, augmented reality, in which the window's may stop.
type Step = (now: number) => void;
let ask: (step: Step) => void = (step) => void requestAnimationFrame(step);

export const nextFrame = (step: Step) => ask(step);

/** Until what it gives is called. */
export function framesFrom(source: (step: Step) => void): () => void {
  const before = ask;
  ask = source;
  return () => { ask = before; };
}
