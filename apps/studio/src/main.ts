// Puts the page together.
import './style.css';
import { bindShortcuts } from './app/shortcuts';
import { createPageStore } from './app/state';
import { Studio } from './app/studio';
import { exposeStage } from './app/probe';
import { help } from './panels/help';
import { outliner } from './panels/outliner';
import { posePanel } from './panels/pose_panel';
import { facts, status } from './panels/status';
import { samples, toolbar } from './panels/toolbar';
import { createStage } from './scene/stage';
import { element } from './ui/dom';

const page = createPageStore();
const studio = new Studio(page);
const { viewport, handles } = createStage(studio, page);

const app = document.getElementById('app')!;
app.append(
  toolbar(studio, page, viewport),
  element('main', { class: 'stage' }, viewport.canvas, facts(page)),
  element('aside', { class: 'side' }, posePanel(studio, page), outliner(studio, page, handles)),
  status(studio, page), help(page));
bindShortcuts(studio, page, viewport, handles);

// A model can be dropped anywhere.
addEventListener('dragover', (event) => {
  event.preventDefault();
  document.body.classList.add('dropping');
});
addEventListener('dragleave', (event) => {
  if (!event.relatedTarget) document.body.classList.remove('dropping');
});
addEventListener('drop', (event) => {
  event.preventDefault();
  document.body.classList.remove('dropping');
  const file = event.dataTransfer?.files[0];
  if (file) void studio.openFile(file);
});

exposeStage(studio, page, viewport, handles);

// ?model=address or ?sample=name; else the first sample, so that there is something to take hold of.
const parameters = new URLSearchParams(location.search);
const address = parameters.get('model');
if (address) void studio.openAddress(address);
else void studio.openSample(parameters.get('sample') ?? samples[0][0]);
