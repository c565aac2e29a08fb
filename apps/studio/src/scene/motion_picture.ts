// Small pictures of the model as motions move it, drawn one at a time on a canvas of its own and copied to where they are shown.
import { PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import type { MotionPreview, SessionState, SurfaceModel, Vector } from '../engine/messages';
import { studioLights } from './lights';
import { ModelView } from './model_view';

const direction = new Vector3(0.75, 0.28, 1).normalize(); // from where the model is seen
const room = 1.12; // of the picture to the sphere about the model's box: arms are raised
const above = 0.07; // of the box's height by which the camera looks higher: bodies jump

export class MotionPictures {
  /** A texture came: what was drawn is drawn anew. */
  onChange: () => void = () => {};

  private renderer: WebGLRenderer;
  private scene = new Scene();
  private camera = new PerspectiveCamera(28, 1, 0.01, 1000);
  private model = new ModelView();
  private joints = 0;
  private blended = new Float32Array();
  private height = 0; // that the camera looks at, metres
  private reach = 1; // metres from the box's middle to its corner
  private shown: SurfaceModel | null = null;

  constructor() {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.scene.add(...studioLights(), this.model.root);
    this.model.onChange = () => this.onChange();
  }

  show(model: SurfaceModel, joints: number, { min, max }: SessionState['box'], hidden: ReadonlySet<number>) {
    const low = new Vector3(...min), high = new Vector3(...max);
    this.height = (low.y + high.y) / 2 + above * (high.y - low.y);
    this.reach = Math.max(0.5 * low.distanceTo(high), 1e-6);
    if (model !== this.shown) {
      this.model.show(model, joints);
      this.shown = model;
      this.joints = joints;
      this.blended = new Float32Array(16 * joints);
    }
    this.model.hide(hidden);
  }

  /** The surface leaves the graphics card; what was drawn stays in its places. */
  clear() {
    this.model.clear();
    this.shown = null;
  }

  /** The model `seconds` after the motion's begin, again and again; the camera goes along. */
  draw(canvas: HTMLCanvasElement, preview: MotionPreview, seconds: number) {
    const context = canvas.getContext('2d'), middle = this.pose(preview, seconds);
    if (!context || !middle) return;
    const { width, height } = canvas;
    if (this.renderer.domElement.width !== width || this.renderer.domElement.height !== height) this.renderer.setSize(width, height, false);
    const target = new Vector3(middle[0], this.height, middle[2]);
    this.camera.aspect = width / height;
    const distance = (room * this.reach) / Math.tan((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.near = distance / 50;
    this.camera.far = distance * 10;
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.camera.lookAt(target);
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    context.clearRect(0, 0, width, height);
    context.drawImage(this.renderer.domElement, 0, 0);
  }

  /** Between two frames their blend: they are too near each other for it to show. Gives the joints' middle. */
  private pose({ frames, seconds: all }: MotionPreview, seconds: number): Vector | null {
    const at = all > 0 ? ((seconds % all) / all) * frames.length : 0, first = Math.floor(at) % frames.length;
    const from = frames[first], next = first + 1 < frames.length ? frames[first + 1] : null;
    if (!from || from.skin.length !== 16 * this.joints) return null;
    // The last frame is held: where the motion begins again is elsewhere, if it goes anywhere.
    const to = next ?? from, share = at - Math.floor(at);
    for (let i = 0; i < this.blended.length; ++i) this.blended[i] = from.skin[i]! + share * (to.skin[i]! - from.skin[i]!);
    this.model.take(this.blended);
    return [0, 1, 2].map((axis) => from.middle[axis]! + share * (to.middle[axis]! - from.middle[axis]!)) as Vector;
  }
}
