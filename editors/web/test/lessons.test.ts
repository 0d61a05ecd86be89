// The page of lessons that is beside the program in the browser, and the drawings that it opens.

import assert from "node:assert/strict";
import { extractText } from "unpdf";
import { inBrowser } from "./app";
import { found } from "./axe";
import { picture, shown } from "./browser";
import { SIZES } from "./sizes";

inBrowser("the program leads to the lessons, and each of their drawings opens by a click", async ({ page }) => {
  const asked: string[] = [];
  page.on("request", (request) => asked.push(request.url()));
  const { origin } = new URL(page.url());
  await page.getByRole("link", { name: "Lessons" }).click();
  await page.getByRole("heading", { level: 1 }).waitFor();
  assert.equal(await page.title(), "Lessons · okoshi");
  assert.equal(await page.locator("section h2").count(), 5);
  const pictures = await page.locator("img").evaluateAll((images) => (images as HTMLImageElement[]).map(({ naturalWidth, alt, src }) => [src, naturalWidth > 100 && alt.length > 10] as const));
  assert.ok(pictures.length >= 15, `only ${pictures.length} pictures`);
  assert.deepEqual(pictures.filter(([, isShown]) => !isShown), []);
  // Those to other lessons stay on the page.
  for (const link of await page.locator('a[href^="#"]').all()) assert.equal(await page.locator(`[id="${(await link.getAttribute("href"))!.slice(1)}"]`).count(), 1);
  const links = await page.locator("a.opens").evaluateAll((all) => all.map((one) => one.getAttribute("href")!));
  assert.ok(links.length >= 10, `only ${links.length} drawings`);
  assert.deepEqual(asked.filter((url) => new URL(url).origin !== origin), []);

  await page.locator("a.opens").first().click();
  for (const [at, link] of links.entries()) {
    const name = /^\.\/#begin=([a-z0-9-]+)$/.exec(link)![1]!;
    if (at > 0) await page.evaluate((name) => (location.hash = `begin=${name}`), name);
    await page.waitForFunction((title) => document.title === title, `${name}.svg · okoshi`);
    await page.locator("[data-part], .tree").first().waitFor();
    assert.equal(await page.locator(".notice").count(), 0);
  }
  await shown(page);
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText(`${new Set(links).size} drawings`).waitFor();
  await page.waitForFunction((number) => document.querySelectorAll(".card img").length === number, new Set(links).size);
});

inBrowser("each lesson begins a page when it is printed, and what leads back to the program is left out", async ({ page }) => {
  await page.goto(new URL("lessons.html", page.url()).href);
  const headings = await page.locator("section h2").allInnerTexts();
  const drawings = await page.locator("a.opens").allInnerTexts();
  const back = await page.locator("header").innerText();
  const { text } = await extractText(new Uint8Array(await page.pdf()));
  const pages = text.map((text) => text.replace(/\s+/g, " ").trim());
  const begun = headings.map((heading) => pages.findIndex((text) => text.startsWith(heading)));
  assert.deepEqual(begun.filter((at, lesson) => at <= (begun[lesson - 1] ?? 0)), [], pages.join("\n"));
  assert.deepEqual(drawings.filter((name) => !pages.some((text) => text.includes(name))), []);
  assert.deepEqual(pages.filter((text) => text.startsWith(back)), []);
});

for (const { name, ...size } of SIZES) {
  for (const colorScheme of ["light", "dark"] as const) {
    inBrowser(`axe finds nothing in the lessons, and nothing is wider than the window: ${name}, ${colorScheme}`, async ({ page }) => {
      await page.goto(new URL("lessons.html", page.url()).href);
      await picture(page, `lessons-${name}-${colorScheme}`);
      assert.deepEqual(await found(page), []);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    }, { ...size, colorScheme });
  }
}
