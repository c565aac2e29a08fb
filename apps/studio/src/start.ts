// The page's first few lines.
import { likelyFirst } from './app/beginning';
import { startEarly } from './engine/start';

startEarly(likelyFirst());
void import('./main');
