// The preview of a drawing, with a simulated page and language server: the server speaks JSON-RPC over streams.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { PassThrough } from "node:stream";
import { test, type TestContext } from "node:test";
import { createMessageConnection, StreamMessageReader, StreamMessageWriter, type MessageConnection } from "vscode-jsonrpc/node";
import { html } from "../src/preview/page";
import { CURSOR_PAUSE, linkFor, Session } from "../src/preview/session";
import { readPageMessage, PREVIEW_NOTIFICATION, readNotification, Remote, utf16Offset, type Message, type Place, type Position } from "../src/preview/messages";

const DRAWING = "file:///a/figure.svg";
const textDocument = { uri: DRAWING };
const arm: Place = { uri: DRAWING, range: { start: { line: 3, character: 8 }, end: { line: 3, character: 20 } } };
const drawings: Message = { type: "drawings", drawings: [{ id: DRAWING, name: "figure.svg", folder: "" }] };
const build = (revision: number): Message => ({ type: "build", drawing: DRAWING, build: { revision, model: `builds/${revision}.glb`, originals: `builds/${revision}.originals.glb`, clips: [{ name: "kick" }] } });
const edit = { range: arm.range, newText: "9" };
const light = (part: string | null): Message => ({ type: "light", drawing: DRAWING, part });

/** A server with one drawing with one part, Arm, the models 1 and 2, and the full clips of both. It records what it receives. */
function fakeServer(t: TestContext, knowsPreviews = true) {
  const [there, back] = [new PassThrough(), new PassThrough()];
  const server = createMessageConnection(new StreamMessageReader(there), new StreamMessageWriter(back));
  const client = createMessageConnection(new StreamMessageReader(back), new StreamMessageWriter(there));
  const told: unknown[] = [];
  const versions: number[] = [];
  if (knowsPreviews) {
    server.onRequest("okoshi/preview/open", (params: unknown) => {
      told.push({ open: params });
      return null;
    });
    server.onRequest("okoshi/preview/model", ({ address }: { address: string }) => {
      const found = /^builds\/([12](?:\.originals)?)\.glb$/.exec(address);
      return found ? { bytes: Buffer.from(`glTF ${found[1]}`).toString("base64") } : null;
    });
    server.onRequest("okoshi/preview/form", ({ part }: { part: string }): unknown => (part === "Arm" ? { form: { part } } : { refused: { why: `there is no part ${part}`, choices: [] } }));
    server.onRequest("okoshi/preview/change", ({ change }: { change: { value?: string } }): unknown => {
      told.push({ change });
      return change.value === "wrong" ? { refused: { why: "no", choices: [] } } : { version: versions.shift() ?? 7, edits: change.value === "same" ? [] : [edit], part: "Arm", note: null };
    });
    server.onRequest("okoshi/preview/try", ({ change }: { change: { value?: string } }): unknown => (change.value === "wrong" ? null : { bytes: Buffer.from("glTF tried").toString("base64") }));
    server.onRequest("okoshi/preview/place", ({ part }: { part: string }) => (part === "Arm" ? arm : null));
    server.onNotification("okoshi/preview/cursor", (params: unknown) => void told.push({ cursor: params }));
    server.onNotification("okoshi/preview/close", (params: unknown) => void told.push({ close: params }));
  }
  server.listen();
  client.listen();
  const end = () => {
    server.dispose();
    client.dispose();
  };
  t.after(end);
  /** Sends messages, and waits until they have arrived. */
  const sends = async (...messages: Message[]) => {
    await server.sendNotification(PREVIEW_NOTIFICATION, { textDocument, messages });
    await client.sendRequest("okoshi/preview/model", { address: "" });
  };
  return { server, client, told, versions, end, sends };
}

