// What the program in the browser shows before the module has come, and what somebody can do meanwhile.

import assert from "node:assert/strict";
import type { BrowserContext, Page } from "playwright-core";
import { inBrowser, STAGE } from "./app";
import { found } from "./axe";
import { picture, shown } from "./browser";
import { FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

/** What is asked for in a browser that keeps nothing is not kept for a next time either. */
const ALONE = { serviceWorkers: "block", expected: /Service Worker registration blocked/ } as const;

/** Keeps the module back until it is let go. */
function heldBack(): { prepare(context: BrowserContext): Promise<void>; letGo(): void } {
  let letGo = (): void => {};
  const gone = new Promise<void>((resolve) => (letGo = resolve));
  const prepare = async (context: BrowserContext): Promise<void> => {
    await context.route("**/okoshi_web_bg.wasm", async (route) => {
      await gone;
      await route.continue();
    });
  };
  return { prepare, letGo: () => letGo() };
}

const frames = (page: Page): Promise<number> => page.locator(STAGE).evaluate((canvas) => Number((canvas as HTMLElement).dataset["frames"]));

const module = heldBack();
inBrowser("before the module has come, a figure walks beside its drawing; what is chosen meanwhile opens when it is there", async ({ page }) => {
  await page.getByText("Drop an SVG here, or change this one.").waitFor();
  await page.locator(STAGE).waitFor();
  await page.waitForFunction((before) => Number(document.querySelector<HTMLElement>(".welcome-stage canvas")!.dataset["frames"]) > before + 3, await frames(page));
  await page.waitForFunction(() => document.querySelector<HTMLImageElement>(".welcome-drawing")!.naturalWidth > 0);
  await page.waitForFunction(() => [...document.querySelectorAll<HTMLImageElement>("[data-starter] img")].filter(({ naturalWidth }) => naturalWidth > 0).length >= 10);
  assert.match(await page.locator(".bar-link").innerText(), /Loading okoshi/);
  await page.getByRole("button", { name: "Change this one" }).click();
  // One click begins one drawing.
  assert.equal(await page.locator("[data-starter]:enabled").count(), 0);
  assert.equal(await page.getByRole("button", { name: "One moment…" }).isDisabled(), true);
  module.letGo();
  // It walks, so that it is never still.
  await page.waitForSelector(".studio canvas[data-revision]");
  assert.equal(await page.title(), "girl.svg · okoshi");
  assert.equal(await page.locator(".welcome").isVisible(), false);
  assert.equal(await page.locator(".welcome canvas").count(), 0);
  // Closed again, it is what it was.
  await page.getByRole("button", { name: "Close" }).click();
  await page.locator(STAGE).waitFor();
  assert.equal(await page.getByRole("button", { name: "Change this one" }).isEnabled(), true);
}, { ...ALONE, prepare: module.prepare, reducedMotion: "no-preference" });

inBrowser("the model is turned and stopped with keys, and the wheel scrolls the page", async ({ page }) => {
  await page.locator(STAGE).waitFor();
  const canvas = page.locator(".welcome-stage canvas");
  const view = (): Promise<string | null> => canvas.getAttribute("data-view");
  const before = await view();
  await canvas.focus();
  await page.keyboard.press("ArrowLeft");
  await page.waitForFunction((before) => document.querySelector<HTMLElement>(".welcome-stage canvas")!.dataset["view"] !== before, before);
  await page.keyboard.press(" ");
  await page.getByRole("button", { name: "Play" }).waitFor();
  await page.getByRole("button", { name: "Play" }).click();
  await page.getByRole("button", { name: "Pause" }).click();
  await page.getByRole("button", { name: "Play" }).waitFor();
  const turned = await view();
  await canvas.hover();
  await page.mouse.wheel(0, 200);
  await page.waitForFunction(() => document.querySelector(".gallery")!.scrollTop > 0);
  assert.equal(await view(), turned);
}, { ...ALONE, reducedMotion: "no-preference", viewport: { width: 1000, height: 500 } });

inBrowser("an example is begun like a drawing to start from, and is there again after a reload", async (app) => {
  const { page } = app;
  await page.locator("[data-starter=lamp]").click();
  await shown(page);
  assert.equal(await page.title(), "lamp.svg · okoshi");
  await page.reload();
  await shown(page);
  assert.equal(await page.title(), "lamp.svg · okoshi");
  // Begun anew, it stands once.
  await page.evaluate(() => (location.hash = "begin=lamp"));
  await page.waitForFunction(() => !location.hash.startsWith("#begin"));
  await page.evaluate(() => (location.hash = "begin=girl"));
  await page.waitForFunction(() => document.title === "girl.svg · okoshi");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("2 drawings").waitFor();
});

inBrowser("a drawing that the server does not have is said to be missing, and another one can be chosen", async ({ page }) => {
  await page.locator("[data-starter=dog]").click();
  await page.getByText("Nothing was written: the server has no dog.svg: it said 404.").waitFor();
  await page.locator("[data-starter=robot]").click();
  await shown(page);
  assert.equal(await page.title(), "robot.svg · okoshi");
}, { ...ALONE, expected: /Service Worker registration blocked|status of 404/, prepare: async (context) => void (await context.route("**/begin/dog.svg", (route) => route.fulfill({ status: 404 }))) });

inBrowser("an unknown name in a link is said to be none", async (app) => {
  const { page } = app;
  await page.locator("[data-starter]").first().waitFor();
  await page.evaluate(() => (location.hash = "begin=nothing"));
  await app.says("There is no drawing in this link");
  await page.evaluate(() => (location.hash = "begin=constructor"));
  await app.says("There is no drawing in this link");
});

inBrowser("who has drawings sees them, and nothing of the first visit is fetched", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: source(FIGURE) });
  await app.part("Arm");
  const asked: string[] = [];
  page.on("request", (request) => asked.push(request.url()));
  await page.reload();
  await app.part("Arm");
  await shown(page);
  assert.equal(await page.locator(".welcome").isVisible(), false);
  assert.deepEqual(asked.filter((url) => url.includes("/begin/")), []);
  assert.ok(asked.some((url) => url.endsWith(".wasm")));
}, ALONE);

