// Puts the page together.
import './style.css';
import { asked, documentBefore, firstSample } from './app/beginning';
import { bindShortcuts } from './app/shortcuts';
import { Journal } from './app/journal';
import { createPageStore } from './app/state';
import { createStudio } from './app/studio';
import { droppedFiles } from './app/files';
import { PoseShelf } from './app/pose_shelf';
import { PoseStore } from './app/pose_store';
import { bindJournal } from './app/keep';
import { bindPlayer } from './app/player';
import { exposeStage } from './app/probe';
import { comparisonPanel } from './panels/comparison_panel';
import { arButton, arMenu } from './panels/ar_button';
import type { ContactSheet } from './panels/contact_sheet';
import { doubts } from './panels/doubts';
import { methodsPanel } from './panels/methods_panel';
import { outliner } from './panels/outliner';
import { paintPanel } from './panels/paint_panel';
import { posePanel } from './panels/pose_panel';
import { poseTools } from './panels/pose_tools';
import { scenePanel } from './panels/scene_panel';
import { retargetPanel } from './panels/retarget_panel';
import { facts, status } from './panels/status';
import { timeline } from './panels/timeline';
import { scenes } from './app/samples';
import { setTextSize, textSize } from './app/text_size';
import { toolbar } from './panels/toolbar';
import { hint, views } from './panels/views';
import { createStage } from './scene/stage';
import { warmUp } from './scene/warm_up';
import { ask } from './ui/ask';
import { element } from './ui/dom';
import { arriving, loadedWhenOpened } from './ui/loaded_when_opened';
import { language, say } from './words/say';

/** Without WebGL there is nothing to show the model with. */
function stageOrApology() {
  try {
    return createStage(studio, page);
  } catch (error) {
    document.getElementById('app')!.append(element('div', { class: 'apology', role: 'alert', id: 'apology' },
      element('h1', {}, say('This browser cannot draw in 3D')),
      element('p', {}, say('WebGL is missing or switched off. Switch it on (often called hardware acceleration), or use another browser.'))));
    throw error;
  }
}

document.documentElement.lang = language;
setTextSize(textSize());
document.querySelector('meta[name=description]')!.setAttribute('content', say('Rig and pose any 3D model, in the browser. Nothing is uploaded.'));
const page = createPageStore();
const journal = new Journal();
const studio = createStudio(page, journal);
studio.ask = ask;
studio.onCrowd = async (crowd, name) => {
  const { showCrowd } = await arriving(import('./panels/crowd_dialog'));
  showCrowd(crowd, name, app);
};
const poses = new PoseShelf(studio, page, new PoseStore());
const stage = stageOrApology();
const { viewport, handles, comparison, gizmo, places } = stage;
const clips = timeline(studio, page, openSheet);
let sheet: ContactSheet | null = null;

const app = document.getElementById('app')!, toasts = status(studio, page);
const desk = { ...stage, studio, page, app };
app.replaceChildren(
  toolbar(studio, page, journal, viewport, arMenu(desk)),
  element('main', { class: 'stage' }, viewport.canvas, facts(page), hint(page, viewport), poseTools(page), views(viewport), arButton(desk), comparisonPanel(studio, page, comparison)),
  element('aside', { class: 'side' }, scenePanel(studio, page, places), doubts(studio, page), posePanel(studio, page, poses, viewport), paintPanel(studio, page), retargetPanel(studio, page), methodsPanel(studio, page), outliner(studio, page, handles)),
  clips,
  toasts);
loadedWhenOpened(studio, page, 'help', async () => {
  const { help } = await import('./panels/help');
  return () => help(page);
}, app);
loadedWhenOpened(studio, page, 'keyEditor', async () => {
  const { keyEditor } = await import('./panels/key_editor');
  return () => keyEditor(studio, page);
}, clips);
loadedWhenOpened(studio, page, 'feet', async () => {
  const { feetEditor } = await import('./panels/feet_editor');
  return () => feetEditor(studio, page);
}, clips);
loadedWhenOpened(studio, page, 'sequence', async () => {
  const { sequenceEditor } = await import('./panels/sequence_editor');
  return () => sequenceEditor(studio, page);
}, clips);
loadedWhenOpened(studio, page, 'shelf', async () => {
  const { motionShelf } = await import('./panels/motion_shelf');
  return () => motionShelf(studio, page);
}, app);
loadedWhenOpened(studio, page, 'poseLibrary', async () => {
  const { poseLibrary } = await import('./panels/pose_library');
  return () => poseLibrary(studio, page, poses);
}, app);
/** Loaded when it is first opened. */
async function openSheet() {
  await studio.guard(async () => {
    if (!sheet) {
      const { contactSheet } = await arriving(import('./panels/contact_sheet'));
      sheet = contactSheet(studio, page, viewport);
      app.append(sheet.dialog);
    }
    await sheet.open();
  });
}
if (asked.live) void import('./panels/live_panel').then(({ livePanel }) => viewport.canvas.after(livePanel(studio)));
bindShortcuts(studio, page, viewport, handles, poses);
bindPlayer(studio, page);
bindJournal(journal, studio, page, viewport);

// A model can be dropped anywhere; with Shift it comes beside those that are there.
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
  if (event.dataTransfer) void droppedFiles(event.dataTransfer).then((files) => (event.shiftKey ? studio.addFiles(files, false) : studio.openFiles(files)));
});

exposeStage(studio, page, viewport, handles, gizmo, places, () => journal.settled);

async function begin() {
  const { address, scene, sample } = asked, before = documentBefore === null ? undefined : (await journal.list()).find(({ id }) => id === documentBefore);
  if (before) await studio.openKept(before);
  if (page.now.session) return;
  if (address !== null) return studio.openAddress(address);
  if (scene !== null) await studio.openScene(scene, say(scenes.find(([name]) => name === scene)?.[1] ?? 'Scene'));
  const [kept] = sample === null && scene === null ? await journal.list() : [];
  if (kept) await studio.openKept(kept);
  if (!page.now.session) await studio.openSample(firstSample);
}

/** All that is done is written down. */
async function kept() {
  journal.flush();
  while (!studio.idle || !journal.settled) await new Promise((resolve) => { setTimeout(resolve, 50); });
}

/** Not before the first model stands: until then all that is loaded is for it. */
async function beInstalled() {
  if (!import.meta.env.PROD) return; // the service worker is made with the page
  const { keepForOffline, openLaunchedFiles } = await import('./app/installed');
  const { newVersion } = await import('./panels/new_version');
  await openLaunchedFiles(studio);
  await keepForOffline((take) => toasts.append(newVersion(take)), kept);
}
const begun = begin();
warmUp(viewport);
void studio.loadMethods(begun);
void begun.then(beInstalled);
