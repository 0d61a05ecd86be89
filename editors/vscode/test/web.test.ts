// The language server of VS Code for the Web, with the module: OKOSHI_MODULE names the folder that it was built into.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { PassThrough } from "node:stream";
import { before, test, type TestContext } from "node:test";
import { pathToFileURL } from "node:url";
import { createMessageConnection, StreamMessageReader, StreamMessageWriter, type MessageConnection } from "vscode-jsonrpc/node";
import manifest from "../package.json";
import { PREVIEW_NOTIFICATION, readNotification, Remote, type Message } from "../src/preview/messages";
import { Language, type Answers } from "../src/web/language";
import { READ_FILE, STOPPED, type FileAnswer, type FileQuestion } from "../src/web/protocol";
import { repository } from "./paths";

const MODULE = process.env["OKOSHI_MODULE"];
const withModule = { skip: MODULE === undefined ? "OKOSHI_MODULE names no folder of a module" : false };

const URI = "vscode-vfs://github/ann/figures/figure.svg";
const textDocument = { uri: URI };
const figure = readFileSync("workbench/figure.svg", "utf8");

declare const WebAssembly: { readonly Module: new (bytes: Uint8Array) => object; readonly RuntimeError: new (message: string) => Error };

interface Module {
  initSync(options: { readonly module: object }): void;
  readonly Server: new () => Answers;
}

let module: Module;

before(async () => {
  if (MODULE === undefined) return;
  module = (await import(pathToFileURL(join(MODULE, "okoshi_web.js")).href)) as Module;
  module.initSync({ module: new WebAssembly.Module(readFileSync(join(MODULE, "okoshi_web_bg.wasm"))) });
});

interface Published {
  readonly uri: string;
  readonly version?: number;
  readonly diagnostics: readonly { readonly code: string; readonly message: string; readonly range: Range; readonly severity: number }[];
}

interface Range {
  readonly start: { readonly line: number; readonly character: number };
  readonly end: { readonly line: number; readonly character: number };
}

interface Edit {
  readonly range: Range;
  readonly newText: string;
}

/** An editor that speaks with the server, and what it has heard. */
function editor(t: TestContext, answers: Answers, files: Record<string, Uint8Array> = {}) {
  const [there, back] = [new PassThrough(), new PassThrough()];
  // Bytes pass as JSON here, which a worker's messages leave as they are.
  const server = createMessageConnection(new StreamMessageReader(there), new StreamMessageWriter(back));
  const client: MessageConnection = createMessageConnection(new StreamMessageReader(back), new StreamMessageWriter(there));
  const published: Published[] = [];
  const news: Message[] = [];
  const asked: string[] = [];
  let stops = 0;
  client.onNotification("textDocument/publishDiagnostics", (params: Published) => void published.push(params));
  client.onNotification(PREVIEW_NOTIFICATION, (params: unknown) => void news.push(...(readNotification(params)?.messages ?? [])));
  client.onNotification(STOPPED, () => void stops++);
  client.onRequest(READ_FILE, ({ drawing, path }: FileQuestion) => {
    asked.push(path);
    const uri = `${drawing.slice(0, drawing.lastIndexOf("/"))}/${path}`;
    const bytes = files[path];
    return { uri, bytes: bytes ? Buffer.from(bytes).toString("base64") : null };
  });
  // What stands for bytes in JSON is bytes again for the server.
  const read = server.sendRequest.bind(server);
  server.sendRequest = (async (method: string, params: unknown): Promise<FileAnswer> => {
    const answer = (await read(method, params)) as { uri: string; bytes: string | null };
    return { ...answer, bytes: answer.bytes === null ? null : new Uint8Array(Buffer.from(answer.bytes, "base64")) };
  }) as typeof server.sendRequest;
  new Language(answers, server);
  client.listen();
  t.after(() => {
    server.dispose();
    client.dispose();
  });
  const open = (text: string, uri = URI) => client.sendNotification("textDocument/didOpen", { textDocument: { uri, version: 1, languageId: "xml", text } });
  const change = (version: number, text: string) => client.sendNotification("textDocument/didChange", { textDocument: { ...textDocument, version }, contentChanges: [{ text }] });
  const initialize = (analyse: string) =>
    client.sendRequest("initialize", {
      processId: null,
      rootUri: null,
      capabilities: { textDocument: { documentSymbol: { hierarchicalDocumentSymbolSupport: true }, completion: { completionItem: { snippetSupport: true } } } },
      initializationOptions: { analyse, preview: true },
    });
  return { client, published, news, asked, open, change, initialize, stops: () => stops };
}

