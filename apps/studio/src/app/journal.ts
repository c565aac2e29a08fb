// What is done, written into the browser behind each step, so that a reload, a crash or a closed page loses nothing.
// A document is the requests that made it, in their order: carried out again they give the same document, with its
// motions and all that can be undone. Nothing ever leaves the machine.
import type { Place, Request } from '../engine/messages';
import { noteDocumentOfTab, noteDocuments } from './remembered';

const frameDelay = 100; // milliseconds between two frames of a drag or of a clip that are written
const patience = 700; // milliseconds that a document may still be open elsewhere
const mostDocuments = 12;

export interface KeptDocument {
  id: string;
  name: string;
  /** Milliseconds since 1970. */
  changed: number;
  /** A data address of a small picture; empty while there is none. */
  picture: string;
  /** Of its requests. */
  count: number;
}

export function done<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error('the store failed'));
  });
}

export function finished(transaction: IDBTransaction): Promise<void> {
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve();
    transaction.onerror = transaction.onabort = () => reject(transaction.error ?? new Error('the store failed'));
  });
}

async function openDatabase(): Promise<IDBDatabase> {
  const request = indexedDB.open('limber-studio', 2);
  request.onupgradeneeded = ({ oldVersion }) => {
    const documents = request.result.createObjectStore('documents', { keyPath: 'id' });
    const requests = request.result.createObjectStore('requests');
    if (oldVersion !== 1) return;
    // The first version kept one session, as a model.
    const old = request.transaction!.objectStore('session').get('last') as IDBRequest<{ name: string; bytes: Uint8Array } | undefined>;
    old.onsuccess = () => {
      const { name, bytes } = old.result ?? {};
      if (name !== undefined && bytes) {
        documents.put({ id: 'kept', name, changed: Date.now(), picture: '', count: 1 } satisfies KeptDocument);
        requests.put({ kind: 'open', bytes, name } satisfies Request, ['kept', 0]);
      }
      request.result.deleteObjectStore('session');
    };
  };
  return done(request);
}

const newId = () => `${Date.now().toString(36)}-${Math.random().toString(36).slice(2, 8)}`;
const allOf = (id: string) => IDBKeyRange.bound([id], [id, []]);

export class Journal {
  /** The browser keeps nothing, or nothing any more: said once. */
  onTrouble: (why: string) => void = () => {};

  private database = openDatabase();
  private document: KeptDocument | null = null;
  private waiting = 0;
  private unwritten = 0;
  private frame: { request: Request; timer: number } | null = null;
  private lastFrame = -Infinity;
  private free: () => void = () => {};
  private broken = false;

  constructor() {
    this.database.catch(() => {}); // told with the first write
  }

  /** Everything is kept. */
  get settled() { return this.waiting === 0 && this.frame === null; }
  /** All that was done is kept, but perhaps for the last frame of a drag or the moment of a clip that plays. */
  get written() { return this.unwritten === 0; }
  /** Whether what is done now would be lost with the page. */
  get atRisk() { return this.broken; }
  get current() { return this.document?.id ?? null; }

  /** Those kept, the newest first. */
  async list(): Promise<KeptDocument[]> {
    try {
      const all = (await this.database).transaction('documents').objectStore('documents').getAll() as IDBRequest<KeptDocument[]>;
      const documents = await done(all);
      noteDocuments(documents.length > 0);
      return documents.sort((a, b) => b.changed - a.changed);
    } catch {
      return [];
    }
  }

  async requestsOf(id: string): Promise<Request[]> {
    const store = (await this.database).transaction('requests').objectStore('requests');
    return done(store.getAll(allOf(id)) as IDBRequest<Request[]>);
  }

  /** Goes on with a document of which `kept` requests are kept. One that is open elsewhere goes on as a copy: false. */
  async resume(document: KeptDocument, requests: Request[], kept: number): Promise<boolean> {
    this.flush();
    const own = await this.take(document.id, AbortSignal.timeout(patience));
    const { id } = this.goOn({ ...document, id: own ? document.id : newId(), count: requests.length });
    if (!own) await this.take(id);
    requests.forEach((request, number) => {
      if (!own || number >= kept) void this.put(request, number);
    });
    return own;
  }

  /** A document that was made elsewhere. */
  begin(name: string, requests: Request[]): boolean {
    this.flush();
    void this.take(this.goOn({ id: newId(), name, changed: 0, picture: '', count: requests.length }).id);
    requests.forEach((request, number) => void this.put(request, number));
    return true;
  }