/** A preview of the drawing with a simulated page and text. */
function preview() {
  const posted: Message[] = [];
  const done: unknown[] = [];
  const logged: string[] = [];
  let cursor: Position | null = null;
  const session = new Session(DRAWING, {
    post: (message) => void posted.push(message),
    cursor: () => cursor,
    show: async (place) => void done.push({ show: place }),
    goTo: async (line, column) => void done.push({ goTo: [line, column] }),
    save: async (name, bytes) => void done.push({ save: [name, Buffer.from(bytes).toString()] }),
    saveText: async () => void done.push("saved"),
    edit: async (version, edits) => {
      done.push({ edit: [version, edits] });
      return version === 7;
    },
    step: async (back) => void done.push({ step: back }),
    log: (message) => void logged.push(message),
  });
  const connect = async (client: MessageConnection) => {
    client.onNotification(PREVIEW_NOTIFICATION, (params: unknown) => session.messages(readNotification(params)?.messages ?? []));
    await session.connect(new Remote(client, DRAWING));
  };
  const set = (position: Position | null) => {
    cursor = position;
    session.moved();
  };
  /** What was posted since the last call. */
  const fresh = () => posted.splice(0);
  return { session, posted, done, logged, connect, set, fresh };
}

/** Waits until something holds; the limit only ends a test that hangs. */
async function until(probe: () => boolean): Promise<void> {
  const end = Date.now() + 60_000;
  while (!probe()) {
    assert.ok(Date.now() < end, `waited in vain: ${String(probe)}`);
    await new Promise((resolve) => setImmediate(resolve));
  }
}

const open = { type: "link", state: "open", note: "" };

test("the page gets the server's messages unchanged, once it is ready", async (t) => {
  const { client, told, sends } = fakeServer(t);
  const { session, posted, fresh, connect } = preview();
  await connect(client);
  assert.deepEqual(told[0], { open: { textDocument } });
  await sends(drawings, build(1), { type: "something new", drawing: DRAWING });
  await sends(build(2), light("Arm"));
  assert.deepEqual(posted, []);
  await session.receive({ type: "ready" });
  assert.deepEqual(fresh(), [drawings, { type: "something new", drawing: DRAWING }, build(2), light("Arm"), open]);
  await sends(light(null));
  assert.deepEqual(fresh(), [light(null)]);
  // A page that is moved to its own window reloads.
  await session.receive({ type: "ready" });
  assert.deepEqual(fresh().filter(({ type }) => type === "build" || type === "light"), [build(2), light(null)]);
});

test("changes are made in the text, which undoes them", async (t) => {
  const { client, told, versions } = fakeServer(t);
  const { session, fresh, connect, done } = preview();
  await session.receive({ type: "ready" });
  await connect(client);
  fresh();
  const ask = async (id: number, what: string, request: unknown): Promise<Message[]> => {
    await session.receive({ type: "ask", id, what, request });
    return fresh();
  };
  const answer = (id: number, ok: boolean, body: unknown): Message => ({ type: "answer", id, ok, body });
  assert.deepEqual(await ask(1, "forms", { drawing: DRAWING, part: "Arm" }), [answer(1, true, { part: "Arm" })]);
  assert.deepEqual(await ask(2, "forms", { drawing: DRAWING, part: "Leg" }), [answer(2, false, { why: "there is no part Leg", choices: [] })]);
  const change = (value: string) => ({ change: "set", part: "Arm", attribute: "Offset", value });
  const steps: Message = { type: "steps", drawing: DRAWING, undo: "the last step in the text", redo: "the last step in the text" };
  const made = { part: "Arm", note: null };
  assert.deepEqual(await ask(3, "changes", { do: { make: change("9") } }), [steps, answer(3, true, made)]);
  assert.deepEqual(told.at(-1), { change: change("9") });
  assert.deepEqual(done.splice(0), [{ edit: [7, [edit]] }]);
  // The edits of another version of the text are not made; they are asked for again.
  versions.push(6);
  assert.deepEqual(await ask(4, "changes", { do: { make: change("9") } }), [steps, answer(4, true, made)]);
  assert.deepEqual(done.splice(0), [{ edit: [6, [edit]] }, { edit: [7, [edit]] }]);
  versions.push(4, 5, 6);
  const [late, ...more] = await ask(5, "changes", { do: { make: change("9") } });
  assert.deepEqual([late?.["ok"], more], [false, []]);
  done.splice(0);
  assert.deepEqual(await ask(6, "changes", { do: { make: change("same") } }), [answer(6, true, made)]);
  assert.deepEqual(await ask(7, "changes", { do: { make: change("wrong") } }), [answer(7, false, { why: "no", choices: [] })]);
  // What a refusal offers.
  assert.deepEqual(await ask(16, "changes", { do: { choose: change("same") } }), [answer(16, true, made)]);
  assert.deepEqual(done, []);
  await ask(8, "changes", { do: "undo" });
  await ask(9, "changes", { do: "redo" });
  assert.deepEqual(done, [{ step: true }, { step: false }]);
  done.splice(0);
  // What is still asked for when the text is saved is saved with it.
  const asked = ask(13, "changes", { do: { make: change("9") } });
  await session.receive({ type: "saveText" });
  assert.deepEqual(done, [{ edit: [7, [edit]] }, "saved"]);
  await asked;
  const [tried] = await ask(10, "tries", { change: change("9") });
  assert.equal(Buffer.from(tried?.["body"] as Uint8Array).toString(), "glTF tried");
  assert.deepEqual(await ask(11, "tries", { change: change("wrong") }), [answer(11, false, null)]);
  // What is no question is not answered.
  for (const [what, request] of [["forms", {}], ["changes", { do: "everything" }], ["nothing", { part: "Arm" }]] as const) assert.deepEqual(await ask(12, what, request), []);
});

