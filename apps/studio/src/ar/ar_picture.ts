// A picture of the models in the real place: on what the camera sees, or on a colour.
import { Mesh, OrthographicCamera, PlaneGeometry, ShaderMaterial, Texture, Vector4, type WebGLRenderer } from 'three';
import { element } from '../ui/dom';
import type { ArView } from './ar_view';

export const plainBackground = '#dfe6ee';

/** Within a frame. Null where the browser keeps what the camera sees to itself, and no other background is given. */
export function takePicture(view: ArView, background: string | null): HTMLCanvasElement | null {
  const { renderer, desk: { viewport } } = view, seen = background === null ? view.sight.seen() : null;
  if (!seen && background === null) return null;
  const { width, height } = renderer.domElement, screen = element('canvas', { width, height }), context = screen.getContext('2d')!;
  const { xr } = renderer, target = renderer.getRenderTarget(), inXr = xr.enabled;
  const whole = renderer.getViewport(new Vector4()), ratio = renderer.getPixelRatio();
  xr.enabled = false; // into the canvas, not into the device's frame
  renderer.setRenderTarget(null);
  renderer.setViewport(0, 0, width / ratio, height / ratio); // the device's frame can have another size
  void viewport.withoutTools(async () => {
    if (seen instanceof Texture) drawCamera(renderer, seen);
    else if (seen) drawVideo(context, seen);
    else if (background !== null) {
      context.fillStyle = background;
      context.fillRect(0, 0, width, height);
    }
    renderer.autoClear = !(seen instanceof Texture);
    viewport.drawNow();
    renderer.autoClear = true;
    context.drawImage(renderer.domElement, 0, 0);
  });
  renderer.setViewport(whole);
  renderer.setRenderTarget(target);
  xr.enabled = inXr;
  return screen;
}

/** The browser gives it as it is to be seen: without a change of colour. */
function drawCamera(renderer: WebGLRenderer, picture: Texture) {
  const material = new ShaderMaterial({
    uniforms: { picture: { value: picture } }, depthTest: false, depthWrite: false,
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 1.0, 1.0); }',
    fragmentShader: 'uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = vec4(texture2D(picture, at).rgb, 1.0); }',
  });
  const sheet = new Mesh(new PlaneGeometry(2, 2), material);
  sheet.frustumCulled = false;
  renderer.render(sheet, new OrthographicCamera());
  sheet.geometry.dispose();
  material.dispose();
}

/** As it fills the screen. */
function drawVideo(context: CanvasRenderingContext2D, video: HTMLVideoElement) {
  const { width, height } = context.canvas, scale = Math.max(width / video.videoWidth, height / video.videoHeight);
  const w = video.videoWidth * scale, h = video.videoHeight * scale;
  context.drawImage(video, (width - w) / 2, (height - h) / 2, w, h);
}
