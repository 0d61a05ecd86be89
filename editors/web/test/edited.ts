// A drawing that is edited on the page that was just bundled, by the real program; with OKOSHI_HOST=worker by the module, in the program in the
// browser, whose kept text is then written to the file, so that tests read the same.

import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { after, test } from "node:test";
import type { Browser, Locator, Page } from "playwright-core";
import { skip as noModule, openApp, type App } from "./app";
import { DIST, isFirefox, launch, noBrowser, open, shown, type PageOptions } from "./browser";
import { closeAll, closing, PATIENCE, preview, TEST_LIMIT, type Close } from "./closing";
import { FIGURE } from "./setup";

const okoshi = process.env["OKOSHI"] ?? "";
export const byModule = process.env["OKOSHI_HOST"] === "worker";
const noProgram = noBrowser !== false ? noBrowser : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
const skip = byModule ? noModule : noProgram;
const TYPES: Readonly<Record<string, string>> = { "": "page.html", "page.js": "page.js", "page.css": "page.css" };
/** Why some tests are for the program alone. */
export const BY_OTHERS = "only the program has files that others save";
export const HELD_BACK = "only requests of the program can be held back";
/** How late messages of the program are, in milliseconds, where a test does not say that: what passes at once must pass on a slow machine. */
const LATE = Number(process.env["LATE"] ?? 0);
/** How often the kept text is looked at, in milliseconds. */
const PAUSE = 20;

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

export class Edited {
  /** `app`: the program in the browser that has the drawing, or nothing if the real program has it. */
  constructor(readonly page: Page, readonly file: string, private readonly app: App | null = null) {}

  text(): string {
    return readFileSync(this.file, "utf8");
  }

  /** Waits until the file has exactly these bytes; what the page shows may be older. */
  async has(expected: string, what: string): Promise<void> {
    await this.wait(() => this.text() === expected);
    assert.equal(this.text(), expected, what);
  }

  /** Waits until something holds of the file. */
  async until(holds: () => boolean, what: string): Promise<void> {
    await this.wait(holds);
    assert.ok(holds(), `${what}: ${this.text()}`);
  }

  /** Waits until the file matches, and returns how. */
  async matches(pattern: RegExp): Promise<RegExpExecArray> {
    await this.until(() => pattern.test(this.text()), String(pattern));
    return pattern.exec(this.text())!;
  }

  /** Waits until the page says that a change is made. */
  async made(): Promise<void> {
    await this.page.locator(".edit-words").filter({ hasText: /^(Saved|Changed)/ }).waitFor();
  }

  private async wait(holds: () => boolean): Promise<void> {
    const end = Date.now() + PATIENCE;
    while (!holds() && Date.now() < end) await new Promise((resolve) => setTimeout(resolve, 20));
  }

  /** Gives the drawing another text, as an editor does that saves it; to the program in the browser it is opened anew. */
  async save(text: string): Promise<void> {
    if (!this.app) return writeFileSync(this.file, text);
    await this.app.saved(() => this.page.getByRole("button", { name: "Save", exact: true }).click());
    await this.app.drop({ name: basename(this.file), text });
  }

  /** Gives the drawing a file that it links to. */
  async link(file: string): Promise<void> {
    if (!this.app) return copyFileSync(file, join(dirname(this.file), basename(file)));
    await this.app.drop({ name: basename(file), text: readFileSync(file, "utf8") });
  }

  /** The form of a part. */
  async select(part: string): Promise<void> {
    await this.page.locator(`[data-part="${part}"]`).click();
    await this.formOf(part);
  }

  /** Waits for the form of a part. */
  async formOf(part: string): Promise<void> {
    await this.page.locator(`.part-form[data-form-of="${part}"]:not([inert])`).waitFor();
  }

  label(name: string): Locator {
    return this.page.getByLabel(name, { exact: true });
  }
}

export interface EditOptions extends PageOptions {
  readonly drawing?: string;
  /** More arguments of the program. */
  readonly arguments?: readonly string[];
  /** Why this is for the program alone. */
  readonly program?: string;
  /** How much later than it sends them the page gets the program's messages, in milliseconds. */
  readonly late?: number;
}

