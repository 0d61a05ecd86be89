// What the extension and its worker say to each other beside the language server protocol and `preview/messages.ts`.

/** A request of the server for a file that a drawing links to. */
export const READ_FILE = "okoshi/file";

export interface FileQuestion {
  /** The drawing's URI. */
  readonly drawing: string;
  /** From the drawing's folder. */
  readonly path: string;
}

export interface FileAnswer {
  readonly uri: string;
  /** Null if there is no such file. */
  readonly bytes: Uint8Array | null;
}

/** The module stopped at a fault of its own, and has to be started again. A notification that a client which does not know it ignores. */
export const STOPPED = "$/okoshi/stopped";
