// The messages between the preview page, this extension and the language server. Independent of the editor. The server's messages
// are forwarded to the page unchanged; only those for the extension itself are parsed here.

/** A position in the Language Server Protocol: line and UTF-16 offset, from 0. */
export interface Position {
  readonly line: number;
  readonly character: number;
}

/** A range in a document. */
export interface Place {
  readonly uri: string;
  readonly range: { readonly start: Position; readonly end: Position };
}

/** A message for the page: an object with a type and further fields. */
export interface Message {
  readonly type: string;
  readonly [field: string]: unknown;
}

/** The state of the connection to the language server. The note explains it; if it is empty, the page uses its own text. */
export interface Link {
  readonly state: "connecting" | "open" | "lost";
  readonly note: string;
}

/** A request from the page. */
export type PageMessage =
  /** `saveText`: the text of the drawing is to be saved, with the changes that were asked for before. */
  | { readonly type: "ready" | "want" | "saveText" }
  | { readonly type: "model"; readonly address: string }
  | { readonly type: "pick"; readonly part: string }
  /** What can be changed about a part, a change of the drawing, or what one would look like; answered by its number. */
  | { readonly type: "ask"; readonly id: number; readonly question: Question }
  /** Line and column from 1, in characters. */
  | { readonly type: "open"; readonly line: number; readonly column: number }
  | { readonly type: "save"; readonly name: string; readonly bytes: Uint8Array };

/** A question about changes. Changes themselves are passed on as they are. */
export type Question = { readonly what: "form"; readonly part: string } | { readonly what: "change" | "try"; readonly change: object } | { readonly what: "undo" | "redo" };

function readQuestion(what: unknown, request: unknown): Question | undefined {
  const { part, change, do: action } = fields(request);
  if (what === "forms") return typeof part === "string" ? { what: "form", part } : undefined;
  if (what === "tries") return typeof change === "object" && change !== null ? { what: "try", change } : undefined;
  if (what !== "changes") return undefined;
  if (action === "undo" || action === "redo") return { what: action };
  // Both are decided in the text as it is: the panel shows it, or the question has told of it.
  const { make, choose } = fields(action);
  const made = make ?? choose;
  return typeof made === "object" && made !== null ? { what: "change", change: made } : undefined;
}

/** Parses a request; undefined if its type is unknown or a field is invalid. */
export function readPageMessage(data: unknown): PageMessage | undefined {
  const { type, address, part, line, column, name, bytes, id, what, request } = fields(data);
  switch (type) {
    case "ready":
    case "want":
    case "saveText":
      return { type };
    case "model":
      return typeof address === "string" ? { type, address } : undefined;
    case "pick":
      return typeof part === "string" ? { type, part } : undefined;
    case "ask": {
      const question = readQuestion(what, request);
      return isCount(id) && question ? { type, id, question } : undefined;
    }
    case "open":
      return isCount(line) && isCount(column) ? { type, line, column } : undefined;
    case "save":
      return typeof name === "string" && typeof bytes === "string" ? { type, name: fileName(name), bytes: decoded(bytes) } : undefined;
    default:
      return undefined;
  }
}

/** The notification with messages for a drawing's page. */
export const PREVIEW_NOTIFICATION = "okoshi/preview/news";

/** Parses the parameters of the notification. */
export function readNotification(data: unknown): { uri: string; messages: Message[] } | undefined {
  const { textDocument, messages } = fields(data);
  const { uri } = fields(textDocument);
  if (typeof uri !== "string" || !Array.isArray(messages)) return undefined;
  return { uri, messages: messages.filter((one): one is Message => typeof fields(one)["type"] === "string") };
}

/** An edit of a text in the protocol. */
export interface TextEdit {
  readonly range: Place["range"];
  readonly newText: string;
}

/** The edits that make a change in a version of the text, or why it is not made. */
export type Changed =
  | { readonly version: number; readonly edits: readonly TextEdit[]; readonly part: string | null; readonly note: string | null }
  | { readonly refused: object };

/** The connection to a language server: a client of the library, or plain JSON-RPC. */
export interface Connection {
  sendRequest(method: string, params: unknown): Promise<unknown>;
  sendNotification(method: string, params: unknown): Promise<void>;
}

/** The language server's requests for the preview of one drawing. */
export class Remote {
  constructor(
    private readonly connection: Connection,
    /** The drawing's URI in the protocol. */
    private readonly uri: string,
  ) {}

  /** Subscribes to messages about the drawing. */
  async open(): Promise<void> {
    await this.connection.sendRequest("okoshi/preview/open", this.drawing());
  }

  /** The bytes of a model, or null if the server does not have it any more. */
  async model(address: string): Promise<Uint8Array | null> {
    return bytesOf(await this.connection.sendRequest("okoshi/preview/model", { address }));
  }

  /** The range of a part's string. */
  async place(part: string): Promise<Place | null> {
    return (await this.connection.sendRequest("okoshi/preview/place", { ...this.drawing(), part })) as Place | null;
  }

  /** What can be changed about a part, as the page reads it. */
  async form(part: string): Promise<{ form: object } | { refused: object }> {
    return (await this.connection.sendRequest("okoshi/preview/form", { ...this.drawing(), part })) as { form: object } | { refused: object };
  }

  async change(change: object): Promise<Changed> {
    return (await this.connection.sendRequest("okoshi/preview/change", { ...this.drawing(), change })) as Changed;
  }

  /** The model that a change would make; null if it would be refused. */
  async try(change: object): Promise<Uint8Array | null> {
    return bytesOf(await this.connection.sendRequest("okoshi/preview/try", { ...this.drawing(), change }));
  }

  cursor(position: Position | null): Promise<void> {
    return this.connection.sendNotification("okoshi/preview/cursor", { ...this.drawing(), position });
  }

  close(): Promise<void> {
    return this.connection.sendNotification("okoshi/preview/close", this.drawing());
  }

  private drawing(): { textDocument: { uri: string } } {
    return { textDocument: { uri: this.uri } };
  }
}

/** The UTF-16 offset, from 0, of a column in characters, from 1; at most the end of the line. */
export function utf16Offset(line: string, column: number): number {
  let units = 0;
  let left = column - 1;
  for (const character of line) {
    if (left-- <= 0) break;
    units += character.length;
  }
  return units;
}

function fields(data: unknown): Readonly<Record<string, unknown>> {
  return typeof data === "object" && data !== null ? (data as Record<string, unknown>) : {};
}

function isCount(value: unknown): value is number {
  return typeof value === "number" && Number.isSafeInteger(value) && value >= 1;
}

/** Without folders: the user chooses where to save a file. */
function fileName(name: string): string {
  return name.replace(/^.*[\\/]/, "").replace(/\p{Cc}/gu, "") || "model";
}

/** The bytes of an answer: in Base64 from a program, as such from a worker. */
function bytesOf(answer: unknown): Uint8Array | null {
  const { bytes } = fields(answer);
  if (bytes instanceof Uint8Array) return bytes;
  return typeof bytes === "string" ? decoded(bytes) : null;
}

function decoded(base64: string): Uint8Array {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
}