test("without a server a change is refused with a sentence", async () => {
  const { session, fresh } = preview();
  await session.receive({ type: "ready" });
  fresh();
  await session.receive({ type: "ask", id: 1, what: "forms", request: { part: "Arm" } });
  assert.deepEqual(fresh(), [{ type: "answer", id: 1, ok: false, body: { why: "okoshi is not running", choices: [] } }]);
});

test("models are copied to the page, and missing ones are reported", async (t) => {
  const { client, end } = fakeServer(t);
  const { session, fresh, connect, logged } = preview();
  await session.receive({ type: "ready" });
  await connect(client);
  fresh();
  await session.receive({ type: "model", address: "builds/2.glb" });
  const [answer, ...more] = fresh();
  assert.deepEqual([answer?.type, answer?.["address"], more], ["modelBytes", "builds/2.glb", []]);
  const bytes = answer?.["bytes"] as Uint8Array;
  // The editor posts neither a Buffer nor a view of one as bytes.
  assert.equal(bytes.constructor, Uint8Array);
  assert.equal(bytes.buffer.byteLength, bytes.byteLength);
  assert.equal(Buffer.from(bytes).toString(), "glTF 2");
  // The full clips are requested in the same way.
  await session.receive({ type: "model", address: "builds/2.originals.glb" });
  const [full] = fresh();
  assert.deepEqual([full?.["address"], Buffer.from(full?.["bytes"] as Uint8Array).toString()], ["builds/2.originals.glb", "glTF 2.originals"]);
  const none = { type: "modelBytes", address: "builds/9.glb", bytes: null };
  await session.receive({ type: "model", address: "builds/9.glb" });
  assert.deepEqual(fresh(), [none]);
  end();
  await session.receive({ type: "model", address: "builds/9.glb" });
  assert.deepEqual(fresh(), [none]);
  assert.equal(logged.length, 1);
  session.disconnect({ state: "lost", note: "" });
  await session.receive({ type: "model", address: "builds/9.glb" });
  assert.deepEqual(fresh().at(-1), none);
});

test("a picked part is shown in the text", async (t) => {
  const { client } = fakeServer(t);
  const { session, done, connect } = preview();
  await session.receive({ type: "pick", drawing: DRAWING, part: "Arm" });
  await connect(client);
  await session.receive({ type: "pick", drawing: DRAWING, part: "Arm" });
  await session.receive({ type: "pick", drawing: DRAWING, part: "No such part" });
  assert.deepEqual(done, [{ show: arm }]);
});

