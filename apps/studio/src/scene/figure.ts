// A model that stands beside the one that is worked on.
import { Group, type Camera } from 'three';
import type { SessionState, SurfaceModel } from '../engine/messages';
import { HandleView } from './handle_view';
import { ModelView } from './model_view';

export class Figure {
  readonly root = new Group();
  readonly model = new ModelView();
  readonly handles = new HandleView();

  constructor() {
    this.root.add(this.model.root, this.handles.root);
  }

  show(surface: SurfaceModel, joints: SessionState['joints']) {
    this.model.show(surface, joints.length);
    this.handles.show(joints);
    this.handles.paint(new Set(), null, new Set());
  }

  fit(camera: Camera, height: number, shown: boolean) {
    this.handles.fit(camera, height, shown, shown);
  }

  dispose() {
    this.model.clear();
    this.root.removeFromParent();
  }
}
