// The program in the browser: the folder that is made of the built module, served as any static host does.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { extname, join, resolve } from "node:path";
import { after, test } from "node:test";
import type { Browser, BrowserContext, Download, Page } from "playwright-core";
import { isFirefox, launch, noBrowser, open, type, type Motion, type PageOptions } from "./browser";
import { closeAll, closing, serving, TEST_LIMIT, type Close, type Serving } from "./closing";

const module = process.env["OKOSHI_MODULE"] ?? "";
export const skip = noBrowser !== false ? noBrowser : module === "" || !existsSync(module) ? "there is no module; OKOSHI_MODULE names the folder that editors/web/wasm/build.sh made" : false;

const TYPES: Readonly<Record<string, string>> = { ".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".png": "image/png" };

/** The model of a first visit, once it is drawn. */
export const STAGE = ".welcome-stage canvas[data-revision]";

const browsers = new Map<Motion, Promise<Browser>>();
let folder: string | undefined;
after(() => closeAll([...[...browsers.values()].map((browser) => async () => (await browser).close()), () => folder && rmSync(folder, { recursive: true })]));

/** The browser for pages of this kind, started once: Chromium is one for all. */
export function browserFor(motion: Motion): Promise<Browser> {
  const kind = isFirefox ? motion : "reduce";
  const browser = browsers.get(kind) ?? launch([], kind);
  browsers.set(kind, browser);
  return browser;
}

/** The folder, made once: for all files of tests, by scripts/test.mjs. */
function made(): string {
  const shared = process.env["OKOSHI_APP"];
  if (shared !== undefined) return shared;
  if (folder === undefined) {
    folder = mkdtempSync(join(tmpdir(), "okoshi-app-"));
    execFileSync(process.execPath, [join("scripts", "app.mjs"), folder, resolve(module)], { stdio: ["ignore", "ignore", "inherit"] });
  }
  return folder;
}

/** A static host, which can be away. */
async function host(root: string, onClose: (close: Close) => void): Promise<Serving> {
  const server = createServer(({ url = "/" }, response) => {
    const { pathname } = new URL(url, "http://localhost");
    const file = join(root, pathname.endsWith("/") ? `${pathname}index.html` : pathname);
    const found = existsSync(file) && statSync(file).isFile();
    response.writeHead(found ? 200 : 404, { "content-type": TYPES[extname(file)] ?? "text/plain" }).end(found ? readFileSync(file) : "");
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  const stop = (): Promise<void> =>
    new Promise((resolve) => {
      server.close(() => resolve());
      server.closeAllConnections();
    });
  onClose(stop);
  return { address: `http://127.0.0.1:${(server.address() as AddressInfo).port}/`, stop };
}

/** The program that serves the folder itself. */
const okoshi = process.env["OKOSHI"] ?? "";
const skipServed = skip !== false ? skip : okoshi === "" ? "there is no okoshi program; OKOSHI names one" : false;
/** `okoshi app` as the host. */
export const byOkoshi = (root: string, onClose: (close: Close) => void): Promise<Serving> => serving(okoshi, root, ["app", root, "--port", "0"], onClose);

interface Handed {
  readonly name: string;
  readonly text: string;
}
interface Handing {
  handed: Handed[];
}

/** Notes the files that the page hands to the browser: Playwright does not learn of Firefox's downloads. */
function noteDownloads(): void {
  const blobs = new Map<string, Blob>();
  const { createObjectURL } = URL;
  URL.createObjectURL = (blob: Blob) => {
    const address = createObjectURL(blob);
    blobs.set(address, blob);
    return address;
  };
  const { handed } = Object.assign(globalThis, { handed: [] as Handed[] });
  const { click } = HTMLAnchorElement.prototype;
  HTMLAnchorElement.prototype.click = function () {
    const { download } = this;
    void blobs.get(this.href)?.text().then((text) => handed.push({ name: download, text }));
    click.call(this);
  };
}

export class App {
  constructor(readonly page: Page, private readonly stop: () => Promise<void>) {}

  /** Ends the server: what is shown from now on is from the browser. */
  leave(): Promise<void> {
    return this.stop();
  }

  /** Opens files by the button. */
  async choose(...files: readonly (string | { name: string; mimeType: string; buffer: Buffer })[]): Promise<void> {
    const [chooser] = await Promise.all([this.page.waitForEvent("filechooser"), this.page.getByRole("button", { name: "Open…" }).click()]);
    await chooser.setFiles(files as string[]);
  }

  /** Drops files on the page. */
  async drop(...files: readonly { name: string; text: string }[]): Promise<void> {
    await this.page.evaluate((files) => {
      const data = new DataTransfer();
      for (const { name, text } of files) data.items.add(new File([text], name));
      for (const type of ["dragover", "drop"]) document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
    }, files);
  }

  /** What is saved as a download. */
  async saved(press: () => Promise<void>): Promise<{ name: string; text: string }> {
    if (isFirefox) {
      await press();
      const handed = await this.page.waitForFunction(() => (globalThis as unknown as Handing).handed.shift());
      return (await handed.jsonValue()) as Handed;
    }
    const [download]: [Download, void] = await Promise.all([this.page.waitForEvent("download"), press()]);
    return { name: download.suggestedFilename(), text: readFileSync(await download.path(), "utf8") };
  }

  /** Waits until the list of parts has a part. */
  async part(name: string): Promise<void> {
    await this.page.locator(`[data-part="${name}"]`).waitFor();
  }

  /** The form of a part; in a small window the list is in a drawer. */
  async select(part: string): Promise<void> {
    const opener = this.page.locator(".drawer-opener");
    const isSmall = await opener.isVisible();
    if (isSmall) await opener.click();
    await this.page.locator(`[data-part="${part}"]`).click();
    if (isSmall) await this.page.locator(".drawer-tab", { hasText: part }).click();
    await this.page.locator(`.part-form[data-form-of="${part}"]:not([inert])`).waitFor();
  }

  /** Renames a part in its form, and waits until the list has it. */
  async rename(from: string, to: string): Promise<void> {
    const start = this.page.getByRole("button", { name: "Edit", exact: true });
    if ((await start.count()) > 0 && (await start.getAttribute("aria-pressed")) === "false") await start.click();
    await this.select(from);
    const name = this.page.getByLabel("Name", { exact: true });
    await type(name, to);
    await name.press("Enter");
    await this.part(to);
  }

  /** Waits until a notice says something. */
  async says(words: string | RegExp): Promise<void> {
    await this.page.locator(".notice", { hasText: words }).waitFor();
  }
}

/** Whether a message of the browser is about the page: Playwright adds a style for each screenshot, which Firefox holds against the page's policy. */
export const isOfPage = (message: string): boolean => !isFirefox || !message.includes("style-src-elem");

interface InBrowser extends PageOptions {
  /** Messages of the browser that belong to the test. */
  readonly expected?: RegExp;
  readonly prepare?: (context: BrowserContext) => Promise<void>;
  /** What serves the folder. */
  readonly server?: typeof host;
}

/** Opens the program in the browser; what it reports that it should not is added to `wrong`. */
export async function openApp(onClose: (close: Close) => void, { expected = /^$/, prepare, server = host, ...options }: InBrowser = {}): Promise<{ app: App; wrong: () => string[] }> {
  const { address, stop } = await server(made(), onClose);
  const { page, wrong } = await open(await browserFor(options.reducedMotion ?? "reduce"), address, onClose, options, async (context) => {
    // A test cannot choose a file that the browser then lets the page at: without that, files are chosen and saved as in other browsers.
    await context.addInitScript(() => ["showOpenFilePicker", "showSaveFilePicker"].forEach((name) => delete (globalThis as unknown as Record<string, unknown>)[name]));
    await context.addInitScript(() => {
      addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI }) => console.error(`policy: ${violatedDirective} ${blockedURI}`));
    });
    if (isFirefox) await context.addInitScript(noteDownloads);
    await prepare?.(context);
  });
  return { app: new App(page, stop), wrong: () => wrong.filter((one) => !expected.test(one) && isOfPage(one)) };
}

/** A test of the program in a browser of its own; it fails at any error or violation of the policy that is not among those that it expects. */
export function inBrowser(name: string, run: (app: App) => Promise<void>, options: InBrowser = {}): void {
  test(name, { skip: options.server === byOkoshi ? skipServed : skip, timeout: TEST_LIMIT }, async (t) => {
    const { app, wrong } = await openApp(closing(t), options);
    await run(app);
    assert.deepEqual(wrong(), []);
  });
}
