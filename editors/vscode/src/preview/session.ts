// The preview of one drawing: connects the page, the language server and the text. Independent of the editor.

import type { State } from "../status-text";
import { readPageMessage, type Link, type Message, type Place, type Position, type Question, type Remote, type TextEdit } from "./messages";

/** How long the cursor must rest before its position is sent to the server, in milliseconds. */
export const CURSOR_PAUSE = 60;

/** What a preview needs of the editor. */
export interface Editor {
  /** Posts a message to the page. */
  post(message: Message): void;
  /** The position of the cursor in the drawing's text; null if it is elsewhere. */
  cursor(): Position | null;
  /** Shows and selects a range of the text; the panel keeps the focus. */
  show(place: Place): Promise<void>;
  /** Goes to a line and column of the text, from 1, in characters. */
  goTo(line: number, column: number): Promise<void>;
  /** Asks for a path and saves a file. */
  save(name: string, bytes: Uint8Array): Promise<void>;
  /** Changes this version of the text, as one step of its own undo; false if the text is another one by now. */
  edit(version: number, edits: readonly TextEdit[]): Promise<boolean>;
  /** Undoes or redoes the last step of the text. */
  step(back: boolean): Promise<void>;
  /** Saves the text. */
  saveText(): Promise<void>;
  /** Logs a problem. */
  log(message: string): void;
}

type Server = Pick<Remote, "open" | "model" | "place" | "form" | "change" | "try" | "cursor" | "close">;

/** How often a change is asked for again because somebody types meanwhile. */
const TRIES = 3;

/** What a page is told of a request that was not answered otherwise. */
interface Answer {
  readonly ok: boolean;
  readonly body: unknown;
}

