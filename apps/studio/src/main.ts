// Puts the page together.
import './style.css';
import { bindShortcuts } from './app/shortcuts';
import { createPageStore } from './app/state';
import { Studio } from './app/studio';
import { keepSession, keptSession } from './app/keep';
import { bindPlayer } from './app/player';
import { exposeStage } from './app/probe';
import { comparisonPanel } from './panels/comparison_panel';
import { contactSheet } from './panels/contact_sheet';
import { help } from './panels/help';
import { methodsPanel } from './panels/methods_panel';
import { outliner } from './panels/outliner';
import { posePanel } from './panels/pose_panel';
import { retargetPanel } from './panels/retarget_panel';
import { facts, status } from './panels/status';
import { timeline } from './panels/timeline';
import { samples, toolbar } from './panels/toolbar';
import { createStage } from './scene/stage';
import { element } from './ui/dom';

const page = createPageStore();
const studio = new Studio(page);
const { viewport, handles, model, comparison, gizmo } = createStage(studio, page);
const sheet = contactSheet(studio, page, viewport);

const app = document.getElementById('app')!;
app.append(
  toolbar(studio, page, viewport, model),
  element('main', { class: 'stage' }, viewport.canvas, facts(page), comparisonPanel(studio, page, comparison)),
  element('aside', { class: 'side' }, posePanel(studio, page), retargetPanel(studio, page), methodsPanel(studio, page), outliner(studio, page, handles)),
  timeline(studio, page, sheet.open),
  status(studio, page), help(page), sheet.dialog);
bindShortcuts(studio, page, viewport, handles);
bindPlayer(studio, page);
const kept = keepSession(studio, page);

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

exposeStage(studio, page, viewport, handles, gizmo, kept);

// ?model=address or ?sample=name; else what was worked on last, or the first sample, so that there is something to take
// hold of.
const parameters = new URLSearchParams(location.search);
const address = parameters.get('model');
const sample = parameters.get('sample');
async function begin() {
  void studio.loadMethods();
  if (address) return studio.openAddress(address);
  const kept = sample === null ? await keptSession() : null;
  if (kept) await studio.openKept(kept.bytes, kept.name);
  if (!page.now.session) await studio.openSample(sample ?? samples[0][0]);
}
void begin();
