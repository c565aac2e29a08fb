// The rear camera, looked through by the page itself.
import { MathUtils } from 'three';
import { element } from '../ui/dom';

/** Degrees along the longer side of the picture: a phone's main camera, of 26 mm on 35 mm film, has 67; steadying the
 *  picture takes some. No browser tells it. */
const longSide = 65;

export interface RearCamera {
  readonly video: HTMLVideoElement;
  /** Asks for it, in pixels of the longer and the shorter side where that can be had; throws what `getUserMedia` throws. */
  open(long: number, short: number): Promise<void>;
  close(): void;
}

export function rearCamera(): RearCamera {
  const video = element('video', { playsinline: true, muted: true, autoplay: true, 'aria-hidden': 'true' });
  video.muted = true; // the attribute alone does not count for what is made by a script
  /** Phones stop the picture of a page that is hidden. */
  const goOn = () => { if (document.visibilityState === 'visible') void video.play().catch(() => {}); };
  let stream: MediaStream | null = null;
  return {
    video,
    async open(long, short) {
      // Without a secure context there is no mediaDevices.
      if (!navigator.mediaDevices) throw new DOMException('no camera without a secure context', 'NotFoundError');
      stream = await navigator.mediaDevices.getUserMedia({
        audio: false, video: { facingMode: { ideal: 'environment' }, width: { ideal: long }, height: { ideal: short } },
      });
      video.srcObject = stream;
      document.addEventListener('visibilitychange', goOn);
      await video.play();
    },
    close() {
      document.removeEventListener('visibilitychange', goOn);
      stream?.getTracks().forEach((track) => track.stop());
      stream = video.srcObject = null;
    },
  };
}

/** Degrees from the lower to the upper edge of its picture, as far as can be guessed. */
export function guessedFieldOfView({ videoWidth: width, videoHeight: height }: HTMLVideoElement): number {
  const half = Math.tan(MathUtils.degToRad(longSide / 2));
  return 2 * MathUtils.radToDeg(Math.atan(height >= width ? half : (half * height) / width));
}
