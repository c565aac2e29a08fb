// The light in which models are shown.
import { AmbientLight, DirectionalLight, HemisphereLight, type Light } from 'three';

const farAway = 1e5; // metres: only where a light is from counts, also in a world that is moved

export function studioLights(): Light[] {
  const sky = new HemisphereLight(0xffffff, 0xb8b2aa, 1.25);
  sky.position.set(0, farAway, 0);
  const key = new DirectionalLight(0xffffff, 2.0);
  key.position.set(0.6, 1, 0.9);
  const rim = new DirectionalLight(0xe8efff, 0.7);
  rim.position.set(-0.8, 0.5, -1);
  return [sky, new AmbientLight(0xffffff, 0.25), key, rim];
}
