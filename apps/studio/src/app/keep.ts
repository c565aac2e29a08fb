// The session kept in the browser, so that a reload, or a closed page, loses nothing. It never leaves the machine.
import type { PageStore } from './state';
import type { Studio } from './studio';

const quiet = 1500; // milliseconds without a change before it is kept

function database(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open('limber-studio', 1);
    request.onupgradeneeded = () => request.result.createObjectStore('session');
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(new Error('no store'));
  });
}

async function withStore<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const open = await database();
  return new Promise((resolve, reject) => {
    const request = act(open.transaction('session', mode).objectStore('session'));
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(new Error('the store failed'));
  });
}

interface Kept { name: string; bytes: Uint8Array }

/** What was kept last; null where nothing was, or where the browser keeps nothing. */
export async function keptSession(): Promise<Kept | null> {
  return withStore<Kept | undefined>('readonly', (store) => store.get('last')).then((kept) => kept ?? null, () => null);
}

/** After each change that a user made. What it gives says whether all of them are kept. */
export function keepSession(studio: Studio, page: PageStore): () => boolean {
  let timer = 0, waiting = false;
  const keep = async () => {
    const name = page.now.session?.name;
    if (!name || page.now.playing || !studio.idle) return later();
    const bytes = await studio.exportFile('session');
    if (bytes) await withStore('readwrite', (store) => store.put({ name, bytes } satisfies Kept, 'last')).catch(() => {});
    waiting = false;
  };
  const later = () => {
    waiting = true;
    clearTimeout(timer);
    timer = window.setTimeout(() => void keep(), quiet);
  };
  page.watch((now, before) => {
    if (now.session !== before.session && now.session?.undo) later();
  });
  return () => !waiting;
}
