// What the page asks of the worker, one call at a time: so it is known what the module did when it stopped, and a newer text replaces one that still waits.

/** A file of the project, by its path relative to the project's folder. */
export interface ProjectFile {
  readonly path: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

export type Call =
  /** The first call: all files at once, so that the page learns of all drawings at once, and what to start from. */
  | { readonly call: "begin"; readonly files: readonly ProjectFile[] }
  | ({ readonly call: "put" } & ProjectFile)
  | { readonly call: "remove" | "text" | "links"; readonly path: string }
  | { readonly call: "receive" | "change" | "form" | "attempt" | "ask"; readonly json: string }
  | { readonly call: "bytes"; readonly address: string }
  | { readonly call: "trace"; readonly bytes: Uint8Array<ArrayBuffer> }
  | { readonly call: "film"; readonly bytes: Uint8Array<ArrayBuffer>; readonly clip: number | null; readonly view: readonly [left: number, up: number] };

/** A model that was tried. */
export interface TriedModel {
  readonly address: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

/** What calls return: an answer as JSON, a text, bytes, a model, or why there is no film; undefined for nothing. */
export type Value = string | Uint8Array<ArrayBuffer> | TriedModel | undefined;

/** What came of a call beside its value. */
export interface Effects {
  /** Messages for the page, as JSON. */
  readonly messages: readonly string[];
  /** The drawings whose texts it changed. */
  readonly texts: readonly (readonly [path: string, text: string])[];
  /** The files that were not taken, and why, as sentences without their full stops. */
  readonly refused: readonly (readonly [path: string, why: string])[];
}

export type FromWorker =
  | { readonly type: "ready" }
  /** A file is being read; null when it was. */
  | { readonly type: "reading"; readonly path: string | null }
  /** The module could not be loaded. */
  | { readonly type: "failed"; readonly why: string }
  | ({ readonly type: "done"; readonly value: Value } & Effects)
  /** The module stopped; it does nothing more. */
  | { readonly type: "stopped" };

export interface Events {
  ready(): void;
  /** The module could not be loaded. */
  failed(why: string): void;
  done(call: Call, effects: Effects): void;
  /** The module stopped, perhaps while it read a file. */
  stopped(path: string | null): void;
  /** A call takes long, perhaps because of a file. */
  slow(path: string | null): void;
}

/** What takes longer can be stopped by a person, in milliseconds. */
const LONG = 10_000;

/** What of a `Worker` is needed. */
export interface Port {
  postMessage(call: Call): void;
  terminate(): void;
  addEventListener(type: "message", listener: (event: { readonly data: FromWorker }) => void): void;
  addEventListener(type: "error", listener: (event: { readonly message?: string }) => void): void;
}

interface Waiting {
  call: Call;
  readonly resolve: ((value: Value) => void)[];
  readonly reject: ((error: Error) => void)[];
}

/** The calls of one worker. */
export class Calls {
  private readonly waiting: Waiting[] = [];
  private current: Waiting | null = null;
  private isReady = false;
  /** The file that is being read. */
  private reading: string | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly port: Port, private readonly events: Events, private readonly long = LONG) {
    port.addEventListener("message", ({ data }) => this.receive(data));
    // A script that cannot be loaded, or that runs out of memory.
    port.addEventListener("error", ({ message }) => this.broken(message || "its script could not be loaded"));
  }

  make(call: Call): Promise<Value> {
    return new Promise((resolve, reject) => {
      const same = call.call === "put" ? this.lastPut(call.path) : undefined;
      if (same) {
        same.call = call;
        same.resolve.push(resolve);
        same.reject.push(reject);
      } else {
        this.waiting.push({ call, resolve: [resolve], reject: [reject] });
      }
      this.next();
    });
  }

  /** Ends the worker, and whatever it was asked. */
  end(): void {
    this.port.terminate();
    const all = [...(this.current ? [this.current] : []), ...this.waiting.splice(0)];
    this.current = null;
    this.isReady = false;
    clearTimeout(this.timer);
    for (const { reject } of all) for (const one of reject) one(new Error("okoshi was started again meanwhile"));
  }

  /** A put of the same file that still waits, with nothing but other puts behind it. */
  private lastPut(path: string): Waiting | undefined {
    for (const one of this.waiting.toReversed()) {
      if (one.call.call !== "put") return undefined;
      if (one.call.path === path) return one;
    }
    return undefined;
  }

  private next(): void {
    if (!this.isReady || this.current) return;
    this.current = this.waiting.shift() ?? null;
    if (!this.current) return;
    const { call } = this.current;
    this.reading = null;
    this.port.postMessage(call);
    this.timer = setTimeout(() => this.events.slow(this.reading), this.long);
  }

  private receive(data: FromWorker): void {
    switch (data.type) {
      case "ready":
        this.isReady = true;
        this.events.ready();
        return this.next();
      case "failed":
        return this.events.failed(data.why);
      case "reading":
        this.reading = data.path;
        return;
      case "done": {
        const { current } = this;
        if (!current) return;
        this.current = null;
        clearTimeout(this.timer);
        this.events.done(current.call, data);
        for (const resolve of current.resolve) resolve(data.value);
        return this.next();
      }
      case "stopped":
        if (this.current) this.events.stopped(this.reading);
    }
  }

  private broken(why: string): void {
    if (this.current) this.events.stopped(this.reading);
    else this.events.failed(why);
  }
}
