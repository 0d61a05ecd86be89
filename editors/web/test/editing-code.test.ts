// Editing in the panel of VS Code: the page, the extension's session and the real language server, with a text in the place of the editor's.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { after, test } from "node:test";
import type { Browser } from "playwright-core";
import { Remote, type Connection, type TextEdit } from "../../vscode/src/preview/messages";
import { Session } from "../../vscode/src/preview/session";
import { launch, noBrowser, open, picture, shown } from "./browser";
import { closeAll, closing, PATIENCE, TEST_LIMIT } from "./closing";
import { FIGURE, source } from "./setup";
import { servePage } from "./served";

const okoshi = process.env["OKOSHI"] ?? "";
const skip = noBrowser !== false ? noBrowser : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
const URI = "untitled:figure.svg";
const BEFORE = source(FIGURE);

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

/** A language server, spoken to as a client does. */
class Client implements Connection {
  private readonly program = spawn(okoshi, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  private readonly waiting = new Map<number, (result: unknown) => void>();
  private received = Buffer.alloc(0);
  private requests = 0;
  notified: (method: string, params: unknown) => void = () => {};

  constructor() {
    this.program.stdout.on("data", (more: Buffer) => {
      this.received = Buffer.concat([this.received, more]);
      for (;;) {
        const end = this.received.indexOf("\r\n\r\n");
        if (end < 0) return;
        const length = Number(/Content-Length: (\d+)/i.exec(this.received.toString("latin1", 0, end))![1]);
        if (this.received.length < end + 4 + length) return;
        const message = JSON.parse(this.received.toString("utf8", end + 4, end + 4 + length)) as { id?: number; method?: string; params?: unknown; result?: unknown };
        this.received = this.received.subarray(end + 4 + length);
        if (message.method !== undefined && message.id !== undefined) this.write({ id: message.id, result: null });
        else if (message.method !== undefined) this.notified(message.method, message.params);
        else if (message.id !== undefined) this.waiting.get(message.id)?.(message.result ?? null);
      }
    });
  }

  sendRequest(method: string, params: unknown): Promise<unknown> {
    return new Promise((resolve) => {
      const id = ++this.requests;
      this.waiting.set(id, resolve);
      this.write({ id, method, params });
    });
  }

  async sendNotification(method: string, params: unknown): Promise<void> {
    this.write({ method, params });
  }

  end(): Promise<void> {
    const ended = new Promise<void>((resolve) => this.program.once("close", () => resolve()));
    this.program.kill();
    return ended;
  }

  private write(message: object): void {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    this.program.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }
}

test("in VS Code a change is made in the text, its own undo takes it back, and a refusal has its choices", { skip, timeout: TEST_LIMIT }, async (t) => {
  const onClose = closing(t);
  const client = new Client();
  onClose(() => client.end());
  await client.sendRequest("initialize", { processId: null, rootUri: null, capabilities: {}, initializationOptions: { preview: true } });
  await client.sendNotification("initialized", {});

  // The text of the editor, with its undo.
  const texts = [BEFORE];
  let version = 1;
  let saved: string | undefined;
  const changed = async (): Promise<void> => {
    version += 1;
    await client.sendNotification("textDocument/didChange", { textDocument: { uri: URI, version }, contentChanges: [{ text: texts.at(-1)! }] });
  };
  await client.sendNotification("textDocument/didOpen", { textDocument: { uri: URI, languageId: "svg", version, text: BEFORE } });
  const at = (text: string, { line, character }: TextEdit["range"]["start"]): number => text.split("\n").slice(0, line).reduce((sum, one) => sum + one.length + 1, 0) + character;

  const { address, close } = await servePage();
  onClose(close);
  browser ??= launch();
  const { page, wrong } = await open(await browser, "about:blank", onClose);
  const post = (message: object): void => void page.evaluate((okoshi) => postMessage({ okoshi }, "*"), encoded(message)).catch(() => {});
  const session = new Session(URI, {
    post,
    cursor: () => null,
    show: async () => {},
    goTo: async () => {},
    save: async () => {},
    log: (message) => void wrong.push(message),
    edit: async (of, edits) => {
      if (of !== version) return false;
      let text = texts.at(-1)!;
      for (const { range, newText } of [...edits].reverse()) text = text.slice(0, at(text, range.start)) + newText + text.slice(at(text, range.end));
      texts.push(text);
      await changed();
      return true;
    },
    saveText: async () => void (saved = texts.at(-1)),
    step: async () => {
      if (texts.length > 1) texts.pop();
      await changed();
    },
  });
  client.notified = (method, params) => {
    if (method === "okoshi/preview/news") session.messages((params as { messages: { type: string }[] }).messages);
  };
  await page.exposeFunction("toExtension", (message: unknown) => session.receive(message));
  await page.addInitScript(() => {
    const { toExtension } = globalThis as unknown as { toExtension(message: unknown): void };
    Object.assign(globalThis, { acquireVsCodeApi: () => ({ postMessage: (message: unknown) => toExtension(structuredClone(message)), setState: () => {} }) });
  });
  await page.goto(address);
  await session.connect(new Remote(client, URI));
  await shown(page, 1);

  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator("[data-part=Arm]").click();
  await page.locator('.part-form[data-form-of="Arm"]:not([inert])').waitFor();
  assert.equal(await page.locator(".edit-words").innerText(), "Changes are made in the text");
  const number = page.getByLabel("Shape: z1, as a number", { exact: true });
  await number.fill("30");
  await number.press("Enter");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["revision"] === "2");
  const thick = BEFORE.replace("-8 8", "-8 30");
  assert.deepEqual(texts, [BEFORE, thick]);
  // What is being typed is saved, too.
  const thicker = BEFORE.replace("-8 8", "-8 40");
  await number.fill("40");
  assert.equal(saved, undefined);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["revision"] === "3");
  for (const end = Date.now() + PATIENCE; saved === undefined && Date.now() < end; ) await new Promise((resolve) => setTimeout(resolve, 20));
  assert.equal(saved, thicker);
  await page.getByRole("button", { name: "Undo: the last step in the text" }).click();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["revision"] === "4");
  await picture(page, "edit-code");

  // What is only tried is shown, and leaves the text alone.
  const swatch = page.getByLabel("Color: swatch", { exact: true });
  await swatch.evaluate((one) => {
    (one as HTMLInputElement).value = "#00e0ff";
    one.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
  await page.keyboard.press("Escape");
  assert.equal(texts.at(-1), thick);

  await page.getByRole("button", { name: "Undo: the last step in the text" }).click();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["revision"] === "5");
  assert.deepEqual(texts, [BEFORE]);

  await page.locator("[data-part=Body]").click();
  await page.locator('.part-form[data-form-of="Body"]:not([inert])').waitFor();
  await page.getByRole("button", { name: "Leave this part out" }).click();
  const refusal = page.locator(".refusal");
  await refusal.waitFor();
  assert.match(await refusal.innerText(), /hang/i);
  assert.deepEqual(texts, [BEFORE]);
  assert.deepEqual(wrong, []);
});

/** A message as the editor posts it: bytes go as base64 here. */
function encoded(message: object): object {
  return Object.fromEntries(Object.entries(message).map(([name, value]) => [name, value instanceof Uint8Array ? Buffer.from(value).toString("base64") : (value as unknown)]));
}
