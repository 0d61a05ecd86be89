// A language server that the module answers for. Independent of the editor and of workers.
//
// A text is analysed when something is asked about it, or when there are no more messages: keys that come faster than that are analysed
// together.

import type { Server } from "okoshi_web";
import { ResponseError, type MessageConnection } from "vscode-jsonrpc";
import { PREVIEW_NOTIFICATION } from "../preview/messages";
import { READ_FILE, STOPPED, type FileAnswer, type FileQuestion } from "./protocol";

/** What the module answers, and the names of its methods. */
export type Answers = Pick<Server, "write" | "put" | "renew" | "close" | "links" | "diagnostics" | "request" | "news" | "bytes" | "attempt">;

/** A file that a text links to. */
interface Linked {
  /** Its address; null as long as it is not known. */
  readonly uri: string | null;
  readonly isThere: boolean;
}

/** A text that the editor has open. */
interface Open {
  version: number;
  text: string;
  /** Whether the module does not have this text yet. */
  isNew: boolean;
  /** Whether its diagnostics are to be sent. */
  isDue: boolean;
  /** The files that it links to, by their paths. */
  readonly files: Map<string, Linked>;
}

interface Identified {
  readonly textDocument: { readonly uri: string };
}

type Opened = { readonly textDocument: { readonly uri: string; readonly version: number; readonly text: string } };
type Changed = { readonly textDocument: { readonly uri: string; readonly version: number }; readonly contentChanges: readonly { readonly text: string }[] };
type Watched = { readonly changes: readonly { readonly uri: string }[] };
interface Initialized {
  capabilities: { textDocumentSync: { change: number } };
}

/** The whole text is sent with each change: the module takes no other. */
const FULL = 1;
/** The JSON-RPC error code of a request that failed. */
const INTERNAL_ERROR = -32603;

