// The preview of one drawing: goes between the page, the language server and the text. Knows nothing of the editor.

import type { State } from "../status-text";
import { fromPage, type Link, type Message, type Place, type Position, type Remote } from "./wire";

/** How long the cursor must have stood still before the server hears of it, in milliseconds. */
export const CURSOR_PAUSE = 60;

/** The editor, as a preview needs it. */
export interface Surroundings {
  /** Posts something to the page. */
  post(message: Message): void;
  /** Where the cursor is in the drawing's text; null if it is in another text, or in none. */
  cursor(): Position | null;
  /** Shows and selects a place in the text; the panel keeps the keyboard. */
  show(place: Place): Promise<void>;
  /** Goes to a line and column of the text, from 1, in characters. */
  goTo(line: number, column: number): Promise<void>;
  /** Asks where to write a file, and writes it. */
  save(name: string, bytes: Uint8Array): Promise<void>;
  /** Says what went wrong. */
  log(message: string): void;
}

type Server = Pick<Remote, "open" | "model" | "place" | "cursor" | "close">;

export class Session {
  private server: Server | undefined;
  private ready = false;
  private link: Link = { state: "connecting", note: "" };
  /** The newest message of each type: a page that is loaded anew, as in a window of its own, is told all of them. */
  private readonly newest = new Map<string, Message>();
  private timer: NodeJS.Timeout | undefined;

  constructor(
    private readonly drawing: string,
    private readonly around: Surroundings,
  ) {}

  /** Asks a language server for news. What was shown stays until there is some. */
  async connect(server: Server): Promise<void> {
    this.server = server;
    if (this.link.state === "lost") this.become({ state: "connecting", note: "" });
    try {
      await server.open();
    } catch (error) {
      if (this.server !== server) return;
      this.server = undefined;
      this.become({ state: "lost", note: refusal(error) });
      this.around.log(`There is no news of ${this.drawing}: ${String(error)}`);
      return;
    }
    if (this.server === server) this.lightUp();
  }

  /** The language server is away, or the text is. */
  disconnect(link: Link): void {
    this.server = undefined;
    this.become(link);
  }

  /** The drawing's file is not there. */
  gone(): void {
    this.tell({ type: "gone", drawing: this.drawing });
  }

  /** News from the server. */
  news(messages: readonly Message[]): void {
    if (!this.server) return;
    for (const message of messages) {
      // The server says this of a text that is closed in the editor. It is opened again if its file is there, which `gone` tells.
      if (message.type !== "gone") this.tell(message);
    }
    // After the news: a page that is told of a new server before its builds would ask that one for models of the last.
    if (this.link.state !== "open" && messages.some(({ type }) => type === "build")) this.become({ state: "open", note: "" });
  }

  /** The cursor moved. */
  moved(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.lightUp(), CURSOR_PAUSE);
  }

  /** The page has spoken. */
  async hear(data: unknown): Promise<void> {
    const message = fromPage(data);
    if (!message) return;
    try {
      await this.answer(message);
    } catch (error) {
      this.around.log(`The preview's ${message.type} failed: ${String(error)}`);
    }
  }

  /** The panel was closed. */
  dispose(): void {
    clearTimeout(this.timer);
    this.notify((server) => server.close());
    this.server = undefined;
    this.ready = false;
  }

  private async answer(message: NonNullable<ReturnType<typeof fromPage>>): Promise<void> {
    switch (message.type) {
      case "ready":
        this.ready = true;
        for (const kept of this.newest.values()) this.around.post(kept);
        return this.become(this.link);
      case "want":
        return this.lightUp();
      case "model": {
        const { address } = message;
        let bytes: Uint8Array | null = null;
        try {
          bytes = (await this.server?.model(address)) ?? null;
        } finally {
          // An answer in any case: the page reads one model at a time.
          if (this.ready) this.around.post({ type: "modelBytes", address, bytes });
        }
        return;
      }
      case "pick": {
        const place = await this.server?.place(message.part);
        if (place) await this.around.show(place);
        return;
      }
      case "open":
        return this.around.goTo(message.line, message.column);
      case "save":
        return this.around.save(message.name, message.bytes);
    }
  }

  private lightUp(): void {
    this.notify((server) => server.cursor(this.around.cursor()));
  }

  /** Tells the server something, which it need not answer and may have ended without. */
  private notify(tell: (server: Server) => Promise<void>): void {
    if (this.server) void tell(this.server).catch((error: unknown) => this.around.log(String(error)));
  }

  private tell(message: Message): void {
    // A build says that the file is there again.
    if (message.type === "build") this.newest.delete("gone");
    this.newest.delete(message.type);
    this.newest.set(message.type, message);
    if (this.ready) this.around.post(message);
  }

  private become(link: Link): void {
    this.link = link;
    if (this.ready) this.around.post({ type: "link", ...link });
  }
}

/** What a page is told while the server is in a state. */
export function linkWhile(state: State): Link {
  switch (state.kind) {
    case "idle":
    case "starting":
    case "running":
      return { state: "connecting", note: "Starting okoshi…" };
    case "stopped":
      return { state: "lost", note: "okoshi is not running at present." };
    case "missing":
      return { state: "lost", note: `The program ${state.path} was not found.` };
    case "failed":
      return { state: "lost", note: state.why };
  }
}

/** JSON-RPC's code of a request that the server does not know. */
const METHOD_NOT_FOUND = -32601;

function refusal(error: unknown): string {
  if ((error as { code?: unknown } | null)?.code === METHOD_NOT_FOUND) return "This okoshi is too old for previews: install a newer one.";
  return `okoshi shows no preview: ${error instanceof Error ? error.message : String(error)}`;
}
