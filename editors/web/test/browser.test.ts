import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Browser } from "playwright-core";
import { camera, CHROMIUM, launch, open, picture, shown } from "./browser";
import { make } from "./drawings";
import { MockHost } from "./mock";

const okoshi = process.env["OKOSHI"] ?? "";
const skip = !CHROMIUM ? "there is no Chromium; CHROMIUM names one" : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
const examples = join("..", "..", "examples");
const source = (name: string): string => readFileSync(join(examples, `${name}.svg`), "utf8");
const example = (name: string) => make(okoshi, source(name), join(examples, `${name}.svg`));

let browser: Browser;
before(async () => {
  if (!skip) browser = await launch();
});
after(async () => browser?.close());

test("first look", { skip }, async () => {
  const host = new MockHost("dist");
  host.add("human", "human.svg");
  host.built("human", example("human"));
  await host.start();
  const { page, wrong } = await open(browser, host.address);
  await shown(page);
  await page.locator("[data-part=Rarm]").click();
  console.log(await camera(page));
  await picture(page, "wide");
  host.built("human", make(okoshi, source("human").replaceAll("@Ubody", "@Ubdoy"), join(examples, "human.svg")));
  await page.waitForTimeout(500);
  await picture(page, "errors");
  assert.deepEqual(wrong, []);
  await page.close();
  await host.stop();
});
