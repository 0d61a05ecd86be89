// The host of a VS Code webview: everything goes by posted messages.

import { isSave, leaveField } from "../dom";
import { read, type FromHost, type ToHost } from "../protocol";
import { toBase64 } from "./base64";
import type { Answer, Attempted, Host, Link } from "./host";

export interface CodeApi {
  postMessage(message: unknown): void;
  /** The state that the editor passes to the extension when it restores the panel after a reload. */
  setState(state: unknown): void;
}

type Waiting = { readonly resolve: (bytes: ArrayBuffer) => void; readonly reject: (error: Error) => void };

export class CodeHost implements Host {
  /** Webviews are not given cameras. */
  readonly openCamera = null;
  readonly film = null;
  readonly file = null;
  readonly share = null;
  readonly player = null;
  readonly showsFindings = true;
  readonly changes = { doing: "Changing…", done: "Changed in the text", where: "Changes are made in the text" };
  /** An editor has the drawing already. */
  readonly invitation = { heading: "", toStarters: "", alone: "" };
  readonly jumps = true;
  /** Requests about changes, by number. */
  private readonly asked = new Map<number, (answer: Answer) => void>();
  private questions = 0;
  private tries = 0;
  /** Pending requests by address. */
  private readonly waiting = new Map<string, Waiting[]>();

  constructor(private readonly api: CodeApi) {}

  listen(handler: (message: FromHost) => void, link: (state: Link, note?: string) => void): void {
    addEventListener("message", ({ data }: MessageEvent<unknown>) => {
      const posted = typeof data === "object" && data !== null && "okoshi" in data ? data.okoshi : undefined;
      if (typeof posted !== "object" || posted === null) return;
      if ("type" in posted && posted.type === "modelBytes") return this.arrived(posted);
      if ("type" in posted && posted.type === "answer") return this.answered(posted);
      // The extension is always there; the language server behind it may be away, or restart.
      if ("type" in posted && posted.type === "link") {
        const { state, note } = posted as { state?: unknown; note?: unknown };
        return link(state === "lost" || state === "connecting" ? state : "open", typeof note === "string" ? note : "");
      }
      const message = read(posted);
      if (message?.type === "drawings") this.api.setState({ drawing: message.drawings[0]?.id });
      if (message) handler(message);
    });
    // The panel has the keyboard, so that the editor would save the panel, which is no file.
    addEventListener("keydown", (event) => {
      if (isSave(event)) void leaveField().then(() => this.api.postMessage({ type: "saveText" }));
    });
    link("open");
    this.api.postMessage({ type: "ready" });
  }

  send(message: ToHost): void {
    this.api.postMessage(message);
  }

  model(address: string): Promise<ArrayBuffer> {
    return new Promise((resolve, reject) => {
      const already = this.waiting.get(address);
      if (already) return void already.push({ resolve, reject });
      this.waiting.set(address, [{ resolve, reject }]);
      this.api.postMessage({ type: "model", address });
    });
  }

  /** The editor holds the text: it makes the changes there, and undoes them. */
  readonly post = (what: "changes" | "forms", _key: string, request: unknown): Promise<Answer> => this.ask(what, request);

  readonly attempt = async (_key: string, request: unknown): Promise<Attempted | null> => {
    const { ok, body } = await this.ask("tries", request);
    const bytes = ok ? toBuffer(body) : null;
    return bytes && { address: `tries/${++this.tries}.glb`, bytes };
  };

  async picture(address: string): Promise<string> {
    return URL.createObjectURL(new Blob([await this.model(address)], { type: "image/png" }));
  }

  async save(name: string, content: Blob): Promise<void> {
    // A webview cannot download files: the editor asks where to save.
    this.api.postMessage({ type: "save", name, bytes: toBase64(new Uint8Array(await content.arrayBuffer())) });
  }

  private ask(what: "changes" | "forms" | "tries", request: unknown): Promise<Answer> {
    return new Promise((resolve) => {
      const id = ++this.questions;
      this.asked.set(id, resolve);
      this.api.postMessage({ type: "ask", id, what, request });
    });
  }

  private answered(posted: object): void {
    const { id, ok, body } = posted as { id?: unknown; ok?: unknown; body?: unknown };
    const resolve = typeof id === "number" ? this.asked.get(id) : undefined;
    if (!resolve) return;
    this.asked.delete(id as number);
    resolve({ ok: ok === true, body });
  }

  private arrived(posted: object): void {
    const { address, bytes } = posted as { address?: unknown; bytes?: unknown };
    const waiting = typeof address === "string" ? this.waiting.get(address) : undefined;
    if (!waiting) return;
    this.waiting.delete(address as string);
    const buffer = toBuffer(bytes);
    for (const { resolve, reject } of waiting) {
      if (buffer) resolve(buffer);
      else reject(new Error("the editor has no such file"));
    }
  }
}

/** Bytes as VS Code passes them: as such, or as base64. */
export function toBuffer(bytes: unknown): ArrayBuffer | null {
  if (bytes instanceof ArrayBuffer) return bytes;
  if (ArrayBuffer.isView(bytes)) return new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength).slice().buffer;
  if (typeof bytes !== "string") return null;
  return Uint8Array.from(atob(bytes), (one) => one.charCodeAt(0)).buffer;
}
