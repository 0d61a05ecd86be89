// What the preview's page, this extension and the language server say to each other. Knows nothing of the editor.
// News of the server goes to the page as it is; only what the extension itself acts on is read here.

/** A position as the Language Server Protocol has it: line and UTF-16 unit, from 0. */
export interface Position {
  readonly line: number;
  readonly character: number;
}

/** Where something is written. */
export interface Place {
  readonly uri: string;
  readonly range: { readonly start: Position; readonly end: Position };
}

/** A message for the page: an object with a type, and whatever else belongs to it. */
export interface Message {
  readonly type: string;
  readonly [field: string]: unknown;
}

/** How the language server is, for the page. The note says it in words; an empty one leaves the words to the page. */
export interface Link {
  readonly state: "connecting" | "open" | "lost";
  readonly note: string;
}

/** What the page asks of the extension. */
export type FromPage =
  | { readonly type: "ready" | "want" }
  | { readonly type: "model"; readonly address: string }
  | { readonly type: "pick"; readonly part: string }
  /** Line and column from 1, in characters. */
  | { readonly type: "open"; readonly line: number; readonly column: number }
  | { readonly type: "save"; readonly name: string; readonly bytes: Uint8Array };

/** The request that `data` is, or nothing if it is none that the extension knows. */
export function fromPage(data: unknown): FromPage | undefined {
  const { type, address, part, line, column, name, bytes } = fields(data);
  switch (type) {
    case "ready":
    case "want":
      return { type };
    case "model":
      return typeof address === "string" ? { type, address } : undefined;
    case "pick":
      return typeof part === "string" ? { type, part } : undefined;
    case "open":
      return isCount(line) && isCount(column) ? { type, line, column } : undefined;
    case "save":
      return typeof name === "string" && typeof bytes === "string" ? { type, name: fileName(name), bytes: decoded(bytes) } : undefined;
    default:
      return undefined;
  }
}

/** The notification that carries news of a drawing. */
export const NEWS = "okoshi/preview/news";

/** What `NEWS` carries; nothing if it is not that. */
export function news(data: unknown): { uri: string; messages: Message[] } | undefined {
  const { textDocument, messages } = fields(data);
  const { uri } = fields(textDocument);
  if (typeof uri !== "string" || !Array.isArray(messages)) return undefined;
  return { uri, messages: messages.filter((one): one is Message => typeof fields(one)["type"] === "string") };
}

/** The connection to a language server: a client of the library, or its plain JSON-RPC. */
export interface Connection {
  sendRequest(method: string, params: unknown): Promise<unknown>;
  sendNotification(method: string, params: unknown): Promise<void>;
}

/** What the language server does for the preview of one drawing. */
export class Remote {
  constructor(
    private readonly connection: Connection,
    /** The drawing's URI, as the server knows it. */
    private readonly uri: string,
  ) {}

  /** From now on there is news of the drawing. */
  async open(): Promise<void> {
    await this.connection.sendRequest("okoshi/preview/open", this.drawing());
  }

  /** The bytes of a model, or null if the server has it no more. */
  async model(address: string): Promise<Uint8Array | null> {
    const { bytes } = fields(await this.connection.sendRequest("okoshi/preview/model", { address }));
    return typeof bytes === "string" ? decoded(bytes) : null;
  }

  /** Where the string of a part is. */
  async place(part: string): Promise<Place | null> {
    return (await this.connection.sendRequest("okoshi/preview/place", { ...this.drawing(), part })) as Place | null;
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

/**
 * The UTF-16 unit, from 0, of a column that counts characters from 1; the line's end if it has fewer.
 */
export function unitOf(line: string, column: number): number {
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

/** Without folders: where a file is written is for the person to say. */
function fileName(name: string): string {
  return name.replace(/^.*[\\/]/, "").replace(/\p{Cc}/gu, "") || "model";
}

/** Bytes of their own: the editor does not post a `Buffer` as bytes, nor a part of a larger one. */
function decoded(base64: string): Uint8Array {
  return Uint8Array.from(Buffer.from(base64, "base64"));
}
