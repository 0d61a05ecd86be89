// The host without a server: okoshi as a module in a worker. The files of the project are in the page, so that a module that stops can be started again.

import { Messages, type FromHost, type Starter, type ToHost } from "../protocol";
import { toBase64 } from "./base64";
import { download } from "./download";
import type { Answer, Attempted, Host, Link } from "./host";
import { Replaced } from "./replaced";
import { film } from "./worker/film";
import { Calls, type Call, type Effects, type Port, type TriedModel, type Value } from "./worker/calls";

/** Why the module has to be started again, or cannot be. */
export interface Fault {
  readonly words: string;
  /** The file at which it stopped. */
  readonly path: string | null;
  /** Starts it again, where it does not do so by itself. */
  readonly again: (() => void) | null;
}

export interface WorkerEvents {
  /** A drawing's text as changes on the page made it, or as it was begun. */
  text(path: string, text: string): void;
  fault(fault: Fault): void;
  /** It takes long, and can be stopped; null when it is done. */
  slow(slow: { readonly words: string; readonly stop: () => void } | null): void;
  /** A moving picture takes long, and can be given up; null when there is none any more. */
  filming(stop: (() => void) | null): void;
  /** A person wants to share a drawing. */
  share(path: string): void;
}

/** What is there before the module has come. */
export interface ReadyMade {
  /** What is offered while there are no drawings, instead of what the module offers. */
  readonly starters: readonly Starter[];
  /** The address of a file that belongs to it. */
  at(file: string): string;
  /** Begins one of the drawings. Rejects if it cannot. */
  begin(name: string): Promise<void>;
}

interface Held {
  bytes: Uint8Array<ArrayBuffer>;
  /** The last bytes that the module read without stopping. */
  worked: Uint8Array<ArrayBuffer> | null;
}

/** So many stops within so many milliseconds are too many: then a person starts the module again. */
const MOST_STOPS = 3;
const SOON = 20_000;

/** Nothing can be dropped with a finger. */
const BRING = matchMedia("(pointer: coarse)").matches ? "Open an SVG" : "Drop an SVG here";

export class WorkerHost implements Host {
  readonly file = null;
  /** Cameras are tracked by the program. */
  readonly openCamera = null;
  readonly showsFindings = false;
  readonly jumps = false;
  readonly changes = { doing: "Changing…", done: "Changed", where: "Changes are kept here; Save writes the file" };
  readonly invitation = { heading: "A drawing that stands up and moves", toStarters: `${BRING}, or change this one.`, alone: `${BRING}.` };
  readonly save = download;
  readonly share = (drawing: string): void => this.events.share(drawing);
  private readonly files = new Map<string, Held>();
  private calls: Calls;
  private messages = new Messages();
  private begun = false;
  /** Whether drawings to start from were offered since it began. */
  private offers = false;
  private stops: readonly number[] = [];
  private handler: (message: FromHost) => void = () => {};
  private link: (state: Link, note?: string) => void = () => {};

  /** `playerPage`: the address of the page that shows a model by itself. */
  constructor(private readonly open: () => Port, private readonly events: WorkerEvents, private readonly playerPage: URL, private readonly ready: ReadyMade) {
    this.calls = this.start();
  }

  listen(handler: (message: FromHost) => void, link: (state: Link, note?: string) => void): void {
    this.handler = handler;
    this.link = link;
    link("connecting", "Loading okoshi…");
  }

  /** Gives the module all files at once, when those that the browser kept are known. If there are none, drawings to start from are offered at once, unless
   * one is on its way. */
  begin(isAwaited = false): void {
    this.begun = true;
    this.offers = false;
    const files = [...this.files].map(([path, { bytes }]) => ({ path, bytes }));
    this.calls.make({ call: "begin", files }).catch(() => {});
    if (files.length > 0 || isAwaited) return;
    // What is offered does not wait for the module.
    this.offer();
    this.handler({ type: "drawings", drawings: [] });
  }

  private offer(): void {
    this.offers = true;
    this.handler({ type: "starters", key: "", starters: this.ready.starters });
  }

  /** Puts or replaces a file. */
  put(path: string, bytes: Uint8Array<ArrayBuffer>): void {
    this.files.set(path, { bytes, worked: this.files.get(path)?.worked ?? null });
    if (this.begun) this.calls.make({ call: "put", path, bytes }).catch(() => {});
  }

  remove(path: string): void {
    this.files.delete(path);
    if (this.begun) this.calls.make({ call: "remove", path }).catch(() => {});
  }

  /** Waits until all changes that were asked for are made. */
  async settled(path: string): Promise<void> {
    await this.calls.make({ call: "text", path }).catch(() => {});
  }

  /** Asks what is known of the texts of a drawing. */
  async ask(request: unknown): Promise<Answer> {
    return answerOf(await this.calls.make({ call: "ask", json: JSON.stringify(request) }));
  }

  /** The text of a drawing with the shapes of a picture, or why there is none: words that follow the picture's name. */
  async trace(bytes: Uint8Array<ArrayBuffer>): Promise<Answer> {
    return answerOf(await this.calls.make({ call: "trace", bytes }));
  }

  /** The links of a drawing to other files. */
  async links(path: string): Promise<readonly string[]> {
    return JSON.parse(String(await this.calls.make({ call: "links", path }))) as string[];
  }