test("the server gets the cursor when it rests, when the page asks, and at the start", async (t) => {
  const { client, told } = fakeServer(t);
  const { session, connect, set } = preview();
  await connect(client);
  await until(() => told.length === 2);
  assert.deepEqual(told.splice(0)[1], { cursor: { textDocument, position: null } });
  t.mock.timers.enable({ apis: ["setTimeout"] });
  for (let line = 0; line < 9; line += 1) {
    set({ line, character: 4 });
    t.mock.timers.tick(CURSOR_PAUSE - 1);
  }
  assert.deepEqual(told, []);
  t.mock.timers.tick(1);
  const there = { cursor: { textDocument, position: { line: 8, character: 4 } } };
  await until(() => told.length === 1);
  await session.receive({ type: "want", drawing: DRAWING });
  await until(() => told.length === 2);
  assert.deepEqual(told, [there, there]);
});

test("the preview waits for a stopped server and subscribes to the next one", async (t) => {
  const first = fakeServer(t);
  const { session, fresh, connect, set } = preview();
  await session.receive({ type: "ready" });
  assert.deepEqual(fresh(), [{ type: "link", state: "connecting", note: "" }]);
  await connect(first.client);
  await first.sends(drawings, build(1));
  assert.deepEqual(fresh(), [drawings, build(1), open]);
  first.end();
  const away = linkFor({ kind: "stopped" });
  session.disconnect(away);
  assert.deepEqual(fresh(), [{ type: "link", ...away }]);
  assert.match(away.note, /not running/);
  // Messages that were still on their way are not those of the next server.
  session.messages([build(7)]);
  assert.deepEqual(fresh(), []);

  const second = fakeServer(t);
  set({ line: 1, character: 1 });
  await connect(second.client);
  assert.deepEqual(fresh(), [{ type: "link", state: "connecting", note: "" }]);
  // Its builds are counted from the beginning. They come first: a page that knew of the server alone would ask it for an old model.
  await second.sends(drawings);
  await second.sends(build(1));
  assert.deepEqual(fresh(), [drawings, build(1), open]);
  await until(() => second.told.length >= 2);
  assert.deepEqual(second.told.slice(0, 2), [{ open: { textDocument } }, { cursor: { textDocument, position: { line: 1, character: 1 } } }]);
  session.dispose();
});

test("a server without previews is reported as too old", async (t) => {
  const { client } = fakeServer(t, false);
  const { session, fresh, connect, logged } = preview();
  await session.receive({ type: "ready" });
  await connect(client);
  const { state, note } = fresh().at(-1) as { state?: string; note?: string };
  assert.equal(state, "lost");
  assert.match(note ?? "", /too old/);
  assert.equal(logged.length, 1);
});

test("closing a panel is sent to the server once, and nothing is posted to the panel afterwards", async (t) => {
  const { client, told, sends } = fakeServer(t);
  const { session, fresh, connect, set } = preview();
  await session.receive({ type: "ready" });
  await connect(client);
  t.mock.timers.enable({ apis: ["setTimeout"] });
  set({ line: 2, character: 0 });
  session.dispose();
  fresh();
  session.dispose();
  t.mock.timers.tick(CURSOR_PAUSE * 2);
  await sends(build(2));
  assert.deepEqual(told.filter((one) => "close" in (one as object)), [{ close: { textDocument } }]);
  assert.equal(told.length, 3);
  assert.deepEqual(fresh(), []);
});

test("a closed text is not gone; a missing file is, until it is built again", async (t) => {
  const { client, sends } = fakeServer(t);
  const { session, fresh, connect } = preview();
  const gone = { type: "gone", drawing: DRAWING };
  await session.receive({ type: "ready" });
  await connect(client);
  await sends(drawings, build(1), gone, light("Arm"));
  assert.ok(!fresh().some(({ type }) => type === "gone"));
  session.gone();
  assert.deepEqual(fresh(), [gone]);
  await session.receive({ type: "ready" });
  assert.ok(fresh().some(({ type }) => type === "gone"));
  await sends(build(2));
  fresh();
  await session.receive({ type: "ready" });
  assert.ok(!fresh().some(({ type }) => type === "gone"));
});

