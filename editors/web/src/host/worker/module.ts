// The script of the worker: loads the module and makes its calls.

import init, { film, Studio, trace } from "./okoshi_web.js";
import type { Call, FromWorker, ProjectFile, Value } from "./calls";

/** The drawings whose texts the page has. */
const known = new Set<string>();
/** The files that this call was not to take, and why. */
let refused: (readonly [path: string, why: string])[] = [];

// Streamed: it is compiled while it arrives.
const loaded = init({ module_or_path: new URL("okoshi_web_bg.wasm", import.meta.url) }).then(() => new Studio());
loaded.then(
  () => say({ type: "ready" }),
  (error: unknown) => say({ type: "failed", why: error instanceof WebAssembly.CompileError ? "this browser is too old for it" : error instanceof Error ? error.message : String(error) }),
);

addEventListener("message", ({ data }: MessageEvent<Call>) => void loaded.then((studio) => answer(studio, data), () => {}));

function answer(studio: Studio, call: Call): void {
  refused = [];
  try {
    const value = make(studio, call);
    const messages = studio.messages();
    const texts = changed(call, messages).flatMap((path) => {
      const text = studio.text(path);
      return text === undefined ? [] : [[path, text] as const];
    });
    const bytes = typeof value === "object" ? ("bytes" in value ? value.bytes : value) : undefined;
    say({ type: "done", value, messages, texts, refused }, bytes ? [bytes.buffer] : []);
  } catch (error) {
    // A panic is a trap, a deep drawing an overflow of the stack; neither leaves the module in order.
    console.warn(error);
    say({ type: "stopped" });
  }
}

function make(studio: Studio, call: Call): Value {
  const now = Date.now();
  switch (call.call) {
    case "begin":
      // What drawings link to comes before them.
      for (const drawings of [false, true]) for (const file of call.files) if (isDrawing(file.path) === drawings) put(studio, file, now);
      studio.offer();
      return undefined;
    case "put":
      put(studio, call, now);
      return undefined;
    case "remove":
      known.delete(call.path);
      studio.remove(call.path, now);
      studio.offer();
      return undefined;
    case "text":
      return studio.text(call.path);
    case "links":
      return JSON.stringify(studio.links(call.path));
    case "receive":
      studio.receive(call.json, now);
      return undefined;
    case "change":
      return studio.change(call.json, now);
    case "form":
      return studio.form(call.json);
    case "film":
      return filmed(call);
    case "trace":
      return traced(call.bytes);
    case "ask":
      return studio.ask(call.json);
    case "bytes":
      return studio.bytes(call.address) as Uint8Array<ArrayBuffer> | undefined;
    case "attempt": {
      const tried = studio.attempt(call.json);
      if (!tried) return undefined;
      const { address, bytes } = tried;
      tried.free();
      return { address, bytes: bytes as Uint8Array<ArrayBuffer> };
    }
  }
}

/** A moving picture, or why there is none, as a sentence without its full stop. */
function filmed({ bytes, clip, view: [left, up] }: Extract<Call, { readonly call: "film" }>): Value {
  try {
    return film(bytes, clip ?? undefined, left, up) as Uint8Array<ArrayBuffer>;
  } catch (why) {
    if (typeof why !== "string") throw why;
    return why;
  }
}

/** A drawing of a picture, or why there is none, as the answer to a request. */
function traced(bytes: Uint8Array): string {
  try {
    return JSON.stringify({ ok: true, body: trace(bytes) });
  } catch (why) {
    if (typeof why !== "string") throw why;
    return JSON.stringify({ ok: false, body: why });
  }
}

function put(studio: Studio, { path, bytes }: ProjectFile, now: number): void {
  say({ type: "reading", path });
  if (isDrawing(path)) known.add(path);
  try {
    studio.put(path, bytes, now);
  } catch (why) {
    if (typeof why !== "string") throw why;
    refused.push([path, why]);
  }
  say({ type: "reading", path: null });
}

const isDrawing = (path: string): boolean => /\.svg$/i.test(path);

/** The drawings whose texts a call may have changed: the one that a change is about, and one that was begun. */
function changed({ call, ...rest }: Call, messages: readonly string[]): readonly string[] {
  if (call === "change" && "json" in rest) return [(JSON.parse(rest.json) as { drawing: string }).drawing];
  if (call !== "receive") return [];
  const listed = messages.flatMap((message) => {
    const { type, drawings } = JSON.parse(message) as { type: string; drawings?: readonly { id: string }[] };
    return type === "drawings" ? (drawings ?? []).map(({ id }) => id) : [];
  });
  const begun = [...new Set(listed)].filter((id) => !known.has(id));
  for (const id of begun) known.add(id);
  return begun;
}

function say(message: FromWorker, transfer: Transferable[] = []): void {
  postMessage(message, { transfer });
}
