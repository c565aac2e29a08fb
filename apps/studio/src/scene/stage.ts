// The scene shows what the page's state says.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { HandleView } from './handle_view';
import { ModelView } from './model_view';
import { PointerInput } from './pointer';
import { Viewport } from './viewport';

export interface Stage {
  viewport: Viewport;
  handles: HandleView;
}

export function createStage(studio: Studio, page: PageStore): Stage {
  const viewport = new Viewport(), model = new ModelView(), handles = new HandleView();
  viewport.scene.add(handles.root, model.root);
  new PointerInput(viewport, handles, studio, page);
  model.onChange = () => viewport.draw();
  viewport.beforeFrame = (camera) => {
    const { display, bones } = page.now;
    handles.fit(camera, viewport.size.height, display === 'handles', display === 'handles' && bones);
  };
  studio.onStance = (stance) => {
    model.take(stance.skin);
    handles.take(stance.handles);
    viewport.draw();
  };
  studio.onOpened = () => {
    const box = page.now.session?.box;
    if (box) viewport.frame(box.min, box.max);
  };
  page.watch((now, before) => {
    if (now.session && now.model && now.model !== before.model) model.show(now.model, now.session.joints.length);
    if (now.session && now.session !== before.session) handles.show(now.session.joints);
    const repaint = now.model !== before.model || now.display !== before.display || now.wireframe !== before.wireframe
      || (now.display === 'joint-weights' && now.selected !== before.selected);
    if (repaint) model.setDisplay(now.display, now.selected, now.wireframe);
    handles.paint(now.selected, now.hovered, new Set(now.session?.targets.map((target) => target.joint)));
    viewport.draw();
  });
  return { viewport, handles };
}
