// The members of the scene that are not chosen, each where it stands.
import { Group } from 'three';
import type { OtherMember, Stance } from '../engine/messages';
import { ModelView } from './model_view';
import type { Places } from './places';

export class OthersView {
  readonly root = new Group();
  private shown: readonly OtherMember[] = [];
  private views = new Map<number, ModelView>();

  constructor(private onChange: () => void) {}

  show(others: readonly OtherMember[], wireframe: boolean) {
    if (others !== this.shown) {
      this.views.forEach((view) => {
        view.clear();
        view.root.removeFromParent();
      });
      this.views.clear();
      this.shown = others;
      for (const { member, model, joints } of others) {
        const view = new ModelView();
        view.onChange = this.onChange;
        view.root.matrixAutoUpdate = false;
        view.show(model, joints);
        this.views.set(member, view);
        this.root.add(view.root);
      }
    }
    this.views.forEach((view) => view.setDisplay('surface', null, wireframe));
  }

  take(skins: Stance['others']) {
    skins.forEach(({ member, skin, posed }) => this.views.get(member)?.take(skin, posed));
  }

  stand(places: Places) {
    this.views.forEach(({ root }, member) => {
      root.matrix.copy(places.of(member));
      root.updateMatrixWorld(true);
    });
  }
}
