// The menu of a part: by a right click, a long press and the menu key, with the real program.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { AxeResults } from "axe-core";
import type { Page } from "playwright-core";
import { picture, project, still } from "./browser";
import { edit } from "./edited";
import { FIGURE, source } from "./setup";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const BEFORE = source(FIGURE);

const menu = (page: Page) => page.locator(".part-menu");
const item = (page: Page, name: string | RegExp) => page.getByRole("menuitem", { name });

/** The middle of the arm, seen from the front. */
async function arm(page: Page): Promise<{ x: number; y: number }> {
  await page.locator("canvas").focus();
  await page.keyboard.press("1");
  await still(page);
  return project(page, (215 - 180) / 100, (200 - 120) / 100, 0.08);
}

edit("a right click on a part opens its menu, and what is chosen is done", async (edited) => {
  const { page } = edited;
  const { x, y } = await arm(page);
  await page.mouse.click(x, y, { button: "right" });
  await menu(page).waitFor();
  assert.equal(await menu(page).locator(".menu-title").innerText(), "Arm");
  await page.locator("[data-part=Arm][aria-selected=true]").waitFor();
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => (globalThis as unknown as { axe: { run(): Promise<AxeResults> } }).axe.run());
  assert.deepEqual(violations.map(({ id }) => id), []);
  await picture(page, "part-menu");
  // The page's own keys wait while it is open.
  await page.keyboard.press("w");
  assert.equal(await page.locator(".editbar").isVisible(), false);
  await page.keyboard.press("Escape");
  assert.equal(await menu(page).isVisible(), false);
  assert.equal(await page.evaluate(() => document.activeElement?.tagName), "CANVAS");

  // A drag with the right button moves the view, and opens nothing.
  const view = await page.getAttribute("canvas", "data-view");
  await page.mouse.move(x, y);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(x + 40, y + 10, { steps: 4 });
  await page.mouse.up({ button: "right" });
  assert.notEqual(await page.getAttribute("canvas", "data-view"), view);
  assert.equal(await menu(page).isVisible(), false);

  await page.locator("[data-part=Head]").click({ button: "right" });
  await item(page, /^Hide/).click();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["hidden"] === "Head");
  await page.locator("[data-part=Head]").click({ button: "right" });
  await item(page, /^Show all/).click();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["hidden"] === "");

  // What changes the drawing turns editing on.
  await page.locator("[data-part=Arm]").click({ button: "right" });
  await item(page, /^Hang on/).click();
  await page.getByText("Click what Arm hangs on").waitFor();
  await page.locator("[data-part=Head]").click();
  const hung = BEFORE.replace("Arm@Body", "Arm@Head");
  await edited.has(hung, "hung on the head");
  await page.locator("[data-part=Arm]").click({ button: "right" });
  await item(page, /^Rename/).click();
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Name");
  await page.keyboard.type("Paw");
  await page.keyboard.press("Enter");
  await edited.has(hung.replace("Arm@", "Paw@"), "renamed");
});

edit("the menu key opens the menu of the selected part, and its keys go through it", async (edited) => {
  const { page } = edited;
  await page.locator("[data-part=Arm]").click();
  await page.locator("canvas").focus();
  await page.keyboard.press("Shift+F10");
  await menu(page).waitFor();
  assert.match(await page.evaluate(() => document.activeElement?.textContent ?? ""), /^Rename/);
  await page.keyboard.press("End");
  assert.match(await page.evaluate(() => document.activeElement?.textContent ?? ""), /^Show only/);
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Color: swatch");
  assert.equal(edited.text(), BEFORE);
});

edit("a long press opens the menu, and read-only pages offer only what changes nothing", async (edited) => {
  const { page } = edited;
  const { x, y } = await arm(page);
  const session = await page.context().newCDPSession(page);
  await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [{ x, y }] });
  await menu(page).waitFor();
  await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  assert.deepEqual((await menu(page).getByRole("menuitem").locator("span").allInnerTexts()), ["Frame", "Hide", "Show only this part"]);
  const box = (await menu(page).boundingBox())!;
  assert.ok(box.x >= 0 && box.x + box.width <= 390 && box.y + box.height <= 844);
  await picture(page, "part-menu-phone");
  await item(page, /^Hide/).tap();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["hidden"] === "Arm");
}, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, arguments: ["--read-only"] });