export class Session {
  private server: Server | undefined;
  private ready = false;
  private link: Link = { state: "connecting", note: "" };
  /** The latest message of each type, for a page that is reloaded, for example in a window of its own. */
  private readonly newest = new Map<string, Message>();
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** The last change that was asked for. */
  private changing: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly drawing: string,
    private readonly editor: Editor,
  ) {}

  /** Subscribes to messages of a language server. The page stays as it is until the first one. */
  async connect(server: Server): Promise<void> {
    this.server = server;
    if (this.link.state === "lost") this.setLink({ state: "connecting", note: "" });
    try {
      await server.open();
    } catch (error) {
      if (this.server !== server) return;
      this.server = undefined;
      this.setLink({ state: "lost", note: refusal(error) });
      this.editor.log(`There is no preview of ${this.drawing}: ${String(error)}`);
      return;
    }
    if (this.server === server) this.sendCursor();
  }

  /** The language server stopped, or the text was closed. */
  disconnect(link: Link): void {
    this.server = undefined;
    this.setLink(link);
  }

  /** The drawing's file is missing. */
  gone(): void {
    this.forward({ type: "gone", drawing: this.drawing });
  }

  /** Forwards messages of the server. */
  messages(messages: readonly Message[]): void {
    if (!this.server) return;
    for (const message of messages) {
      // The server sends `gone` for texts closed in the editor. The extension reopens them if the file exists, and reports `gone` itself.
      if (message.type !== "gone") this.forward(message);
    }
    // After the messages: a page that knows of a new server before its builds would ask it for models of the last one.
    if (this.link.state !== "open" && messages.some(({ type }) => type === "build")) this.setLink({ state: "open", note: "" });
  }

  /** The cursor moved. */
  moved(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.sendCursor(), CURSOR_PAUSE);
  }

  /** Handles a message of the page. */
  async receive(data: unknown): Promise<void> {
    const message = readPageMessage(data);
    if (!message) return;
    try {
      await this.answer(message);
    } catch (error) {
      this.editor.log(`The preview's ${message.type} failed: ${String(error)}`);
    }
  }

  /** The panel was closed. */
  dispose(): void {
    clearTimeout(this.timer);
    this.send((server) => server.close());
    this.server = undefined;
    this.ready = false;
  }

  private async answer(message: NonNullable<ReturnType<typeof readPageMessage>>): Promise<void> {
    switch (message.type) {
      case "ready":
        this.ready = true;
        for (const kept of this.newest.values()) this.editor.post(kept);
        return this.setLink(this.link);
      case "want":
        return this.sendCursor();
      case "model": {
        const { address } = message;
        let bytes: Uint8Array | null = null;
        try {
          bytes = (await this.server?.model(address)) ?? null;
        } finally {
          // Always answered: the page loads one model at a time.
          if (this.ready) this.editor.post({ type: "modelBytes", address, bytes });
        }
        return;
      }
      case "pick": {
        const place = await this.server?.place(message.part);
        if (place) await this.editor.show(place);
        return;
      }
      case "ask": {
        let answer: Answer = refused("okoshi did not answer: look at its output");
        try {
          answer = await this.about(message.question);
        } finally {
          if (this.ready) this.editor.post({ type: "answer", id: message.id, ...answer });
        }
        return;
      }
      case "open":
        return this.editor.goTo(message.line, message.column);
      case "save":
        return this.editor.save(message.name, message.bytes);
      case "saveText":
        await this.changing;
        return this.editor.saveText();
    }
  }

  private async about(question: Question): Promise<Answer> {
    const { server } = this;
    if (!server) return refused("okoshi is not running");
    switch (question.what) {
      case "form": {
        const answer = await server.form(question.part);
        return "form" in answer ? { ok: true, body: answer.form } : { ok: false, body: answer.refused };
      }
      case "try": {
        const bytes = await server.try(question.change);
        return { ok: bytes !== null, body: bytes };
      }
      case "undo":
      case "redo":
        await this.editor.step(question.what === "undo");
        return { ok: true, body: {} };
      case "change": {
        const change = this.change(server, question.change);
        this.changing = change.catch(() => {});
        return change;
      }
    }
  }

  private async change(server: Server, change: object): Promise<Answer> {
    for (let attempt = 0; attempt < TRIES; attempt++) {
      const answer = await server.change(change);
      if ("refused" in answer) return { ok: false, body: answer.refused };
      const { version, edits, part, note } = answer;
      if (edits.length > 0 && !(await this.editor.edit(version, edits))) continue;
      // The text's own undo takes it back, together with whatever was typed since.
      if (edits.length > 0) this.forward({ type: "steps", drawing: this.drawing, undo: LAST_STEP, redo: LAST_STEP });
      return { ok: true, body: { part, note } };
    }
    return refused("the text changes at the moment: try again");
  }

  private sendCursor(): void {
    this.send((server) => server.cursor(this.editor.cursor()));
  }

  /** Sends the server a notification; failures are only logged. */
  private send(message: (server: Server) => Promise<void>): void {
    if (this.server) void message(this.server).catch((error: unknown) => this.editor.log(String(error)));
  }

  private forward(message: Message): void {
    // A build means that the file exists again.
    if (message.type === "build") this.newest.delete("gone");
    this.newest.delete(message.type);
    this.newest.set(message.type, message);
    if (this.ready) this.editor.post(message);
  }

  private setLink(link: Link): void {
    this.link = link;
    if (this.ready) this.editor.post({ type: "link", ...link });
  }
}

/** What the page's buttons call the text's own undo. */
const LAST_STEP = "the last step in the text";

const refused = (why: string): Answer => ({ ok: false, body: { why, choices: [] } });

/** The connection state to report to a page for a state of the server. */
export function linkFor(state: State): Link {
  switch (state.kind) {
    case "idle":
    case "starting":
    case "running":
      return { state: "connecting", note: "Starting okoshi…" };
    case "stopped":
      return { state: "lost", note: "okoshi is not running." };
    case "missing":
      return { state: "lost", note: `The program ${state.path} was not found.` };
    case "failed":
      return { state: "lost", note: state.why };
  }
}

/** The JSON-RPC error code for an unknown method. */
const METHOD_NOT_FOUND = -32601;

function refusal(error: unknown): string {
  if ((error as { code?: unknown } | null)?.code === METHOD_NOT_FOUND) return "This okoshi is too old for previews: install a newer one.";
  return `okoshi cannot show the preview: ${error instanceof Error ? error.message : String(error)}`;
}
