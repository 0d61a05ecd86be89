// The editor of strings beside the model, in the program in the browser.

import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { inBrowser, type App } from "./app";
import { found } from "./axe";
import { overlaps, picture, shown } from "./browser";
import { FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

const TEXT = source(FIGURE);
const lines = (page: Page) => page.locator(".strings-editor .cm-line");

/** Opens a drawing and its strings. */
async function begin(app: App, text = TEXT): Promise<void> {
  const { page } = app;
  await app.drop({ name: "figure.svg", text });
  await shown(page);
  const opener = page.locator(".drawer-opener");
  if (await opener.isVisible()) await opener.click();
  await page.getByRole("button", { name: "Strings" }).and(page.locator(":visible")).click();
  await lines(page).filter({ hasText: /^(Arm|Wing)@/ }).waitFor();
}

/** Puts the cursor behind a word of a line. */
async function goBehind(page: Page, line: RegExp, steps: number): Promise<void> {
  await lines(page).filter({ hasText: line }).click();
  await page.keyboard.press("Home");
  for (let step = 0; step < steps; step++) await page.keyboard.press("ArrowRight");
}

inBrowser("a string is typed: the model follows, one undo takes it back, and it is saved", async (app) => {
  const { page } = app;
  await begin(app);
  await shown(page);
  await goBehind(page, /^Arm@/, 3);
  await page.keyboard.type("let");
  await app.page.getByRole("button", { name: "Undo: the string Armlet@Body" }).waitFor();
  await page.locator(".inspector .part-name", { hasText: "Armlet" }).waitFor();
  // Letters that are shortcuts of the page are letters here: `l` shows the layers.
  assert.equal(await page.getByRole("button", { name: "Layers from the side", includeHidden: true }).getAttribute("aria-pressed"), "false");
  const { text } = await app.saved(() => page.keyboard.press("Control+s"));
  assert.equal(text, TEXT.replace("Arm@", "Armlet@"));
  // Enter adds no line; neither does what is pasted.
  const count = await lines(page).count();
  await page.keyboard.press("Enter");
  await page.keyboard.press("Shift+ArrowDown");
  await page.keyboard.press("Delete");
  assert.equal(await lines(page).count(), count);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Control+z");
  await page.getByRole("button", { name: "Undo", exact: true }).and(page.locator(":disabled")).waitFor();
  await lines(page).filter({ hasText: /^Arm@/ }).waitFor();
  assert.equal((await app.saved(() => page.keyboard.press("Control+s"))).text, TEXT);
  await page.keyboard.press("Control+Shift+Z");
  await lines(page).filter({ hasText: /^Armlet@/ }).waitFor();
});

inBrowser("a mistake is underlined, explained and mended by a fix", async (app) => {
  const { page } = app;
  await begin(app, TEXT.replace("Arm@Body", "Arm@Bdoy"));
  await page.locator(".cm-lintRange", { hasText: "Bdoy" }).waitFor();
  await goBehind(page, /^Arm@/, 5);
  await page.locator(".strings-problem", { hasText: "There is no part named Bdoy. The name after" }).waitFor();
  await picture(page, "strings-problem");
  await page.locator(".strings-notes").getByRole("button", { name: /Body/ }).click();
  await lines(page).filter({ hasText: /^Arm@Body/ }).waitFor();
  await page.locator(".cm-lintRange").waitFor({ state: "detached" });
  assert.equal((await app.saved(() => page.keyboard.press("Control+s"))).text, TEXT);
  // A mistake that is typed is underlined, too.
  await goBehind(page, /^Arm@/, 8);
  await page.keyboard.type("x");
  await page.locator(".cm-lintRange", { hasText: "Bodyx" }).waitFor();
});

inBrowser("keywords and parts are proposed, and a word is explained where the mouse is", async (app) => {
  const { page } = app;
  await begin(app);
  await goBehind(page, /^Arm@/, 4);
  await page.keyboard.press("Delete");
  await page.keyboard.press("Delete");
  await page.keyboard.press("Delete");
  await page.keyboard.press("Delete");
  await page.keyboard.type("B");
  const proposal = page.locator(".cm-tooltip-autocomplete li");
  await proposal.filter({ hasText: "Body" }).first().waitFor();
  await picture(page, "strings-proposals");
  await page.keyboard.press("Enter");
  await lines(page).filter({ hasText: /^Arm@Body/ }).waitFor();
  await page.keyboard.press("End");
  await page.keyboard.type(" Tex");
  await proposal.filter({ hasText: "Texture" }).first().waitFor();
  await page.keyboard.press("Escape");
  await page.keyboard.press("Control+z");
  // Whether what was typed is undone before the mouse rests or after that.
  for (const typed of ["", "x"]) {
    await page.mouse.move(5, 5);
    await page.locator(".cm-tooltip-hover").waitFor({ state: "detached" });
    const box = (await lines(page).filter({ hasText: /^Arm@/ }).boundingBox())!;
    await page.keyboard.type(typed);
    await page.mouse.move(box.x + 22, box.y + 14, { steps: 4 });
    await page.locator(".cm-tooltip-hover .described", { hasText: "Arm" }).waitFor();
    if (typed !== "") await page.keyboard.press("Control+z");
    await lines(page).filter({ hasText: /^Arm@Body\$Shape default -8 8 Bend 0$/ }).waitFor();
    assert.ok(await page.locator(".cm-tooltip-hover").isVisible());
  }
  await picture(page, "strings-hover");
});

inBrowser("the part of a string is selected, and the string of a part is marked", async (app) => {
  const { page } = app;
  await begin(app);
  await goBehind(page, /^Arm@/, 1);
  await page.locator(".inspector .part-name", { hasText: "Arm" }).waitFor();
  await page.locator(".cm-of-part", { hasText: /^Arm@/ }).waitFor();
  await page.getByRole("button", { name: "Strings" }).click();
  await page.locator("[data-part=Body]").click();
  await page.getByRole("button", { name: "Strings" }).click();
  await page.locator(".cm-of-part", { hasText: /^Body/ }).waitFor();
  assert.equal(await page.locator(".cm-of-part").count(), 1);
});

for (const { name, ...size } of SIZES) {
  inBrowser(`axe finds nothing in the strings, and they have room: ${name}`, async (app) => {
    const { page } = app;
    await begin(app, TEXT.replace("Arm@Body", "Arm@Bdoy"));
    await goBehind(page, /^Arm@/, 5);
    await page.locator(".strings-problem").waitFor();
    await picture(page, `strings-${name}`);
    assert.deepEqual(await found(page), []);
    if (!(await page.locator(".drawer-head").isVisible())) assert.deepEqual(await overlaps(page), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    assert.ok((await page.locator(".strings-editor").boundingBox())!.height >= 60, "at least two lines are seen");
  }, size);
}
