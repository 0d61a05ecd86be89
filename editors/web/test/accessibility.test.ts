// axe finds nothing, in any state of the page.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { found } from "./axe";
import type { Page } from "playwright-core";
import { noBrowser, shown, still } from "./browser";
import { kick } from "./kick";
import { performed, puppet } from "./performed";
import { browse, build, example } from "./setup";
import type { MockHost } from "./mock";
import { SIZES } from "./sizes";

const HUMAN = example("human");
const okoshi = process.env["OKOSHI"] ?? "";
const punch = okoshi && !noBrowser ? await performed(okoshi, puppet('%Motion punch Perform "hands.json" Limited 2 12')) : null;

function prepare(host: MockHost): void {
  host.add("human.svg");
  host.built("human.svg", build(HUMAN));
  host.add("kick.svg");
  host.built("kick.svg", kick());
}

for (const colorScheme of ["light", "dark"] as const) {
  // In the dark only the colours are others.
  for (const { name, ...size } of SIZES.filter(({ name }) => colorScheme === "light" || name === "phone" || name === "desktop")) {
    const small = name !== "desktop";
    const is = async (page: Page, state: string): Promise<void> => assert.deepEqual(await found(page), [], state);
    const press = async (page: Page, key: string): Promise<void> => {
      await page.locator("canvas").focus();
      await page.keyboard.press(key);
      await still(page);
    };

    browse(`axe finds nothing: drawings to start from, ${name}, ${colorScheme}`, (host) => {
      host.offered = { key: "a key", names: ["girl", "dog", "empty"], picture: readFileSync(join("..", "..", "docs", "gallery", "girl-model.png")) };
    }, async (page, host) => {
      await page.locator("[data-starter=girl] img").waitFor();
      await is(page, "offered");
      await page.locator("[data-starter=girl]").click();
      host.say({ type: "unbegun", why: "there is no space left" });
      await page.getByText("Nothing was written").waitFor();
      await is(page, "not begun");
    }, { ...size, colorScheme });

    browse(`axe finds nothing: the gallery and a drawing, ${name}, ${colorScheme}`, prepare, async (page, host) => {
      await page.locator("[data-drawing='human.svg'] img").waitFor();
      await is(page, "gallery");
      await page.locator("[data-drawing='human.svg']").click();
      await shown(page);
      await is(page, "drawing");
      if (small) {
        await page.getByRole("button", { name: "More tools" }).click();
        await is(page, "tools");
        await page.keyboard.press("Escape");
      }
      await page.keyboard.press("t");
      await page.keyboard.press("Enter");
      await is(page, "parts");
      if (small) {
        await page.getByRole("group", { name: "Shown" }).getByRole("button").last().click();
        await is(page, "part");
        await page.keyboard.press("Escape");
      }
      await page.keyboard.press("h");
      await is(page, "hidden parts");
      await page.keyboard.press("/");
      await page.keyboard.type("e");
      await is(page, "search, and hidden parts");
      await page.keyboard.type("nothing");
      await is(page, "nothing found");
      if (small) await page.getByRole("button", { name: "Close the parts" }).click();
      await press(page, "?");
      await is(page, "help");
      await page.keyboard.press("Escape");
      if (small) await page.getByRole("button", { name: "More tools" }).click();
      await page.getByRole("button", { name: "Export" }).click();
      await is(page, "menu");
      await page.keyboard.press("Escape");
      await press(page, "p");
      await is(page, "pose bar");
      await press(page, "p");
      await press(page, "l");
      await is(page, "layers");
      await press(page, "l");
      await press(page, "r");
      await page.getByRole("dialog").waitFor();
      await is(page, "camera panel");
      await page.keyboard.press("Escape");
      host.built("human.svg", build(HUMAN, (text) => text.replaceAll("@Ubody", "@Ubdoy")));
      await page.waitForSelector(".findings[data-open=true]");
      await is(page, "problems");
      host.gone("human.svg");
      await page.getByText("The drawing's file is missing").waitFor();
      await is(page, "missing");
    }, { ...size, colorScheme });

    browse(`axe finds nothing: clips and charts, ${name}, ${colorScheme}`, (host) => {
      host.add("punch.svg");
      if (punch) host.built("punch.svg", punch);
    }, async (page) => {
      await shown(page);
      await is(page, "clip");
      if (await page.getByRole("button", { name: "More about the clip" }).isVisible()) {
        await page.getByRole("button", { name: "More about the clip" }).click();
        await is(page, "more about the clip");
        await page.keyboard.press("Escape");
      }
      await press(page, "c");
      await page.locator(".chart").waitFor();
      await is(page, "chart");
      await press(page, "i");
      await page.locator(".performance").waitFor();
      await is(page, "performance");
      await press(page, "o");
      await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
      await press(page, "n");
      await is(page, "side by side, with an onion skin");
    }, { ...size, colorScheme });
  }
}