  /** Behind each request that changed a document. */
  add(request: Request, place: Place) {
    if (place === 'begins') {
      const name = request.kind === 'open' ? request.name : request.kind === 'run' ? String(request.command.name) : '';
      this.flush();
      void this.take(this.goOn({ id: newId(), name, changed: 0, picture: '', count: 0 }).id);
    }
    if (!this.document) return;
    if (place === 'replaces') return this.delay(request);
    this.flush();
    ++this.unwritten;
    void this.put(request, this.document.count++).finally(() => { --this.unwritten; });
  }

  private goOn(document: KeptDocument): KeptDocument {
    noteDocumentOfTab(document.id);
    return this.document = document;
  }

  /** What the list of documents shows. */
  describe(name: string, picture: string) {
    if (!this.document) return;
    const { document } = this;
    document.name = name;
    document.picture = picture;
    void this.queue(() => this.write(document, () => {}));
  }

  /** Gives what brings it back. */
  async forget(document: KeptDocument): Promise<() => Promise<void>> {
    const requests = await this.requestsOf(document.id);
    await this.erase(document.id);
    return () => this.queue(async () => {
      const transaction = (await this.database).transaction(['documents', 'requests'], 'readwrite');
      transaction.objectStore('documents').put(document);
      requests.forEach((request, number) => transaction.objectStore('requests').put(request, [document.id, number]));
      await finished(transaction);
    });
  }

  private async erase(id: string) {
    await this.queue(async () => {
      const transaction = (await this.database).transaction(['documents', 'requests'], 'readwrite');
      transaction.objectStore('documents').delete(id);
      transaction.objectStore('requests').delete(allOf(id));
      await finished(transaction);
    });
  }

  /** Writes a frame that waits. */
  flush() {
    if (!this.frame || !this.document) return;
    clearTimeout(this.frame.timer);
    const { request } = this.frame;
    this.frame = null;
    this.lastFrame = performance.now();
    void this.put(request, this.document.count - 1);
  }

  /** Written at once where there was none lately: on a busy page a timer comes late. */
  private delay(request: Request) {
    const rest = this.lastFrame + frameDelay - performance.now();
    if (this.frame) this.frame.request = request;
    else this.frame = { request, timer: window.setTimeout(() => this.flush(), Math.max(0, rest)) };
    if (rest <= 0) this.flush();
  }

  private put(request: Request, number: number): Promise<void> {
    const document = this.document!;
    return this.queue(async () => {
      await this.write(document, (requests) => requests.put(request, [document.id, number]));
      if (number === 0) await this.forgetOldest();
    });
  }

  private async write(document: KeptDocument, also: (requests: IDBObjectStore) => void) {
    const transaction = (await this.database).transaction(['documents', 'requests'], 'readwrite');
    document.changed = Date.now();
    transaction.objectStore('documents').put({ ...document });
    also(transaction.objectStore('requests'));
    await finished(transaction);
  }

  /** What was only looked at goes before what was worked on. */
  private async forgetOldest() {
    const all = await this.list(), oldest = all.slice(1).reverse(), lookedAt = oldest.filter(({ count }) => count <= 1);
    const going = [...lookedAt, ...oldest.filter(({ count }) => count > 1)].slice(0, Math.max(0, all.length - mostDocuments));
    for (const { id } of going) void this.erase(id);
  }

  /** Each transaction is begun at once, behind those before it, which the database keeps in their order: a page that is
   *  busy drawing must not hold up what is written. The first failure is told, and ends the keeping. */
  private async queue(act: () => Promise<void>): Promise<void> {
    ++this.waiting;
    try {
      if (!this.broken) await act();
    } catch (error) {
      if (!this.broken) this.onTrouble(String(error instanceof Error ? error.message : error));
      this.broken = true;
    } finally {
      --this.waiting;
    }
  }

  /** A document is open in one tab alone; nobody else knows a new one, whose turn comes however long a busy machine
   *  takes. Browsers without locks have to trust. */
  private take(id: string, signal?: AbortSignal): Promise<boolean> {
    this.free();
    this.free = () => {};
    if (!('locks' in navigator)) return Promise.resolve(true);
    return new Promise((resolve) => {
      const name = `limber-document-${id}`, hold = () => {
        resolve(true);
        return new Promise<void>((release) => { this.free = release; });
      };
      // A page that is being reloaded may hold it a moment longer; and where the time ran out while this machine stood still, it is free.
      navigator.locks.request(name, { ...signal && { signal } }, hold)
        .catch(() => navigator.locks.request(name, { ifAvailable: true }, (lock) => (lock ? hold() : undefined)))
        .then(() => resolve(false), () => resolve(false));
    });
  }
}
