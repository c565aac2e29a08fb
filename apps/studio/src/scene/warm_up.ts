// Shaders of what the first frame will show, made while the engine is still at its model: stand-ins of one triangle and one
// handle, of the very materials, never seen. Nobody disposes of them, so three.js keeps what was made.
import type { SurfaceModel } from '../engine/messages';
import { HandleView } from './handle_view';
import { ModelView } from './model_view';
import type { Viewport } from './viewport';

const triangle: SurfaceModel = {
  positions: new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), normals: new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1]), uvs: new Float32Array(),
  triangles: new Uint32Array([0, 1, 2]), weights: new Float32Array([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]), joints: new Uint16Array(12),
  parts: [{ name: '', first: 0, count: 3, material: null }], materials: [], textures: [], deformation: { form: 'weights' },
};

export function warmUp(viewport: Viewport) {
  const model = new ModelView(), handles = new HandleView();
  model.show(triangle, 1);
  model.take(new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
  model.setDisplay('handles', null, false);
  handles.show([{ name: '', parent: -1, part: null, color: [1, 1, 1], radius: 1, rest: [0, 0, 0] }]);
  handles.paint(new Set(), null, new Set());
  viewport.warmUp([model.root, handles.root]);
}
