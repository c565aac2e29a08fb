// The canvas: camera, light, ground, and frames drawn only when something has changed.
import {
  Box3, type Camera, CanvasTexture, Color, DirectionalLight, Group, LineSegments, BufferGeometry, Float32BufferAttribute,
  LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, type Object3D, OrthographicCamera, PerspectiveCamera, PlaneGeometry, Raycaster, Scene, Spherical,
  Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Ray, Vector } from '../engine/messages';
import { element } from '../ui/dom';
import { say } from '../words/say';
import { studioLights } from './lights';

export type ViewName = 'front' | 'right' | 'top' | 'start';

const viewDirections: Record<ViewName, Vector> = {
  front: [0, 0, 1], right: [1, 0, 0], top: [0, 1, 0.0001], start: [0.55, 0.3, 1],
};

const fitMargin = 0.055; // of the view, beside a model that fills it

/** Towards a point of the world that the camera is in, wherever that is: three takes the point to be of the drawn scene. */
function looksWithinItsWorld(camera: Camera) {
  camera.lookAt = (target: Vector3 | number) => {
    if (target instanceof Vector3) camera.quaternion.setFromRotationMatrix(new Matrix4().lookAt(camera.position, target, camera.up));
  };
}

interface Guest {
  eye: PerspectiveCamera;
  /** Of what is looked through, in pixels of the page. */
  size: () => { width: number; height: number };
}

export class Viewport {
  readonly canvas: HTMLCanvasElement;
  /** In the chosen model's own space, as the engine speaks of it; so whatever is drawn of it needs no place. */
  readonly scene = new Scene();
  /** Where the models of a scene stand, the light and the camera: it is moved round the chosen one. */
  readonly world = new Group();
  readonly lights = new Group();
  readonly controls: OrbitControls;
  beforeFrame: (camera: PerspectiveCamera | OrthographicCamera) => void = () => {};
  /** Pixels at the upper edge that tools lie on. */
  coveredAbove: () => number = () => 0;
  readonly renderer: WebGLRenderer;

  private perspective = new PerspectiveCamera(32, 1, 0.01, 1000);
  private orthographic = new OrthographicCamera(-1, 1, 1, -1, 0.01, 1000);
  private current: PerspectiveCamera | OrthographicCamera = this.perspective;
  private ground = new Group();
  private shadows: Mesh[] = [];
  private shadowImage: CanvasTexture | null = null;
  private box = new Box3(new Vector3(-1, 0, -1), new Vector3(1, 2, 1));
  private asked = false;
  private framed = false; // before there is anything to look at nothing is drawn
  private step = 1; // metres between the ground's lines
  /** The eye of augmented reality, while it has the view. */
  private guest: Guest | null = null;