export class Language {
  private readonly texts = new Map<string, Open>();
  private onType = true;
  private stopped = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly module: Answers,
    private readonly connection: MessageConnection,
  ) {
    connection.onRequest((method, params) => this.guarded(() => this.answer(method, params)));
    connection.onNotification((method, params) => {
      try {
        this.guarded(() => this.told(method, params));
      } catch {
        // It is said already that the module has stopped, and nobody waits for an answer.
      }
    });
    connection.listen();
  }

  private answer(method: string, params: unknown): unknown {
    if (method === "shutdown") return null;
    if (method === "initialize") return this.initialize(params);
    const uri = uriOf(params);
    if (uri !== undefined) this.settle(uri);
    switch (method) {
      case "okoshi/preview/model":
        return { bytes: this.module.bytes((params as { address: string }).address) ?? null };
      case "okoshi/preview/try":
        return { bytes: this.module.attempt(JSON.stringify(params)) ?? null };
    }
    const result = this.ask(method, params);
    if (uri !== undefined) this.sendNews(uri);
    return result;
  }

  private told(method: string, params: unknown): void {
    switch (method) {
      case "textDocument/didOpen": {
        const { uri, version, text } = (params as Opened).textDocument;
        this.texts.set(uri, { version, text, isNew: true, isDue: true, files: new Map() });
        return this.soon();
      }
      case "textDocument/didChange": {
        const { textDocument, contentChanges } = params as Changed;
        const open = this.texts.get(textDocument.uri);
        const text = contentChanges.at(-1)?.text;
        if (!open || text === undefined) return;
        Object.assign(open, { version: textDocument.version, text, isNew: true, isDue: open.isDue || this.onType });
        return this.soon();
      }
      case "textDocument/didSave": {
        const open = this.texts.get(uriOf(params) ?? "");
        if (open) open.isDue = true;
        return this.soon();
      }
      case "textDocument/didClose": {
        const uri = uriOf(params) ?? "";
        this.texts.delete(uri);
        this.module.close(uri);
        return this.send("textDocument/publishDiagnostics", { uri, diagnostics: [] });
      }
      case "workspace/didChangeConfiguration":
        this.onType = analyseOf((params as { settings?: { okoshi?: unknown } }).settings?.okoshi) !== "onSave";
        return;
      case "workspace/didChangeWatchedFiles":
        return this.filesChanged(new Set((params as Watched).changes.map(({ uri }) => uri)));
      case "okoshi/preview/cursor":
      case "okoshi/preview/close": {
        const uri = uriOf(params);
        // A panel is closed after its text, too.
        if (uri === undefined || !this.texts.has(uri)) return;
        this.settle(uri);
        this.ask(method, params);
        return this.sendNews(uri);
      }
    }
  }

  private initialize(params: unknown): unknown {
    this.onType = analyseOf((params as { initializationOptions?: unknown }).initializationOptions) !== "onSave";
    const result = this.ask("initialize", params) as Initialized;
    result.capabilities.textDocumentSync.change = FULL;
    return result;
  }

  private ask(method: string, params: unknown): unknown {
    const { result, error } = JSON.parse(this.module.request(method, JSON.stringify(params), Date.now())) as { result?: unknown; error?: { code: number; message: string } };
    if (error) throw new ResponseError(error.code, error.message);
    return result;
  }

  /** Analyses what is new once there are no more messages. */
  private soon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      try {
        this.guarded(() => {
          for (const uri of this.texts.keys()) this.settle(uri);
        });
      } catch {
        // It is said already that the module has stopped.
      }
    });
  }

  /** Gives the module a text that it does not have yet, and sends what it finds. */
  private settle(uri: string): void {
    const open = this.texts.get(uri);
    if (!open) return;
    if (open.isNew) {
      open.isNew = false;
      this.module.write(uri, open.version, open.text, Date.now());
      this.found(uri, open);
      this.readNewLinks(uri, open);
    }
    this.sendDiagnostics(uri, open);
  }

  private found(uri: string, open: Open): void {
    this.sendDiagnostics(uri, open);
    this.sendNews(uri);
  }

  private sendDiagnostics(uri: string, open: Open): void {
    if (!open.isDue) return;
    open.isDue = false;
    const diagnostics: unknown = JSON.parse(this.module.diagnostics(uri));
    this.send("textDocument/publishDiagnostics", { uri, version: open.version, diagnostics });
  }

  private sendNews(uri: string): void {
    const messages = this.module.news(uri).map((message): unknown => JSON.parse(message));
    if (messages.length > 0) this.send(PREVIEW_NOTIFICATION, { textDocument: { uri }, messages });
  }

  private readNewLinks(uri: string, open: Open): void {
    const paths = this.module.links(uri).filter((path) => !open.files.has(path));
    for (const path of paths) open.files.set(path, { uri: null, isThere: false });
    if (paths.length > 0) void this.readFiles(uri, open, paths);
  }

  private filesChanged(changed: ReadonlySet<string>): void {
    for (const [uri, open] of this.texts) {
      const paths = [...open.files].filter(([, { uri: address }]) => address !== null && changed.has(address)).map(([path]) => path);
      if (paths.length > 0) void this.readFiles(uri, open, paths);
    }
  }

  private async readFiles(uri: string, open: Open, paths: readonly string[]): Promise<void> {
    const read = async (path: string) => [path, await this.connection.sendRequest<FileAnswer>(READ_FILE, { drawing: uri, path } satisfies FileQuestion)] as const;
    try {
      const answers = await Promise.all(paths.map(read));
      // The text may have been closed meanwhile.
      if (this.texts.get(uri) !== open || this.stopped) return;
      this.guarded(() => {
        let isOther = false;
        for (const [path, { uri: address, bytes }] of answers) {
          // Links to nothing are known as such already.
          isOther ||= bytes !== null || open.files.get(path)?.isThere === true;
          open.files.set(path, { uri: address, isThere: bytes !== null });
          this.module.put(uri, path, bytes ?? undefined);
        }
        if (!isOther) return;
        this.module.renew(uri, Date.now());
        open.isDue = true;
        this.found(uri, open);
        this.readNewLinks(uri, open);
      });
    } catch (error) {
      // The connection ends, or the module has stopped: both start everything again.
      if (!this.stopped) this.send("window/logMessage", { type: 2, message: String(error) });
    }
  }

  /** Runs something of the module, which does nothing more after a fault. */
  private guarded<T>(run: () => T): T {
    if (this.stopped) throw new ResponseError(INTERNAL_ERROR, "okoshi has stopped");
    try {
      return run();
    } catch (error) {
      if (error instanceof ResponseError) throw error;
      if (typeof error === "string") throw new ResponseError(INTERNAL_ERROR, error);
      // A panic is a trap, a deep drawing an overflow of the stack; neither leaves the module in order.
      this.stopped = true;
      this.send(STOPPED, null);
      throw new ResponseError(INTERNAL_ERROR, `okoshi stopped: ${String(error)}`);
    }
  }

  private send(method: string, params: unknown): void {
    this.connection.sendNotification(method, params).catch(() => {
      // The client is gone.
    });
  }
}

const uriOf = (params: unknown): string | undefined => (params as Partial<Identified> | null)?.textDocument?.uri;

function analyseOf(options: unknown): unknown {
  return typeof options === "object" && options !== null && "analyse" in options ? options.analyse : undefined;
}
