// What the browser keeps of the files, so that they are there again after a reload.

import { createStore, promisifyRequest, values, type UseStore } from "idb-keyval";
import type { ProjectFile } from "../host/worker/calls";

export interface Kept extends ProjectFile {
  /** Its place among the files. */
  readonly order: number;
  /** Whether it has changes that are in no file. */
  readonly changed: boolean;
  /** The file that it was opened from, where browsers tell, and its time of modification when it was last read or written. */
  readonly handle: FileSystemFileHandle | null;
  readonly seen: number;
}

/** How long to wait for another page with the same files to be gone, such as the one that is being reloaded, in milliseconds. */
const LEAVING = 1500;

export class Store {
  /**
   * `kept`: what was kept when it was opened, in its order. `trouble`: why nothing is kept, in words, or nothing. `later`: what is kept once the
   * other page with the same files is gone.
   */
  private constructor(private readonly store: UseStore | null, readonly kept: readonly Kept[], readonly trouble = "", readonly later: Promise<Store> | null = null) {}

  /** One page at a time keeps the files: two would write over each other's. */
  static async open(): Promise<Store> {
    const turn = whenAlone();
    const isAlone = await Promise.race([turn.then(() => true), new Promise<boolean>((resolve) => setTimeout(() => resolve(false), LEAVING))]);
    if (isAlone) return Store.read();
    return new Store(null, [], "Your drawings are open in another tab. What you do in this one is not kept until that one is closed.", turn.then(() => Store.read()));
  }

  private static async read(): Promise<Store> {
    try {
      const store = createStore("okoshi", "files");
      const kept = await values<Kept>(store);
      return new Store(store, kept.sort((a, b) => a.order - b.order));
    } catch {
      return new Store(null, [], "This browser keeps nothing for this page. Save your drawing before you leave.");
    }
  }

  /** Rejects if there is no space left. */
  async keep(kept: Kept): Promise<void> {
    await this.write((store) => store.put(kept, kept.path));
  }

  async forget(path: string): Promise<void> {
    await this.write((store) => store.delete(path));
  }

  /** Without the explicit commit, the browser would wait for the page, and give up what was written just before the page is left. */
  private async write(request: (store: IDBObjectStore) => unknown): Promise<void> {
    await this.store?.("readwrite", (store) => {
      request(store);
      store.transaction.commit();
      return promisifyRequest(store.transaction);
    });
  }
}

/** Waits until no other page has the files, and from then on no other one gets them. */
function whenAlone(): Promise<void> {
  return new Promise((resolve) => {
    // Browsers have locks in secure contexts alone, and not where they keep nothing.
    if (!navigator.locks) return resolve();
    const held = (): Promise<never> => (resolve(), new Promise(() => {}));
    navigator.locks.request("okoshi.files", held).catch(() => resolve());
  });
}
