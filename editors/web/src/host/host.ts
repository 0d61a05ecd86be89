// The page's one door to whoever shows it.

import type { FromHost, ToHost } from "../protocol";
import { WebHost } from "./web";
import { CodeHost, type CodeApi } from "./code";

export type Link = "connecting" | "open" | "lost";

export interface Host {
  /** Hands over what the host says, and how the connection to it is, from now on. A note says why it is so, in words. */
  listen(handler: (message: FromHost) => void, link: (state: Link, note?: string) => void): void;
  /** What is sent while there is no connection is lost. */
  send(message: ToHost): void;
  /** The bytes of a model. */
  model(address: string): Promise<ArrayBuffer>;
  /** The address of a thumbnail, for an `<img>`. */
  picture(address: string): Promise<string>;
  /** Gives the person a file. */
  save(name: string, content: Blob): Promise<void>;
}

declare const acquireVsCodeApi: (() => CodeApi) | undefined;

export function findHost(): Host {
  return typeof acquireVsCodeApi === "function" ? new CodeHost(acquireVsCodeApi()) : new WebHost();
}
