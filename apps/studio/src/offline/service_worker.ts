// Keeps all files of one build, so that the page opens without a network. What a user opens is never kept here.
//
// A build is kept whole or not at all: each file must have the hash that the build gave it. The next build is kept beside
// it, and takes its place when no page of the old one is open any more, or when the user says so.

export type {}; // a module, so that `self` is its own
declare const self: ServiceWorkerGlobalScope;
/** Put in by vite/installable.ts. Files by their path below the page's folder, with the hashes that they may have. */
declare const builtFiles: Readonly<Record<string, string>>;
declare const version: string;

const { scope } = self.registration;
const ours = `limber studio ${scope} `; // other folders of one host share its caches
const cacheName = ours + version;
const addressOf = (path: string) => new URL(path, scope).href;
const known = new Set(Object.keys(builtFiles).map(addressOf));
const shareTarget = addressOf('share');
/** Shared with the studio by another app, until its page has asked for them. */
let sharedFiles: File[] = [];

async function fetchBuilt(path: string, integrity: string): Promise<Response> {
  // The browser's own cache may have another build's file under that name.
  const fetched = await fetch(addressOf(path), { integrity }).catch(() => fetch(addressOf(path), { integrity, cache: 'reload' }));
  if (!fetched.ok) throw new Error(`${path}: answer ${fetched.status}`);
  // Made anew, since a page may not be opened with an answer that came by a redirect.
  return new Response(fetched.body, fetched);
}

async function keepBuild() {
  const cache = await caches.open(cacheName);
  await Promise.all(Object.entries(builtFiles).map(async ([path, integrity]) => {
    if (!await cache.match(addressOf(path))) await cache.put(addressOf(path), await fetchBuilt(path, integrity));
  }));
}

async function dropOtherBuilds() {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith(ours) && name !== cacheName).map((name) => caches.delete(name)));
  await self.clients.claim();
}

/** Whether the other build's pages leave room: no more than the one that asks is open. */
async function takeOver(): Promise<boolean> {
  const pages = await self.clients.matchAll({ type: 'window', includeUncontrolled: true });
  if (pages.filter(({ url }) => url.startsWith(scope)).length > 1) return false;
  await self.skipWaiting();
  return true;
}

async function answerFromBuild(address: string, request: Request): Promise<Response> {
  const cache = await caches.open(cacheName);
  return await cache.match(address) ?? fetch(request);
}

/** Any site's page can send a form here; what the system shares has no page behind it. A site that hides its address is not told apart. */
function isOfOtherSite({ referrer, headers }: Request): boolean {
  if (['cross-site', 'same-site'].includes(headers.get('sec-fetch-site') ?? '')) return true;
  return /^https?:/.test(referrer) && new URL(referrer).origin !== self.location.origin;
}

async function takeShared(request: Request): Promise<Response> {
  if (isOfOtherSite(request)) return new Response('', { status: 403 });
  sharedFiles = (await request.formData()).getAll('files').filter((entry): entry is File => entry instanceof File);
  return Response.redirect(addressOf('./?shared'), 303);
}

self.addEventListener('install', (event) => event.waitUntil(keepBuild()));
self.addEventListener('activate', (event) => event.waitUntil(dropOtherBuilds()));

self.addEventListener('fetch', (event) => {
  const { request } = event, url = new URL(request.url), namesModel = url.searchParams.has('model');
  url.search = url.hash = '';
  const address = url.href === addressOf('index.html') ? scope : url.href;
  if (request.method === 'POST' && address === shareTarget) event.respondWith(takeShared(request));
  else if (request.method === 'GET' && known.has(address)) {
    // The program's server lets only a document that names a model fetch it (apps/cli/studio/server.cpp): not the kept one.
    const kept = () => answerFromBuild(address, request);
    event.respondWith(namesModel && address === scope ? fetch(request).catch(kept) : kept());
  }
});

self.addEventListener('message', (event) => {
  const answer = (value: unknown) => event.ports[0]?.postMessage(value);
  if (event.data === 'take over') event.waitUntil(takeOver().then(answer));
  if (event.data === 'shared files') {
    answer(sharedFiles);
    sharedFiles = [];
  }
});
