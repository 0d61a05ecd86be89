// What the browser keeps of the files, so that they are there again after a reload.

import { createStore, del, set, values, type UseStore } from "idb-keyval";
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
  private constructor(private readonly store: UseStore | null, readonly trouble: string) {}

  /** One page at a time keeps the files: two would write over each other's. */
  static async open(): Promise<Store> {
    const hasLock = await new Promise<boolean>((resolve) => {
      // Browsers have locks in secure contexts alone.
      if (!navigator.locks) return resolve(true);
      navigator.locks
        .request("okoshi.files", { signal: AbortSignal.timeout(LEAVING) }, () => {
          resolve(true);
          return new Promise(() => {});
        })
        .catch(() => resolve(false));
    });
    if (!hasLock) return new Store(null, "Your drawings are open in another tab. What you do in this one is not kept: save it.");
    try {
      const store = createStore("okoshi", "files");
      await values(store);
      return new Store(store, "");
    } catch {
      return new Store(null, "This browser keeps nothing for this page. Save your drawing before you leave.");
    }
  }

  async all(): Promise<readonly Kept[]> {
    const all = this.store ? await values<Kept>(this.store) : [];
    return all.sort((a, b) => a.order - b.order);
  }

  /** Rejects if there is no space left. */
  async keep(kept: Kept): Promise<void> {
    if (this.store) await set(kept.path, kept, this.store);
  }

  async forget(path: string): Promise<void> {
    if (this.store) await del(path, this.store);
  }
}
