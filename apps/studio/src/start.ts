// The page's first few lines.
import { startEarly } from './engine/start';

startEarly();
void import('./main');
