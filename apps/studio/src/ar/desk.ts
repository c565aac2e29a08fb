// What augmented reality takes over from the desk, and gives back.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import type { Stage } from '../scene/stage';

export interface Desk extends Pick<Stage, 'viewport' | 'handles' | 'model' | 'others' | 'places' | 'arrange'> {
  studio: Studio;
  page: PageStore;
  /** The page's own controls: hidden meanwhile. */
  app: HTMLElement;
}
