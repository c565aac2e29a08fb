// The user's own poses, kept in the browser for all models. Nothing ever leaves the machine.
import { done, finished } from './journal';

export interface KeptPose {
  id: string;
  name: string;
  /** The text of its file. */
  pose: string;
  /** A data address of a small picture: the first character that stood so; empty while there is none. */
  picture: string;
  /** Milliseconds since 1970. */
  made: number;
}

async function openPoses(): Promise<IDBDatabase> {
  const request = indexedDB.open('limber-poses', 1);
  request.onupgradeneeded = () => { request.result.createObjectStore('poses', { keyPath: 'id' }); };
  return done(request);
}

/** Fails where the browser keeps nothing. */
export class PoseStore {
  private database = openPoses();

  constructor() {
    this.database.catch(() => {}); // told by each call
  }

  /** The newest first. */
  async list(): Promise<KeptPose[]> {
    const all = (await this.database).transaction('poses').objectStore('poses').getAll() as IDBRequest<KeptPose[]>;
    return (await done(all)).sort((a, b) => b.made - a.made);
  }

  async put(poses: readonly KeptPose[]) { await this.write((store) => poses.forEach((pose) => store.put(pose))); }
  async forget(id: string) { await this.write((store) => store.delete(id)); }

  private async write(act: (store: IDBObjectStore) => void) {
    const transaction = (await this.database).transaction('poses', 'readwrite');
    act(transaction.objectStore('poses'));
    await finished(transaction);
  }
}