/** A test with a drawing that is edited. */
export function edit(name: string, run: (edited: Edited) => Promise<void>, options: EditOptions = {}): void {
  const { drawing = FIGURE, arguments: more = [], program, late = LATE, ...context } = options;
  const isForProgram = more.length > 0 ? "only the program takes arguments" : program;
  const why = (isFirefox && options.hasTouch === true && "Firefox's driver has no fingers") || (byModule && isForProgram !== undefined && isForProgram);
  test(name, { skip: skip || why, timeout: TEST_LIMIT }, async (t) => {
    const onClose = closing(t);
    const folder = mkdtempSync(join(tmpdir(), "okoshi-edit-"));
    onClose(() => rmSync(folder, { recursive: true }));
    const file = join(folder, "figure.svg");
    copyFileSync(drawing, file);
    const { edited, wrong } = byModule ? await inBrowser(file, onClose, context) : await inProgram(file, onClose, context, more, late);
    await run(edited);
    // What is refused is answered with a status that the browser reports.
    assert.deepEqual(wrong().filter((one) => !/status of 409/.test(one)), []);
  });
}

interface Begun {
  readonly edited: Edited;
  wrong(): string[];
}

/** The page is the one that was bundled for the tests, and is served as the program serves its own. */
async function inProgram(file: string, onClose: (close: Close) => void, options: PageOptions, more: readonly string[], late: number): Promise<Begun> {
  const { address } = await preview(okoshi, dirname(file), basename(file), onClose, more);
  // To Chromium, a page that a test hands over is not on this machine, and would not be let to it.
  browser ??= launch(isFirefox ? [] : ["--disable-features=LocalNetworkAccessChecks"]);
  const { page, wrong } = await open(await browser, address, onClose, options, async (context) => {
    if (late > 0) {
      await context.routeWebSocket(/./, (page) => {
        const program = page.connectToServer();
        program.onMessage((message) => void setTimeout(() => page.send(message), late));
      });
    }
    for (const [path, name] of Object.entries(TYPES)) {
      await context.route(address + path, async (route) => {
        const { "content-length": _, ...headers } = (await route.fetch()).headers();
        await route.fulfill({ headers, body: readFileSync(join(DIST, name)) });
      });
    }
  });
  await shown(page, 1);
  return { edited: new Edited(page, file), wrong: () => wrong };
}

async function inBrowser(file: string, onClose: (close: Close) => void, options: PageOptions): Promise<Begun> {
  const { app, wrong } = await openApp(onClose, options);
  await app.page.getByRole("button", { name: "Open…" }).waitFor();
  await app.drop({ name: basename(file), text: readFileSync(file, "utf8") });
  await shown(app.page);
  const ended = new AbortController();
  const mirrored = mirror(app.page, file, ended.signal);
  onClose(() => (ended.abort(), mirrored));
  return { edited: new Edited(app.page, file, app), wrong };
}

/** Writes what the browser keeps of the drawing to a file, until that is ended. */
async function mirror(page: Page, file: string, ended: AbortSignal): Promise<void> {
  for (let last = readFileSync(file, "utf8"); !ended.aborted; await new Promise((resolve) => setTimeout(resolve, PAUSE))) {
    const text = await page.evaluate(keptText, basename(file)).catch(() => null);
    if (text !== null && text !== last) writeFileSync(file, (last = text));
  }
}

/** Runs in the page: the text of a drawing that the browser keeps. */
function keptText(path: string): Promise<string | null> {
  return new Promise((resolve) => {
    const opening = indexedDB.open("okoshi");
    opening.onerror = () => resolve(null);
    opening.onsuccess = () => {
      const base = opening.result;
      const asked = base.transaction("files").objectStore("files").get(path);
      asked.onerror = () => resolve(null);
      asked.onsuccess = () => {
        base.close();
        resolve(asked.result ? new TextDecoder().decode(asked.result.bytes) : null);
      };
    };
  });
}