inBrowser("without WebGL a picture stands for the model", async ({ page }) => {
  const still = page.locator(".welcome-still");
  await still.waitFor();
  await page.waitForFunction(() => document.querySelector<HTMLImageElement>(".welcome-still")!.naturalWidth > 0);
  await page.locator("[data-starter] img").first().waitFor();
  assert.equal(await page.locator(STAGE).count(), 0);
  assert.ok(await still.isVisible());
}, { ...ALONE, prepare: async (context) => {
  await context.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = (() => null) as typeof HTMLCanvasElement.prototype.getContext;
  });
} });

for (const { name, ...size } of SIZES) {
  for (const colorScheme of ["light", "dark"] as const) {
    inBrowser(`axe finds nothing on a first visit, and all of it is within the window: ${name}, ${colorScheme}`, async ({ page }) => {
      await page.locator(STAGE).waitFor();
      await page.locator("[data-starter] img").first().waitFor();
      await page.waitForFunction(() => document.querySelector<HTMLImageElement>(".welcome-drawing")!.naturalWidth > 0);
      await picture(page, `welcome-${name}-${colorScheme}`);
      assert.deepEqual(await found(page), []);
      assert.ok(await page.evaluate(() => document.querySelector(".gallery")!.scrollWidth <= innerWidth && document.documentElement.scrollWidth <= innerWidth));
      const { y, height } = (await page.locator(".welcome-change").boundingBox())!;
      assert.ok(y + height <= size.viewport.height, "the button is in sight");
    }, { ...ALONE, ...size, colorScheme });
  }
}