test("diagnostics can be opened, and files are saved without their folders", async () => {
  const { session, done } = preview();
  await session.receive({ type: "open", drawing: DRAWING, line: 4, column: 9 });
  await session.receive({ type: "save", name: "../../etc/figure.glb", bytes: Buffer.from("glTF").toString("base64") });
  assert.deepEqual(done, [{ goTo: [4, 9] }, { save: ["figure.glb", "glTF"] }]);
});

test("invalid messages of the page are ignored", () => {
  for (const wrong of [null, 3, "ready", [], {}, { type: 3 }, { type: "eval" }, { type: "model" }, { type: "model", address: {} }]) {
    assert.equal(readPageMessage(wrong), undefined, JSON.stringify(wrong));
  }
  for (const wrong of [{ type: "pick", part: null }, { type: "open", line: 0, column: 1 }, { type: "open", line: 1.5, column: 1 }, { type: "save", name: "a" }]) {
    assert.equal(readPageMessage(wrong), undefined, JSON.stringify(wrong));
  }
  for (const wrong of [undefined, {}, { textDocument }, { textDocument: {}, messages: [] }, { textDocument, messages: {} }]) {
    assert.equal(readNotification(wrong), undefined, JSON.stringify(wrong));
  }
  assert.deepEqual(readNotification({ textDocument, messages: [null, 1, build(1)] }), { uri: DRAWING, messages: [build(1)] });
});

test("every state of the server has a message for the page", () => {
  for (const kind of ["idle", "starting", "stopped"] as const) assert.notEqual(linkFor({ kind }).note, "");
  assert.match(linkFor({ kind: "missing", path: "/opt/okoshi" }).note, /\/opt\/okoshi/);
  assert.deepEqual(linkFor({ kind: "failed", why: "It ended." }), { state: "lost", note: "It ended." });
});

test("columns in characters become UTF-16 offsets", () => {
  assert.equal(utf16Offset("腕@体", 3), 2);
  assert.equal(utf16Offset("a🦾b", 3), 3);
  assert.equal(utf16Offset("ab", 1), 0);
  assert.equal(utf16Offset("ab", 99), 2);
});

const addresses = { script: "https://panel/page.js", style: "https://panel/page.css", source: "https://panel", nonce: "n0nce" };

test("the bundled page may only run its own script and load its own style", () => {
  const page = html(readFileSync("dist/page/page.html", "utf8"), addresses);
  const policy = /http-equiv="Content-Security-Policy" content="([^"]+)"/.exec(page)?.[1] ?? "";
  const allowed = new Map(policy.split("; ").map((one) => [one.split(" ")[0], one.split(" ").slice(1)]));
  assert.deepEqual(allowed.get("default-src"), ["'none'"]);
  assert.deepEqual(allowed.get("script-src"), ["'nonce-n0nce'"]);
  assert.doesNotMatch(policy, /unsafe|\*/);
  // The policy applies to everything after it.
  assert.ok(page.indexOf("Content-Security-Policy") < page.search(/<script|<link/));
  const scripts = [...page.matchAll(/<script[^>]*>/g)].map(([tag]) => tag);
  assert.deepEqual(scripts.map((tag) => [tag.includes('nonce="n0nce"'), tag.includes('src="https://panel/page.js"')]), [[true, true]]);
  assert.deepEqual([...page.matchAll(/<link rel="stylesheet" href="([^"]+)"/g)].map(([, style]) => style), [addresses.style]);
  assert.doesNotMatch(page, /<style|\son\w+=|\sstyle=/);
});

test("an unexpected page is refused", () => {
  assert.throws(() => html("<html></html>", addresses), /charset/);
  const twice = '<meta charset="utf-8"><link href="page.css"><script src="page.js"></script><script src="page.js"></script>';
  assert.throws(() => html(twice, addresses), /page\.js/);
});
