// The scene shows what the page's state says.
import { Vector3 } from 'three';
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { ComparisonView } from './comparison_view';
import { Gizmo } from './gizmo';
import { HandleView } from './handle_view';
import { LimitView } from './limit_view';
import { ModelView } from './model_view';
import { OnionView } from './onion_view';
import { boneColor, partColor } from './palette';
import { BoxSelect } from './box_select';
import { BrushView } from './brush_view';
import { PaintInput } from './paint_input';
import { PointerInput } from './pointer';
import { matchColors, SourceView } from './source_view';
import { Viewport } from './viewport';

export interface Stage {
  viewport: Viewport;
  handles: HandleView;
  model: ModelView;
  comparison: ComparisonView;
  gizmo: Gizmo;
}

export function createStage(studio: Studio, page: PageStore): Stage {
  const viewport = new Viewport(), model = new ModelView(), handles = new HandleView();
  const source = new SourceView(), limits = new LimitView(), onion = new OnionView();
  const comparison = new ComparisonView(viewport.scene, () => viewport.draw());
  viewport.tools.push(handles.root, source.root, limits.root, onion.root);
  viewport.scene.add(handles.root, model.root, source.root, source.model.root, limits.root, onion.root);
  source.model.onChange = () => viewport.draw();
  const gizmo = new Gizmo(viewport, handles, studio, page);
  const brush = new BrushView();
  viewport.scene.add(brush.root);
  viewport.tools.push(brush.root);
  new PaintInput(viewport, brush, studio, page); // before the other, which then sees that it is not meant
  new BoxSelect(viewport, handles, gizmo, studio, page);
  new PointerInput(viewport, handles, gizmo, studio, page);
  const root = new Vector3();
  model.onChange = () => viewport.draw();
  viewport.beforeFrame = (camera) => {
    const { display, bones } = page.now;
    const matched = (page.now.session?.match.length ?? 0) > 0;
    handles.fit(camera, viewport.size.height, display === 'handles', bones && (display === 'handles' || matched || page.now.painting));
    comparison.fit(camera, viewport.size.height, display === 'handles');
  };
  studio.onStance = (stance, ofClip) => {
    const before = root.clone();
    model.take(stance.skin);
    handles.take(stance.handles);
    gizmo.take(stance.turns);
    limits.take(handles, stance.skin);
    comparison.take(stance.variants);
    if (handles.count > 0) handles.position(0, root);
    source.take(stance.source, stance.sourceSkin, root);
    // The camera walks along.
    if (ofClip) viewport.follow(root.x - before.x, root.z - before.z);
    gizmo.place();
    viewport.draw();
  };
  studio.onWeights = (weights) => {
    model.takeWeights(weights, page.now.display, page.now.selected);
    viewport.draw();
  };
  studio.onOpened = () => {
    const box = page.now.session?.box;
    if (box) viewport.frame(box.min, box.max);
  };
  page.watch((now, before) => {
    if (now.session && now.model && now.model !== before.model) model.show(now.model, now.session.joints.length);
    if (now.session && (now.session !== before.session || now.model !== before.model)) {
      handles.show(now.session.joints);
      source.show(now.session);
      limits.show(now.session);
      const { joints, match } = now.session;
      // What follows the motion in the motion's colours, else each part of the body in its own.
      const others = joints.map(({ color }) => (match.length > 0 ? boneColor : partColor(color)));
      handles.colorBones(matchColors(joints.map(({ name }) => name), match, 'target', others));
    }
    limits.root.visible = now.limits && now.display === 'handles';
    source.showModel(now);
    onion.show(now);
    model.hide(now.hiddenParts);
    if (comparison.show(now) && now.session) {
      const { min, max } = now.session.box;
      // Once the measures have their room.
      requestAnimationFrame(() => viewport.frame(min, [max[0] + comparison.reach, max[1], max[2]]));
    }
    const repaint = now.model !== before.model || now.display !== before.display || now.wireframe !== before.wireframe
      || (now.display === 'joint-weights' && now.selected !== before.selected);
    if (repaint) model.setDisplay(now.display, now.selected, now.wireframe);
    const selected = now.selected === null ? [] : [now.selected, ...now.also];
    handles.paint(new Set(selected), now.hovered, new Set(now.session?.targets.map((target) => target.joint)));
    viewport.draw();
  });
  return { viewport, handles, model, comparison, gizmo };
}
