// Shared by the browser tests: one Chromium, drawings, and a host for each test.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import type { Browser, Page } from "playwright-core";
import { DIST, launch, noBrowser, open, type Colour, type PageOptions } from "./browser";
import { closeAll, closing, TEST_LIMIT } from "./closing";
import { make, type Made } from "./drawings";
import { MockHost } from "./mock";

const okoshi = process.env["OKOSHI"] ?? "";
export const skip = noBrowser !== false ? noBrowser : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;

const examples = join("..", "..", "examples");
export const FIGURE = join("test", "figure.svg");
export const example = (name: string): string => join(examples, `${name}.svg`);
export const source = (file: string): string => readFileSync(file, "utf8");

const made = new Map<string, Made>();
/** The build of a drawing, optionally with its text changed. */
export function build(file: string, change: (text: string) => string = (text) => text): Made {
  const text = change(source(file));
  const key = `${file}\n${text}`;
  let one = made.get(key);
  if (!one) made.set(key, (one = make(okoshi, text, file)));
  return one;
}

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

/** A test of the page with its own host. Any error of the page fails it, including violations of the policy. */
export function browse(name: string, prepare: (host: MockHost) => void, run: (page: Page, host: MockHost) => Promise<void>, options: PageOptions & { hash?: string } = {}): void {
  test(name, { skip, timeout: TEST_LIMIT }, async (t) => {
    const onClose = closing(t);
    browser ??= launch();
    const host = new MockHost(DIST);
    prepare(host);
    await host.start();
    onClose(() => host.stop());
    const { hash = "", ...context } = options;
    const { page, wrong } = await open(await browser, host.address + hash, onClose, context);
    await run(page, host);
    assert.deepEqual(wrong, []);
  });
}

/** Prepares a host with one drawing. */
export const one = (file: string, id = file.replace(/^.*[\\/]/, "")) => (host: MockHost): void => {
  host.add(id);
  host.built(id, build(file));
};

/** Whether a colour is clearly the drawn one: a little darker or lighter from the lights, but of the same hue. */
export function isLike(seen: Colour, drawn: Colour, most = 60): boolean {
  return seen.every((value, at) => Math.abs(value - drawn[at]!) <= most);
}

export function assertLike(seen: Colour, drawn: Colour, what: string, most?: number): void {
  assert.ok(isLike(seen, drawn, most), `${what} is rgb(${seen.join(" ")}), not like rgb(${drawn.join(" ")})`);
}
