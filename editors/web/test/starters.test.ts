// What a page offers while its folder has no drawings.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { shown } from "./browser";
import type { MockHost } from "./mock";
import { browse, build, FIGURE } from "./setup";

const PICTURE = readFileSync(join("..", "..", "docs", "gallery", "girl-model.png"));
const offer = (host: MockHost): void => {
  host.offered = { key: "a key", names: ["girl", "dog", "empty"], picture: PICTURE };
};

browse("an empty folder offers starters; one that is chosen is begun and opens", offer, async (page, host) => {
  await page.waitForFunction(() => document.querySelectorAll("[data-starter] img").length === 2);
  assert.match(await page.locator(".gallery").innerText(), /^Begin with a drawing\s.*\s+girl\s+A girl\s+dog\s+A dog\s+empty\s+A empty$/s);
  // An empty page has an icon.
  assert.equal(await page.locator("[data-starter=empty] .icon").count(), 1);
  await page.locator("[data-starter=dog]").focus();
  await page.keyboard.press("Enter");
  assert.deepEqual(await host.messages("begin", 1), [{ type: "begin", key: "a key", starter: "dog" }]);
  // No second one until it is known what became of the first.
  assert.equal(await page.locator("[data-starter]:enabled").count(), 0);
  host.say({ type: "unbegun", why: "there is no space left" });
  await page.getByText("Nothing was written: there is no space left.").waitFor();
  await page.locator("[data-starter=girl]").click();
  assert.deepEqual((await host.messages("begin", 2))[1], { type: "begin", key: "a key", starter: "girl" });
  host.add("girl.svg");
  host.built("girl.svg", build(FIGURE));
  await shown(page);
  assert.equal(await page.locator(".gallery").isVisible(), false);
});

browse("starters are offered anew by a program that was started anew", offer, async (page, host) => {
  await page.locator("[data-starter=girl]").click();
  await host.messages("begin", 1);
  await host.stop();
  host.offered = { key: "another key", names: ["dog"], picture: PICTURE };
  await host.start();
  await page.locator("[data-starter=girl]").waitFor({ state: "detached" });
  await page.locator("[data-starter=dog]").click();
  assert.deepEqual((await host.messages("begin", 2))[1], { type: "begin", key: "another key", starter: "dog" });
});

browse("where there are drawings, or nothing is offered, there are no starters", (host) => {
  offer(host);
  for (const name of ["a.svg", "b.svg"]) host.add(name);
}, async (page) => {
  await page.getByText("2 drawings").waitFor();
  assert.equal(await page.locator(".starters").isVisible(), false);
});

browse("a folder without drawings and without an offer says where drawings appear", () => {}, async (page) => {
  await page.getByText("Drawings saved in the folder appear here.").waitFor();
  assert.equal(await page.locator("[data-starter]").count(), 0);
});
