// The page as an app: kept for use without a network, and opened with files by the system or by another app. Loaded once
// the first model stands.
import type { Studio } from './studio';

/** Takes a new version's place for the old one, and reloads; false while the old one is open elsewhere. */
export type TakeVersion = () => Promise<boolean>;

function ask<T>(worker: ServiceWorker, question: string): Promise<T> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = ({ data }) => resolve(data as T);
    worker.postMessage(question, [port2]);
  });
}

/** `onNew` is called when another version waits; `kept` resolves once a reload loses nothing. */
export async function keepForOffline(onNew: (take: TakeVersion) => void, kept: () => Promise<void>) {
  // There is none on a page that is not secure; it is refused where the certificate is not trusted, or in a private window.
  const workers = navigator.serviceWorker as ServiceWorkerContainer | undefined;
  const registration = await workers?.register(new URL('service_worker.js', document.baseURI), { updateViaCache: 'none' }).catch(() => undefined);
  if (!workers || !registration) return;
  const tell = () => {
    const { waiting } = registration;
    if (!waiting) return;
    onNew(async () => {
      await kept();
      const taken = new Promise((resolve) => { workers.addEventListener('controllerchange', resolve, { once: true }); });
      if (!await ask<boolean>(waiting, 'take over')) return false;
      await taken;
      location.reload();
      return true;
    });
  };
  const watch = ({ installing }: ServiceWorkerRegistration) => installing?.addEventListener('statechange', () => {
    // The first one is no news.
    if (installing.state === 'installed' && workers.controller) tell();
  });
  if (workers.controller) tell();
  watch(registration);
  registration.addEventListener('updatefound', () => watch(registration));
  // An app on a home screen stays open for days.
  document.addEventListener('visibilitychange', () => { if (!document.hidden) registration.update().catch(() => {}); });
}

interface LaunchQueue {
  setConsumer(take: (launch: { files: readonly FileSystemFileHandle[] }) => void): void;
}

/** Files that the studio was opened with by the system (file_handlers), or that another app shared with it (share_target). */
export async function openLaunchedFiles(studio: Studio) {
  (globalThis as { launchQueue?: LaunchQueue }).launchQueue?.setConsumer(({ files }) => {
    if (files.length > 0) void Promise.all(files.map((handle) => handle.getFile())).then((all) => studio.openFiles(all));
  });
  const { controller } = navigator.serviceWorker as ServiceWorkerContainer | undefined ?? {};
  if (!controller || !new URLSearchParams(location.search).has('shared')) return;
  history.replaceState(null, '', location.pathname);
  const files = await ask<File[]>(controller, 'shared files');
  if (files.length > 0) await studio.openFiles(files);
}