  readonly player = async (): Promise<string> => {
    const response = await fetch(this.playerPage);
    if (!response.ok) throw new Error(`its file is missing on the server, which said ${response.status}`);
    return response.text();
  };

  readonly film = async (model: string, clip: number | null, view: readonly [number, number]): Promise<Blob> => {
    const bytes = new Uint8Array(await this.model(model));
    try {
      return await film(this.open(), { bytes, clip, view }, (stop) => this.events.filming(stop));
    } finally {
      this.events.filming(null);
    }
  };

  send(message: ToHost): void {
    if (message.type === "begin") {
      this.ready.begin(message.starter).catch((error: unknown) => this.handler({ type: "unbegun", why: error instanceof Error ? error.message : String(error) }));
      return;
    }
    if (this.begun) this.calls.make({ call: "receive", json: JSON.stringify(message) }).catch(() => {});
  }

  async model(address: string): Promise<ArrayBuffer> {
    const bytes = await this.calls.make({ call: "bytes", address });
    if (!(bytes instanceof Uint8Array)) throw new Replaced();
    return bytes.buffer;
  }

  async picture(address: string): Promise<string> {
    if (this.ready.starters.some(({ picture }) => picture === address)) return this.ready.at(address);
    // Addresses of blobs would have to be given back; pictures are small.
    return `data:image/png;base64,${toBase64(new Uint8Array(await this.model(address)))}`;
  }

  readonly post = async (what: "changes" | "forms", _key: string, request: unknown): Promise<Answer> => {
    return answerOf(await this.calls.make({ call: what === "changes" ? "change" : "form", json: JSON.stringify(request) }));
  };

  readonly attempt = async (_key: string, request: unknown): Promise<Attempted | null> => {
    const tried = await this.calls.make({ call: "attempt", json: JSON.stringify(request) });
    return isTried(tried) ? { address: tried.address, bytes: tried.bytes.buffer } : null;
  };

  private start(): Calls {
    const calls: Calls = new Calls(this.open(), {
      ready: () => this.link("open"),
      failed: (why) => {
        calls.end();
        this.link("lost", "okoshi is not loaded");
        this.events.fault({ words: `okoshi could not be loaded: ${why}.`, path: null, again: () => this.restart() });
      },
      done: (call, effects) => this.done(call, effects),
      stopped: (path) => this.stopped(path),
      slow: (path) => {
        const words = path === null ? "okoshi is still working on what you did last." : `okoshi is still working on ${path}.`;
        this.events.slow({ words, stop: () => this.stopped(path, true) });
      },
    });
    return calls;
  }

  private done(call: Call, { messages, texts, refused }: Effects): void {
    this.events.slow(null);
    for (const [path, why] of refused) {
      this.setAside(path);
      this.events.fault({ words: `${path} cannot be shown: ${why}.`, path, again: null });
    }
    for (const { path, bytes } of call.call === "begin" ? call.files : call.call === "put" ? [call] : []) {
      const held = this.files.get(path);
      if (held?.bytes === bytes) held.worked = bytes;
    }
    for (const [path, text] of texts) {
      const bytes = new TextEncoder().encode(text);
      this.files.set(path, { bytes, worked: bytes });
      this.events.text(path, text);
    }
    for (const json of messages) {
      const message = this.messages.read(JSON.parse(json));
      // A module that is started anew begins with everything.
      if (message === "missed") return this.restart();
      if (message?.type === "starters") {
        // What was offered before the module had come may have been chosen meanwhile.
        if (call.call !== "begin" || !this.offers) this.offer();
      } else if (message) this.handler(message);
    }
  }

  /** Takes the text of a file before the one that did not work; `false` if there is none, so that the file is left out. */
  private setAside(path: string): boolean {
    const held = this.files.get(path);
    if (held?.worked && held.worked !== held.bytes) {
      held.bytes = held.worked;
      return true;
    }
    this.files.delete(path);
    return false;
  }

  private stopped(path: string | null, byPerson = false): void {
    this.events.slow(null);
    let words = `${byPerson ? "You stopped okoshi" : "okoshi stopped at a fault of its own"}. What you did last was not done; everything else is as it was.`;
    if (path !== null) {
      words = byPerson ? `You stopped okoshi while it read ${path}. ` : `okoshi stopped while it read ${path}: that is a fault of okoshi. `;
      words += this.setAside(path) ? `It shows ${path} as it was before.` : "It does not show this file; nothing in it was changed.";
    }
    const now = Date.now();
    this.stops = [...this.stops.filter((time) => now - time < SOON), now];
    // A file that was set aside does not stop it again.
    const again = path !== null || this.stops.length < MOST_STOPS;
    if (again) this.restart();
    else {
      this.calls.end();
      this.link("lost", "okoshi has stopped");
    }
    this.events.fault({ words, path, again: again ? null : () => this.restart() });
  }

  private restart(): void {
    this.calls.end();
    this.link("connecting", "Starting okoshi again…");
    this.messages = new Messages();
    this.calls = this.start();
    if (this.begun) this.begin();
  }
}

function answerOf(json: Value): Answer {
  const { ok, body } = JSON.parse(String(json)) as { ok?: unknown; body?: unknown };
  return { ok: ok === true, body };
}

const isTried = (value: Value): value is TriedModel => typeof value === "object" && "address" in value;
