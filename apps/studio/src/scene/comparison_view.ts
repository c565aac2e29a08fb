// What other methods make of the document, in a row beside it.
import { Vector3, type Camera, type Scene } from 'three';
import type { PageState } from '../app/state';
import type { Stance } from '../engine/messages';
import { Figure } from './figure';

const room = 0.25; // between neighbours, as a share of the model's width

export class ComparisonView {
  /** Where each figure's feet are, as a share of the canvas from its left; the document's own first. */
  onPlaced: (places: number[]) => void = () => {};

  private figures: Figure[] = [];
  private shown: PageState['comparison'] = null;
  private step = 1;
  private feet = new Vector3();

  constructor(private scene: Scene, private onChange: () => void) {}

  /** Whether there is another row of figures than before; the camera then takes all of them in. */
  show({ comparison, session, display, wireframe, selected }: PageState): boolean {
    const anew = comparison !== this.shown;
    const count = this.figures.length;
    if (anew) {
      this.figures.forEach((figure) => figure.dispose());
      this.figures = [];
      this.shown = comparison;
    }
    if (!session || !comparison) return anew && count > 0;
    const { min, max } = session.box;
    const width = Math.max(max[0] - min[0], 0.5 * (max[1] - min[1]));
    this.step = (1 + room) * width;
    this.feet.set((min[0] + max[0]) / 2, min[1], (min[2] + max[2]) / 2);
    if (anew) {
      for (const variant of comparison.variants) {
        const figure = new Figure();
        figure.root.position.x = (this.figures.length + 1) * this.step;
        figure.model.onChange = this.onChange;
        if ('model' in variant) figure.show(variant.model, variant.state.joints);
        this.figures.push(figure);
        this.scene.add(figure.root);
      }
    }
    this.figures.forEach(({ model }) => model.setDisplay(display, selected, wireframe));
    return anew && count !== this.figures.length;
  }

  take(variants: Stance['variants']) {
    let next = 0;
    this.shown?.variants.forEach((variant, i) => {
      const stance = 'model' in variant ? variants[next++] : undefined;
      if (!stance) return;
      this.figures[i]?.model.take(stance.skin, stance.posed);
      this.figures[i]?.handles.take(stance.handles);
    });
  }

  /** How much further to the right the row reaches than the document alone, in metres. */
  get reach() { return this.figures.length * this.step; }

  fit(camera: Camera, height: number, handles: boolean) {
    this.figures.forEach((figure) => figure.fit(camera, height, handles));
    if (!this.shown) return;
    this.onPlaced([0, ...this.figures.map((_, i) => i + 1)].map((i) =>
      (this.feet.clone().setX(this.feet.x + i * this.step).project(camera).x + 1) / 2));
  }
}
