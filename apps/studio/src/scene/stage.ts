// The scene shows what the page's state says.
import { Box3, Matrix4, Vector3 } from 'three';
import { hasHandles, type PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { ComparisonView } from './comparison_view';
import { Gizmo } from './gizmo';
import { HandleView } from './handle_view';
import { LimitView } from './limit_view';
import { ModelView } from './model_view';
import { OnionView } from './onion_view';
import { OthersView } from './others_view';
import { boneColor, partColor } from './palette';
import { BoxSelect } from './box_select';
import { BrushView } from './brush_view';
import { PaintInput } from './paint_input';
import { PlaceInput } from './place_input';
import { Places } from './places';
import { PointerInput } from './pointer';
import { matchColors, SourceView } from './source_view';
import { Viewport } from './viewport';

export interface Stage {
  viewport: Viewport;
  handles: HandleView;
  model: ModelView;
  comparison: ComparisonView;
  gizmo: Gizmo;
  others: OthersView;
  places: Places;
  /** What is drawn goes to where the members stand. */
  arrange: () => void;
}

export function createStage(studio: Studio, page: PageStore): Stage {
  const viewport = new Viewport(), model = new ModelView(), handles = new HandleView();
  const source = new SourceView(), limits = new LimitView(), onion = new OnionView(model);
  const comparison = new ComparisonView(viewport.scene, () => viewport.draw());
  viewport.tools.push(handles.root, source.root, limits.root, onion.root);
  viewport.scene.add(handles.root, model.root, source.root, source.model.root, limits.root, onion.root);
  source.model.onChange = () => viewport.draw();
  const places = new Places(), others = new OthersView(() => viewport.draw());
  viewport.world.add(others.root);
  const stand = () => {
    viewport.stand(places.of(page.now.session?.member ?? 0));
    others.stand(places);
  };
  /** Anew where somebody was placed. */
  let shaded = '';
  const shade = () => {
    if (page.now.playing) return;
    const members = page.now.session?.members ?? [], boxes = members.map((_, member) => places.box(member, members));
    const key = JSON.stringify([boxes, members.map(({ name }) => name)]);
    if (key !== shaded) viewport.shade(boxes);
    shaded = key;
  };
  const gizmo = new Gizmo(viewport, handles, studio, page);
  const brush = new BrushView();
  viewport.scene.add(brush.root);
  viewport.tools.push(brush.root);
  const arrange = () => {
    stand();
    shade();
  };
  new PlaceInput(viewport, places, arrange, studio, page); // before the others, which then see that they are not meant
  new PaintInput(viewport, brush, studio, page);
  new BoxSelect(viewport, handles, gizmo, studio, page);
  new PointerInput(viewport, handles, gizmo, studio, page);
  const root = new Vector3(), rootSkin = new Matrix4();
  /** From where its root is bound, in the world. */
  const walked = (member: number) => {
    const now = handles.position(0, new Vector3()), bound = now.clone().applyMatrix4(rootSkin.clone().invert()), place = places.of(member);
    return now.applyMatrix4(place).sub(bound.applyMatrix4(place));
  };
  model.onChange = () => viewport.draw();
  viewport.beforeFrame = (camera) => {
    const { display, bones } = page.now;
    const matched = (page.now.session?.match.length ?? 0) > 0;
    handles.fit(camera, viewport.size.height, hasHandles(display), bones && (hasHandles(display) || matched || page.now.painting));
    comparison.fit(camera, viewport.size.height, hasHandles(display));
  };
  studio.onStance = (stance, ofClip) => {
    const before = root.clone(), member = page.now.session?.member ?? 0;
    places.take(stance.places);
    stand();
    shade();
    others.take(stance.others);
    model.take(stance.skin, stance.posed);
    rootSkin.fromArray(stance.skin);
    handles.take(stance.handles);
    gizmo.take(stance.turns);
    limits.take(handles, stance.skin);
    comparison.take(stance.variants);
    if (handles.count > 0) handles.position(0, root);
    source.take(stance.source, stance.sourceSkin, root);
    root.applyMatrix4(places.of(member));
    // The camera walks along.
    if (ofClip) viewport.follow(root.x - before.x, root.z - before.z, member);
    gizmo.place();
    viewport.draw();
  };
  studio.onWeights = (weights) => {
    model.takeWeights(weights, page.now.display, page.now.selected);
    viewport.draw();
  };
  studio.onOpened = () => {
    const { session } = page.now;
    if (session) viewport.frame(places.boxOfAll(session.members));
    shaded = '';
    shade();
    if (session?.clip == null || session.members.length > 1) return;
    const { x, z } = walked(session.member);
    viewport.follow(x, z, session.member);
    viewport.draw();
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
    limits.root.visible = now.limits && hasHandles(now.display);
    source.showModel(now);
    onion.show(now);
    if (now.others !== before.others || now.wireframe !== before.wireframe) others.show(now.others, now.wireframe);
    others.root.visible = now.comparison === null; // the figures stand there
    model.hide(now.hiddenParts);
    if (comparison.show(now) && now.session) {
      const { min, max } = now.session.box, box = new Box3(new Vector3(...min), new Vector3(...max));
      box.max.x += comparison.reach;
      // Once the measures have their room.
      requestAnimationFrame(() => viewport.frame(box.applyMatrix4(places.of(now.session!.member))));
    }
    const repaint = now.model !== before.model || now.display !== before.display || now.wireframe !== before.wireframe
      || (now.display === 'joint-weights' && now.selected !== before.selected)
      || (now.display === 'parts' && now.parts !== before.parts);
    if (repaint) model.setDisplay(now.display, now.selected, now.wireframe, now.parts);
    const selected = now.selected === null ? [] : [now.selected, ...now.also];
    handles.paint(new Set(selected), now.hovered, new Set(now.pinned), new Set(now.session?.doubts));
    viewport.draw();
  });
  return { viewport, handles, model, comparison, gizmo, others, places, arrange };
}
