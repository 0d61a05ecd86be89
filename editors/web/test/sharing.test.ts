// Sharing in the program in the browser: links that hold a drawing, and pages that play its model.

import assert from "node:assert/strict";
import { randomBytes } from "node:crypto";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import type { Page } from "playwright-core";
import { browserFor, inBrowser, isOfPage } from "./app";
import { found } from "./axe";
import { picture, shown } from "./browser";
import { FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

const TEXT = source(FIGURE);
const MOTIONS = join("..", "..", "examples", "motion");

async function exported(page: Page, choice: string): Promise<void> {
  const opener = page.getByRole("button", { name: "More tools" });
  if (await opener.isVisible()) await opener.click();
  await page.getByRole("button", { name: "Export" }).click();
  await page.getByRole("menuitem", { name: choice }).click();
}

/** The link to the drawing that is shown. */
async function link(page: Page): Promise<string> {
  await exported(page, "Link");
  const field = page.getByRole("textbox", { name: "Link to " });
  const link = await field.inputValue();
  await page.keyboard.press("Escape");
  await field.waitFor({ state: "detached" });
  return link;
}

inBrowser("a link opens its drawing for whoever has it, beside what is there, and nothing of that is lost", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.part("Arm");
  await app.rename("Arm", "Wing");
  const shared = await link(page);
  const address = page.url().replace(/#.*/, "");

  // Somebody else has no files.
  const other = await (await page.context().browser()!.newContext()).newPage();
  await other.goto(shared);
  await other.locator('[data-part="Wing"]').waitFor();
  assert.equal(await other.title(), "figure.svg · okoshi");
  assert.ok(!other.url().includes("drawing="), "the link is opened once");
  await other.context().close();

  // The drawing was changed here since: that stays, also after a reload.
  await app.rename("Wing", "Fin");
  await page.goto(shared);
  await app.part("Wing");
  assert.equal(await page.title(), "figure-2.svg · okoshi");
  // Opened again, it is the same drawing.
  await page.goto(shared);
  await page.waitForFunction(() => location.hash === "#figure-2.svg");
  await page.reload();
  await app.part("Wing");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("2 drawings").waitFor();
  await page.locator(".card", { has: page.getByText("figure.svg", { exact: true }) }).click();
  await app.part("Fin");
  assert.equal((await app.saved(() => page.getByRole("button", { name: "Save" }).click())).text, TEXT.replaceAll("Arm@", "Fin@"));

  // A page that is opened by a link brings back what the browser kept, too.
  await page.goto("about:blank");
  await page.goto(await page.evaluate((link) => link, shared.replace("name=figure.svg", "name=new.svg")));
  await app.part("Wing");
  assert.equal(await page.title(), "new.svg · okoshi");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("3 drawings").waitFor();
  assert.equal(page.url().replace(/#.*/, ""), address);
});

inBrowser("a link without a drawing is said to be one, and the drawings are as they were", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.part("Arm");
  await app.rename("Arm", "Wing");
  const good = await link(page);
  await page.goto(good.slice(0, -20));
  await app.says("There is no drawing in this link: it was cut off or changed on its way.");
  await picture(page, "share-bad");
  await app.part("Wing");
  assert.equal(await page.title(), "figure.svg · okoshi");
  await page.goto("about:blank");
  await page.goto(good.slice(0, -20));
  await app.says("There is no drawing in this link");
  await app.part("Wing");
  assert.equal(await page.title(), "figure.svg · okoshi");
  // What is no drawing, but was packed well, is shown as any other file with errors.
  await page.evaluate(async () => {
    const packed = await new Response(new Blob(["<script>alert(1)</script>"]).stream().pipeThrough(new CompressionStream("deflate"))).arrayBuffer();
    location.hash = `#name=bad.svg&drawing=${btoa(String.fromCharCode(...new Uint8Array(packed))).replaceAll("+", "-").replaceAll("/", "_")}`;
  });
  await page.waitForSelector(".findings[data-open=true]");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("2 drawings").waitFor();
});

inBrowser("a drawing that does not fit into a link, or links to files, is offered as files", async (app) => {
  const { page } = app;
  await app.drop({ name: "kick.svg", text: source(join(MOTIONS, "kick.svg")) }, { name: "kick.bvh", text: source(join(MOTIONS, "kick.bvh")) });
  await page.locator(".clips", { hasText: "kick" }).waitFor();
  await shown(page);
  await exported(page, "Link");
  await page.getByText("kick.svg links to kick.bvh, and a link holds the drawing alone.").waitFor();
  await picture(page, "share-files");
  const saved = await app.saved(() => page.getByRole("button", { name: "Save a page (HTML)" }).click());
  assert.equal(saved.name, "kick.html");
  await app.drop({ name: "figure.svg", text: TEXT.replace("</svg>", `<!-- ${randomBytes(30_000).toString("base64")} --></svg>`) });
  await app.part("Arm");
  await exported(page, "Link");
  await page.getByText(/figure\.svg is too large for a link: it takes \d\d,\d{3} letters/).waitFor();
  const { name, text } = await app.saved(() => page.getByRole("button", { name: "Save the drawing (SVG)" }).click());
  assert.equal(name, "figure.svg");
  assert.ok(text.includes("Arm@"));
});

inBrowser("a page that plays the model needs nothing else", async (app) => {
  const { page } = app;
  await app.drop({ name: "kick.svg", text: source(join(MOTIONS, "kick.svg")) }, { name: "kick.bvh", text: source(join(MOTIONS, "kick.bvh")) });
  await page.locator(".clips", { hasText: "kick" }).waitFor();
  await shown(page);
  await page.getByRole("button", { name: "Side view" }).click();
  const { text } = await app.saved(() => exported(page, "Page (HTML)"));
  const folder = mkdtempSync(join(tmpdir(), "okoshi-page-"));
  try {
    const file = join(folder, "kick.html");
    writeFileSync(file, text);
    for (const { name, ...size } of SIZES) {
      const context = await (await browserFor("no-preference")).newContext(size);
      const other = await context.newPage();
      const wrong: string[] = [];
      const asked: string[] = [];
      other.on("pageerror", (error) => wrong.push(String(error)));
      other.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
      other.on("request", (request) => /^(file|https?):/.test(request.url()) && asked.push(request.url()));
      await context.addInitScript(() => (WebGL2RenderingContext.prototype.fenceSync = () => null));
      await other.goto(pathToFileURL(file).href);
      await other.getByRole("application", { name: /^Model of kick: / }).waitFor();
      assert.equal(await other.title(), "kick");
      // It plays, and stops.
      const time = other.getByLabel("Time");
      const before = await time.inputValue();
      await other.waitForFunction((before) => document.querySelector<HTMLInputElement>(".slider")!.value !== before, before);
      await other.keyboard.press(" ");
      await other.getByRole("button", { name: "Play" }).waitFor();
      const looked = await other.locator("canvas").getAttribute("data-view");
      // It is seen from where it was seen when the page was made: from its left.
      const [tx, , tz, x, , z] = looked!.split(" ").map(Number) as [number, number, number, number, number, number];
      assert.ok(x - tx > 5 * Math.abs(z - tz), looked!);
      await other.keyboard.press("ArrowLeft");
      await other.waitForFunction((looked) => document.querySelector<HTMLElement>("canvas")!.dataset["view"] !== looked, looked);
      await picture(other, `share-page-${name}`);
      assert.deepEqual(await found(other).catch((error: unknown) => [String(error)]), []);
      assert.deepEqual([wrong.filter(isOfPage), asked.filter((url) => url !== pathToFileURL(file).href)], [[], []]);
      await context.close();
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
});

for (const { name, ...size } of SIZES) {
  inBrowser(`axe finds nothing in what is said about a link: ${name}`, async (app) => {
    const { page } = app;
    await app.drop({ name: "figure.svg", text: TEXT });
    await shown(page);
    await exported(page, "Link");
    await page.getByRole("textbox", { name: "Link to figure.svg" }).waitFor();
    await page.getByRole("button", { name: "Copy" }).click();
    await page.getByText(/Copied\.|It is selected/).waitFor();
    await picture(page, `share-link-${name}`);
    assert.deepEqual(await found(page), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  }, size);
}

inBrowser("a moving picture is made while the drawing is changed", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: TEXT });
  await shown(page);
  const { name, text } = await app.saved(async () => {
    await exported(page, "Moving picture (GIF)");
    await app.rename("Arm", "Wing");
  });
  assert.equal(name, "figure.gif");
  // Its first bytes and its last.
  assert.deepEqual([text.slice(0, 6), text.at(-1)], ["GIF89a", ";"]);
});