/** Waits until something holds; the limit only ends a test that hangs. */
async function until(what: string, probe: () => boolean): Promise<void> {
  const end = Date.now() + 120_000;
  while (!probe()) {
    assert.ok(Date.now() < end, `waited in vain: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
}

/** The place of the `at`th character of the first occurrence of a text. */
function place(text: string, wanted: string, at = 0): Range["start"] {
  const offset = text.indexOf(wanted);
  assert.ok(offset >= 0, wanted);
  const lines = text.slice(0, offset + at).split("\n");
  return { line: lines.length - 1, character: lines.at(-1)?.length ?? 0 };
}

function edited(text: string, edits: readonly Edit[]): string {
  const lines = text.split("\n");
  const offset = ({ line, character }: Range["start"]) => lines.slice(0, line).reduce((sum, one) => sum + one.length + 1, character);
  const sorted = [...edits].sort((a, b) => offset(b.range.start) - offset(a.range.start));
  return sorted.reduce((now, { range, newText }) => now.slice(0, offset(range.start)) + newText + now.slice(offset(range.end)), text);
}

test("it says what it can do, and takes whole texts", withModule, async (t) => {
  const { initialize } = editor(t, new module.Server());
  const { capabilities, serverInfo } = (await initialize("onType")) as { capabilities: Record<string, unknown>; serverInfo: { version: string } };
  for (const name of ["hover", "completion", "codeAction", "rename", "documentSymbol", "semanticTokens", "inlayHint", "documentFormatting"]) assert.ok(capabilities[`${name}Provider`], name);
  // It reads no folders.
  assert.equal(capabilities["workspaceSymbolProvider"], undefined);
  assert.equal((capabilities["textDocumentSync"] as { change: number }).change, 1);
  assert.equal(serverInfo.version, manifest.version);
});

test("a misspelt keyword is found, explained and mended", withModule, async (t) => {
  const { client, open, change, initialize, published } = editor(t, new module.Server());
  await initialize("onType");
  await open(figure);
  await until("diagnostics", () => published.length > 0);
  const [first] = published;
  assert.deepEqual([first?.uri, first?.version, first?.diagnostics.map(({ code }) => code)], [URI, 1, ["E101"]]);
  const wrong = { start: place(figure, "Shap round"), end: place(figure, "Shap round", 4) };
  assert.deepEqual(first?.diagnostics[0]?.range, wrong);

  const hover = (await client.sendRequest("textDocument/hover", { textDocument, position: wrong.start })) as { contents: { value: string } };
  assert.match(hover.contents.value, /E101: unknown keyword/);

  const actions = (await client.sendRequest("textDocument/codeAction", { textDocument, range: wrong, context: { diagnostics: [] } })) as { title: string; kind: string; edit: { changes: Record<string, Edit[]> } }[];
  const fix = actions.find(({ kind }) => kind === "quickfix");
  const mended = edited(figure, fix?.edit.changes[URI] ?? []);
  assert.ok(mended.includes("Head@Body$Shape round"), fix?.title);
  await change(2, mended);
  await until("the error to go", () => published.at(-1)?.version === 2);
  assert.deepEqual(published.at(-1)?.diagnostics, []);
});

test("keys that come fast are analysed together, and each answer is about the last text", withModule, async (t) => {
  const server = new module.Server();
  let writes = 0;
  const write = server.write.bind(server);
  server.write = (...args) => {
    writes += 1;
    return write(...args);
  };
  const { client, open, change, initialize, published } = editor(t, server);
  await initialize("onType");
  await open(figure);
  for (let version = 2; version < 60; version++) void change(version, figure.replace("Origin start", `Origin start Seg${"x".repeat(version)}`));
  const text = figure.replace("Origin start", "Origin start Seg");
  void change(60, text);
  const found = (await client.sendRequest("textDocument/completion", { textDocument, position: place(text, "start Seg", 9) })) as { label: string }[] | { items: { label: string }[] };
  const labels = ("items" in found ? found.items : found).map(({ label }) => label);
  assert.ok(labels.includes("Segments"), labels.join(", "));
  await until("the last diagnostics", () => published.at(-1)?.version === 60);
  assert.ok(writes < 30, `${writes} analyses of 60 texts`);
});

test("drawings are checked when they are saved, if that is wanted", withModule, async (t) => {
  const { client, open, change, initialize, published } = editor(t, new module.Server());
  await initialize("onSave");
  await open(figure);
  await until("diagnostics of the opened text", () => published.length === 1);
  await change(2, figure.replace("Arm@Body", "Arm@Nobody"));
  await client.sendRequest("textDocument/documentSymbol", { textDocument });
  assert.equal(published.length, 1);
  await client.sendNotification("textDocument/didSave", { textDocument });
  await until("diagnostics of the saved text", () => published.length === 2);
  assert.ok((published[1]?.diagnostics.length ?? 0) > (published[0]?.diagnostics.length ?? 0));
  await client.sendNotification("workspace/didChangeConfiguration", { settings: { okoshi: { analyse: "onType" } } });
  await change(3, figure);
  await until("diagnostics of the changed text", () => published.at(-1)?.version === 3);
  await client.sendNotification("textDocument/didClose", { textDocument });
  await until("no diagnostics", () => published.at(-1)?.version === undefined);
  assert.deepEqual(published.at(-1)?.diagnostics, []);
});

test("parts are listed by their hierarchy, renamed everywhere, and no name is given twice", withModule, async (t) => {
  const { client, open, initialize } = editor(t, new module.Server());
  await initialize("onType");
  await open(figure);
  type Symbol = { name: string; children?: Symbol[] };
  const [body] = (await client.sendRequest("textDocument/documentSymbol", { textDocument })) as Symbol[];
  assert.deepEqual([body?.name, body?.children?.map(({ name }) => name).sort()], ["Body", ["Arm", "Head", "Leg"]]);
  const position = place(figure, "Body$Shape", 1);
  const { changes } = (await client.sendRequest("textDocument/rename", { textDocument, position, newName: "Trunk" })) as { changes: Record<string, Edit[]> };
  const renamed = edited(figure, changes[URI] ?? []);
  assert.deepEqual([renamed.split("Trunk").length, renamed.includes("Body")], [5, false]);
  await assert.rejects(client.sendRequest("textDocument/rename", { textDocument, position, newName: "Arm" }), /there is a part named `Arm` already/);
  await assert.rejects(client.sendRequest("textDocument/hover", { textDocument: { uri: `${URI}x` }, position }), /not open/);
});

test("a preview gets a model of the text, and its changes are edits of this text", withModule, async (t) => {
  const server = new module.Server();
  const { client, open, change, initialize, news } = editor(t, server);
  await initialize("onType");
  const text = figure.replace("Shap round", "Shape round");
  await open(text);
  const remote = new Remote(client, URI);
  await remote.open();
  await until("a build", () => news.some(({ type }) => type === "build"));
  assert.equal(news[0]?.type, "editing");
  assert.deepEqual(news.find(({ type }) => type === "drawings")?.["drawings"], [{ id: URI, name: "figure.svg", folder: "" }]);
  const address = () => (news.filter(({ type }) => type === "build").at(-1)?.["build"] as { model: string }).model;
  const model = (): string => Buffer.from(server.bytes(address()) ?? []).toString("latin1");
  assert.ok(model().startsWith("glTF"));
  assert.ok(model().includes('"Head"'));

  // An unsaved text is shown, too.
  await change(2, text.replace("Head@", "Hat@"));
  await until("the next build", () => news.filter(({ type }) => type === "build").length === 2);
  assert.ok(model().includes('"Hat"'));

  assert.deepEqual((await remote.place("Hat"))?.range.start.line, place(text, "Head@").line);
  await remote.cursor(place(text, "Arm@Body", 1));
  await until("a part that is lit", () => news.some((one) => one.type === "light" && one["part"] === "Arm"));

  const form = await remote.form("Arm");
  assert.ok("form" in form);
  const made = await remote.change({ change: "set", part: "Arm", attribute: "Segments", value: "12" });
  assert.ok("edits" in made);
  assert.equal(made.version, 2);
  assert.match(edited(text, made.edits), /Arm@Body\$Shape roundv Origin start Segments 12/);
  const refused = await remote.change({ change: "set", part: "Nobody", attribute: "Segments", value: "12" });
  assert.ok("refused" in refused);
  const tried = server.attempt(JSON.stringify({ textDocument, change: { change: "set", part: "Arm", attribute: "Segments", value: "12" } }));
  assert.equal(Buffer.from(tried?.slice(0, 4) ?? []).toString(), "glTF");

  await remote.close();
  const count = news.length;
  await change(3, text);
  await client.sendRequest("textDocument/documentSymbol", { textDocument });
  assert.equal(news.length, count);
});

test("files that a drawing links to are read, and read again when they change", withModule, async (t) => {
  const files: Record<string, Uint8Array> = {};
  const { client, open, initialize, published, asked } = editor(t, new module.Server(), files);
  await initialize("onType");
  await open(readFileSync(join(repository, "examples", "motion", "beetle.svg"), "utf8"));
  const missing = () => published.at(-1)?.diagnostics.some(({ message }) => message.includes("walk.bvh") && message.includes("is not there")) ?? false;
  await until("a missing file", missing);
  await until("the file to be asked for", () => asked.includes("walk.bvh"));
  files["walk.bvh"] = readFileSync(join(repository, "examples", "motion", "walk.bvh"));
  const changed = { changes: [{ uri: URI.replace("figure.svg", "walk.bvh"), type: 1 }] };
  await client.sendNotification("workspace/didChangeWatchedFiles", changed);
  await until("the file to be there", () => published.length > 1 && !missing());
  delete files["walk.bvh"];
  await client.sendNotification("workspace/didChangeWatchedFiles", changed);
  await until("the file to be missing again", missing);
});

test("a module that stops is said to have stopped, once, and answers nothing more", async (t) => {
  const nothing = { put: () => {}, renew: () => {}, close: () => {}, links: () => [], diagnostics: () => "[]", request: () => '{"result":null}', news: () => [], bytes: () => undefined, attempt: () => undefined };
  const { client, open, change, stops } = editor(t, {
    ...nothing,
    write: () => {
      throw new WebAssembly.RuntimeError("unreachable");
    },
  });
  await open(figure);
  await until("the stop", () => stops() === 1);
  await change(2, figure);
  await assert.rejects(client.sendRequest("textDocument/hover", { textDocument, position: place(figure, "Arm@") }), /okoshi has stopped/);
  assert.equal(stops(), 1);
});