  constructor() {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: false });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'application');
    this.canvas.setAttribute('aria-label', say('The model. The list of joints does everything that is done here by pointer.'));
    this.world.matrixAutoUpdate = false;
    for (const light of studioLights()) this.lights.add(light, ...(light instanceof DirectionalLight ? [light.target] : []));
    for (const camera of [this.perspective, this.orthographic]) looksWithinItsWorld(camera);
    this.world.add(this.lights, this.ground, this.perspective, this.orthographic);
    this.scene.add(this.world);
    this.controls = new OrbitControls(this.perspective, this.canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  get camera() { return this.guest?.eye ?? this.current; }
  get size() { return this.guest?.size() ?? { width: this.canvas.clientWidth, height: this.canvas.clientHeight }; }

  /** Another eye has the view, and draws its own frames (drawNow), until what this gives is called: the desk's camera is
   *  as it was then. */
  lend(guest: Guest): () => void {
    this.guest = guest;
    this.ground.visible = this.controls.enabled = false;
    return () => {
      this.guest = null;
      this.ground.visible = this.controls.enabled = true;
      this.resize();
      this.draw();
    };
  }

  /** Draws with the next frame. */
  draw() {
    if (this.asked || this.guest || !this.framed) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (!this.guest) this.drawNow();
    });
  }

  /** Has the shaders of these things, the ground and a shadow made for this light. */
  warmUp(things: Object3D[]) {
    this.makeGround();
    this.shadows.push(this.makeShadow());
    const all = new Group().add(...things, this.ground.children[0]!.clone(), this.shadows[0]!.clone());
    this.renderer.compileAsync(all, this.camera, this.scene).catch(() => { /* then they are made with the first frame */ });
  }

  ray(x: number, y: number): { ray: Ray; view: Vector } {
    const { width, height } = this.size;
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((x / width) * 2 - 1, 1 - (y / height) * 2), this.camera);
    const view = this.camera.getWorldDirection(new Vector3());
    return {
      ray: { origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() },
      view: view.toArray(),
    };
  }

  /** The camera's right and up, for moves by keyboard. */
  axes(): { right: Vector3; up: Vector3 } {
    const elements = this.camera.matrixWorld.elements;
    return { right: new Vector3().fromArray(elements, 0).normalize(), up: new Vector3().fromArray(elements, 4).normalize() };
  }

  /** Where the camera is, in the chosen model's own space. */
  eye(): Vector { return this.camera.getWorldPosition(new Vector3()).toArray(); }

  /** The plane of the ground there: its normal, and how far it is from the origin along it. */
  floor(): { normal: Vector; distance: number } {
    this.ground.updateWorldMatrix(true, false);
    const normal = new Vector3().setFromMatrixColumn(this.ground.matrixWorld, 1).normalize();
    return { normal: normal.toArray(), distance: normal.dot(new Vector3().setFromMatrixPosition(this.ground.matrixWorld)) };
  }

  /** The chosen model's own space in the world. */
  stand(place: Matrix4) {
    this.world.matrix.copy(place).invert();
    this.world.updateMatrixWorld(true);
    this.draw();
  }

  /** Takes in a box of the world. */
  frame(box: Box3) {
    this.framed = true;
    this.box.copy(box);
    this.makeGround();
    this.look('start');
  }

  /** A soft shadow below each of these boxes of the world: on the ground or, in a real place, where the model stands. */
  shade(boxes: Box3[]) {
    this.shadows.splice(boxes.length).forEach((shadow) => {
      shadow.geometry.dispose();
      shadow.removeFromParent();
    });
    boxes.forEach((box, i) => {
      const shadow = this.shadows[i] ??= this.makeShadow();
      this.world.add(shadow);
      const size = box.getSize(new Vector3());
      box.getCenter(shadow.position).setY(this.guest ? box.min.y : this.box.min.y);
      shadow.scale.set(1.5 * size.x + 0.3 * size.y, 1.5 * size.z + 0.3 * size.y, 1);
    });
  }

  look(view: ViewName) {
    const direction = new Vector3(...viewDirections[view]).normalize(), { center, distance } = this.fitting(direction);
    for (const camera of [this.perspective, this.orthographic]) {
      camera.position.copy(center).addScaledVector(direction, distance);
      camera.near = distance / 200;
      camera.far = distance * 40;
      camera.zoom = 1;
    }
    this.controls.target.copy(center);
    this.resize();
    this.controls.update();
    this.draw();
  }

  /** Back to where the model fills the view, from the side that is looked from now. */
  frameAgain() {
    const offset = this.current.position.clone().sub(this.controls.target).normalize(), { center, distance } = this.fitting(offset);
    this.current.position.copy(center).addScaledVector(offset, distance);
    this.controls.target.copy(center);
    this.controls.update();
    this.draw();
  }

  /** Round the point that is looked at, in degrees: to the right and up. */
  orbit(right: number, up: number) {
    const offset = new Spherical().setFromVector3(this.current.position.clone().sub(this.controls.target));
    offset.theta += (right * Math.PI) / 180;
    offset.phi = Math.min(Math.PI - 0.01, Math.max(0.01, offset.phi - (up * Math.PI) / 180));
    this.current.position.setFromSpherical(offset).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  /** Nearer, above 1, or further away. */
  zoom(times: number) {
    const { target } = this.controls;
    this.current.position.sub(target).divideScalar(times).add(target);
    this.resize();
    this.controls.update();
    this.draw();
  }

  /** Goes along with a member that walks; the ground stays under it, its lines in their places. */
  follow(x: number, z: number, member: number) {
    this.shadows[member]?.position.add(new Vector3(x, 0, z));
    this.box.translate(new Vector3(x, 0, z));
    for (const camera of [this.perspective, this.orthographic]) {
      camera.position.x += x;
      camera.position.z += z;
    }
    this.controls.target.x += x;
    this.controls.target.z += z;
    const { x: atX, z: atZ } = this.controls.target;
    this.ground.position.x = Math.round(atX / this.step) * this.step;
    this.ground.position.z = Math.round(atZ / this.step) * this.step;
    this.controls.update();
  }

  /** Towards where and from how far, in that direction, all of the box is seen below the tools, with a little room round it. */
  private fitting(direction: Vector3): { center: Vector3; distance: number } {
    const { width, height } = this.size, above = Math.min(0.4, Math.max(fitMargin, this.coveredAbove() / Math.max(1, height)));
    const halfHeight = Math.tan((this.perspective.fov * Math.PI) / 360);
    const up = halfHeight * (1 - above - fitMargin), across = (halfHeight * (1 - 2 * fitMargin) * width) / Math.max(1, height);
    const side = new Vector3(0, 1, 0).cross(direction).normalize(), top = direction.clone().cross(side);
    const half = this.box.getSize(new Vector3()).multiplyScalar(0.5);
    let distance = 1e-6;
    for (let corner = 0; corner < 8; ++corner) {
      const at = half.clone().multiply(new Vector3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
      const needed = Math.max(Math.abs(at.dot(side)) / across, Math.abs(at.dot(top)) / up);
      distance = Math.max(distance, at.dot(direction) + needed);
    }
    return { center: this.box.getCenter(new Vector3()).addScaledVector(top, (above - fitMargin) * halfHeight * distance), distance };
  }

  toggleOrthographic() {
    const from = this.current;
    this.current = from === this.perspective ? this.orthographic : this.perspective;
    this.current.position.copy(from.position);
    this.current.quaternion.copy(from.quaternion);
    this.controls.object = this.current;
    this.resize();
    this.controls.update();
    this.draw();
  }

  /** Handles, bones and arrows: on the page, but not in pictures that leave it. */
  readonly tools: Object3D[] = [];

  /** The model and its shadow on a colour or on nothing: without tools, without the ground's lines. */
  async picture(background: string | null = null): Promise<Blob | null> { return this.withoutTools(() => this.pictureNow(background)); }

  /** As many pictures as are drawn, each when its turn comes. */
  async pictures(background: string | null, each: (draw: () => Promise<void>) => Promise<void>): Promise<Blob[]> {
    const made: Blob[] = [];
    await this.withoutTools(() => each(async () => {
      const picture = await this.pictureNow(background);
      if (picture) made.push(picture);
    }));
    return made;
  }

  private pictureNow(background: string | null): Promise<Blob | null> {
    this.drawNow();
    const screen = background === null ? this.canvas : element('canvas', { width: this.canvas.width, height: this.canvas.height });
    if (background !== null) this.drawOn(screen, background);
    return new Promise((resolve) => screen.toBlob(resolve, 'image/png'));
  }

  private drawOn(screen: HTMLCanvasElement, background: string) {
    const context = screen.getContext('2d')!;
    context.fillStyle = background;
    context.fillRect(0, 0, screen.width, screen.height);
    context.drawImage(this.canvas, 0, 0);
  }

  async withoutTools<T>(act: () => Promise<T>): Promise<T> {
    const hidden = [...this.tools, ...this.ground.children.filter((part) => part instanceof LineSegments)].filter(({ visible }) => visible);
    const seen = (visible: boolean) => hidden.forEach((part) => { part.visible = visible; });
    seen(false);
    try {
      return await act();
    } finally {
      seen(true);
      this.draw();
    }
  }

  /** A film of pictures, each drawn when its turn comes: WebM, as many a second as `rate`. */
  async film(rate: number, background: string, each: (draw: () => Promise<void>) => Promise<void>): Promise<Blob> {
    const screen = element('canvas', { width: this.canvas.width & ~1, height: this.canvas.height & ~1 });
    screen.getContext('2d'); // before there is one, nothing can be captured
    const stream = screen.captureStream(0), [track] = stream.getVideoTracks() as CanvasCaptureMediaStreamTrack[];
    const recorder = new MediaRecorder(stream, { mimeType: 'video/webm', videoBitsPerSecond: 8e6 }), parts: Blob[] = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    const stopped = new Promise((resolve) => { recorder.onstop = resolve; });
    recorder.start();
    let next = performance.now();
    await this.withoutTools(() => each(async () => {
      this.drawNow();
      this.drawOn(screen, background);
      (track && 'requestFrame' in track ? track : stream as unknown as CanvasCaptureMediaStreamTrack).requestFrame(); // Firefox has it there
      next += 1000 / rate;
      await new Promise((resolve) => setTimeout(resolve, Math.max(0, next - performance.now())));
    }));
    recorder.stop();
    await stopped;
    return new Blob(parts, { type: 'video/webm' });
  }

  /** A film of the model from all around; the view is as it was then. */
  async turn(rate: number, seconds: number, background: string): Promise<Blob> {
    const before = this.current.position.clone(), count = Math.round(rate * seconds);
    try {
      return await this.film(rate, background, async (draw) => {
        for (let i = 0; i < count; ++i) {
          await draw();
          this.orbit(360 / count, 0);
        }
      });
    } finally {
      this.current.position.copy(before);
      this.controls.update();
    }
  }

  /** The picture as it is now, cut to the shape of the place that it goes to. */
  drawInto(context: CanvasRenderingContext2D, x: number, y: number, width: number, height: number) {
    this.drawNow();
    const { width: w, height: h } = this.canvas;
    const scale = Math.min(w / width, h / height);
    const [cutW, cutH] = [width * scale, height * scale];
    context.drawImage(this.canvas, (w - cutW) / 2, (h - cutH) / 2, cutW, cutH, x, y, width, height);
  }

  drawNow() {
    this.world.updateMatrixWorld(true);
    this.beforeFrame(this.camera);
    this.renderer.render(this.scene, this.camera);
  }

  private resize() {
    const { width, height } = this.size;
    if (this.guest || width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    // As large as the perspective shows the point that the camera turns about.
    const distance = this.orthographic.position.distanceTo(this.controls.target);
    const half = distance * Math.tan((this.perspective.fov * Math.PI) / 360);
    this.orthographic.top = half;
    this.orthographic.bottom = -half;
    this.orthographic.left = (-half * width) / height;
    this.orthographic.right = (half * width) / height;
    this.orthographic.updateProjectionMatrix();
    this.draw();
  }

  /** A grid under the models with its axes in their colours. */
  private makeGround() {
    this.ground.clear();
    const size = this.box.getSize(new Vector3()), center = this.box.getCenter(new Vector3());
    const step = 10 ** Math.floor(Math.log10(Math.max(size.x, size.y, size.z, 1e-6) / 2));
    this.step = step;
    const count = Math.ceil((1.5 * Math.max(size.x, size.z, size.y / 2)) / step);
    const lines: number[] = [], colors: number[] = [];
    const grid = new Color('#c9ced6'), xAxis = new Color('#d9534f'), zAxis = new Color('#4a7bd0');
    for (let i = -count; i <= count; ++i) {
      lines.push(i * step, 0, -count * step, i * step, 0, count * step, -count * step, 0, i * step, count * step, 0, i * step);
      for (const color of i === 0 ? [zAxis, zAxis, xAxis, xAxis] : [grid, grid, grid, grid]) colors.push(color.r, color.g, color.b);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(lines, 3));
    geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
    const material = new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.7, depthWrite: false });
    this.ground.add(new LineSegments(geometry, material));
    this.ground.position.set(Math.round(center.x / step) * step, this.box.min.y, Math.round(center.z / step) * step);
  }

  /** Of a size of one. */
  private makeShadow(): Mesh {
    const material = new MeshBasicMaterial({ map: this.shadowImage ??= drawShadow(), transparent: true, depthWrite: false });
    const shadow = new Mesh(new PlaneGeometry(1, 1), material);
    shadow.rotation.x = -Math.PI / 2;
    shadow.renderOrder = -2;
    return shadow;
  }
}

function drawShadow(): CanvasTexture {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 128;
  const context = canvas.getContext('2d', { willReadFrequently: true }); // one by the graphics chip is fetched back, and long in the making
  if (context) {
    const fade = context.createRadialGradient(64, 64, 0, 64, 64, 64);
    fade.addColorStop(0, 'rgba(40,45,60,0.42)');
    fade.addColorStop(0.45, 'rgba(40,45,60,0.16)');
    fade.addColorStop(1, 'rgba(40,45,60,0)');
    context.fillStyle = fade;
    context.fillRect(0, 0, 128, 128);
  }
  return new CanvasTexture(canvas);
}
