// The page's connection to its host.

import type { FromHost, ToHost } from "../protocol";
import { WebHost } from "./web";
import { CodeHost, type CodeApi } from "./code";

export type Link = "connecting" | "open" | "lost";

/** An answer to a request, as JSON. */
export interface Answer {
  readonly ok: boolean;
  readonly body: unknown;
}

/** A model that no drawing has: what differs in it from another one, and the address by which that is known. */
export interface Attempted {
  readonly address: string;
  readonly bytes: ArrayBuffer;
}

/** What is said while a change is made, after it, and while there is none. */
export interface ChangeWords {
  readonly doing: string;
  readonly done: string;
  readonly where: string;
}

export interface Host {
  /** Starts to report messages of the host and the state of the connection, with a note that explains it. */
  listen(handler: (message: FromHost) => void, link: (state: Link, note?: string) => void): void;
  /** Messages are lost while there is no connection. */
  send(message: ToHost): void;
  /** The bytes of a model; rejects with `Replaced` if the host says that it has only newer ones. With `?since=` and the address of another one, those of what changed, or of the model if that is too much. */
  model(address: string): Promise<ArrayBuffer>;
  /** The address of a thumbnail, for an `<img>`. */
  picture(address: string): Promise<string>;
  /** A moving picture, as GIF: of the clip with this number, or of the model that turns, from a direction in degrees to its left and up. Null where the
   * host makes none. */
  readonly film: ((model: string, clip: number | null, view: readonly [number, number]) => Promise<Blob>) | null;
  /** Another file of a drawing, by its address; null where the host makes none. */
  readonly file: ((address: string) => Promise<Blob>) | null;
  /** Shares a drawing by a link; null where there are no links to it. */
  readonly share: ((drawing: string) => void) | null;
  /** A page that shows a model that is put into it (player/page.ts); null where there is none. */
  readonly player: (() => Promise<string>) | null;
  /** What becomes of changes, in words: an editor makes them in its text, which a person saves. */
  readonly changes: ChangeWords;
  /** What is said while there are no drawings: above those to start from, with a heading, and where none is offered. */
  readonly invitation: { readonly heading: string; readonly toStarters: string; readonly alone: string };
  /** Whether an editor may show the string of the part that is clicked. */
  readonly jumps: boolean;
  /** Asks for a change, or what can be changed, with the host's key; null where the page changes nothing. */
  readonly post: ((what: "changes" | "forms", key: string, request: unknown) => Promise<Answer>) | null;
  /** Asks for a model of what a change would make of the drawing; null if there is none to show. */
  readonly attempt: ((key: string, request: unknown) => Promise<Attempted | null>) | null;
  /** Saves a file for the user. */
  save(name: string, content: Blob): Promise<void>;
  /** Whether the host is an editor that shows what is wrong with the drawing. */
  readonly showsFindings: boolean;
  /** Opens a connection on which pictures of a camera are tracked; null where pages have no camera. */
  readonly openCamera: (() => WebSocket) | null;
}

declare const acquireVsCodeApi: (() => CodeApi) | undefined;

export function findHost(): Host {
  return typeof acquireVsCodeApi === "function" ? new CodeHost(acquireVsCodeApi()) : new WebHost();
}
