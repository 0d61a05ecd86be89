// A drawing that is edited on the page that was just bundled, by the real program.

import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import type { Browser, Locator, Page } from "playwright-core";
import { launch, noBrowser, open, shown, type PageOptions } from "./browser";
import { closeAll, closing, PATIENCE, preview, TEST_LIMIT } from "./closing";
import { FIGURE } from "./setup";

const okoshi = process.env["OKOSHI"] ?? "";
const skip = noBrowser !== false ? noBrowser : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
const TYPES: Readonly<Record<string, string>> = { "": "page.html", "page.js": "page.js", "page.css": "page.css" };

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

export class Edited {
  constructor(readonly page: Page, readonly file: string) {}

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

  private async wait(holds: () => boolean): Promise<void> {
    const end = Date.now() + PATIENCE;
    while (!holds() && Date.now() < end) await new Promise((resolve) => setTimeout(resolve, 20));
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

/** A test with a drawing that is edited. The page is the one that was bundled for the tests, and is served as the program serves its own. */
export function edit(name: string, run: (edited: Edited) => Promise<void>, options: PageOptions & { drawing?: string; arguments?: readonly string[] } = {}): void {
  test(name, { skip, timeout: TEST_LIMIT }, async (t) => {
    const onClose = closing(t);
    const { drawing = FIGURE, arguments: more = [], ...context } = options;
    const folder = mkdtempSync(join(tmpdir(), "okoshi-edit-"));
    onClose(() => rmSync(folder, { recursive: true }));
    const file = join(folder, "figure.svg");
    copyFileSync(drawing, file);
    const { address } = await preview(okoshi, folder, "figure.svg", onClose, more);
    // To the browser, a page that a test hands over is not on this machine, and would not be let to it.
    browser ??= launch(["--disable-features=LocalNetworkAccessChecks"]);
    const { page, wrong } = await open(await browser, address, onClose, context, async (context) => {
      for (const [path, name] of Object.entries(TYPES)) {
        await context.route(address + path, async (route) => {
          const { "content-length": _, ...headers } = (await route.fetch()).headers();
          await route.fulfill({ headers, body: readFileSync(join("dist", name)) });
        });
      }
    });
    await shown(page, 1);
    await run(new Edited(page, file));
    // What is refused is answered with a status that the browser reports.
    assert.deepEqual(wrong.filter((one) => !/status of 409/.test(one)), []);
  });
}
