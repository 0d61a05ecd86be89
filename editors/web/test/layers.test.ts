import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { camera, manual, overlaps, picture, project, shown, still } from "./browser";
import { browse, example, one } from "./setup";

const DOLL = example("doll");
const phone = { viewport: { width: 380, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 } as const;
const press = async (page: Page, key: string): Promise<void> => {
  await page.locator("canvas").focus();
  await page.keyboard.press(key);
  await still(page);
};
const note = (page: Page) => page.locator(".layers-note").innerText();

browse("L shows the layers from the side, and goes back to the view before", one(DOLL), async (page) => {
  await shown(page);
  await press(page, "ArrowLeft");
  await press(page, "+");
  const before = await camera(page);
  assert.equal(await page.locator(".layers").isVisible(), false);
  await press(page, "l");
  assert.equal(await page.getAttribute("canvas", "data-layers"), "shown");
  const words = (await camera(page)).split(" ");
  const [tx, ty, tz, px, py, pz] = words.map(Number) as [number, number, number, number, number, number];
  assert.equal(words.at(-1), "parallel");
  assert.ok(px > tx && Math.abs(py - ty) < 1e-3 && Math.abs(pz - tz) < 1e-3, "exactly from the side");
  assert.match(await note(page), /^Choose a part/);
  assert.equal(await page.getByRole("button", { name: "Layers from the side" }).getAttribute("aria-pressed"), "true");
  await press(page, "l");
  assert.equal(await camera(page), before);
  assert.equal(await page.locator(".layers").isVisible(), false);
});

browse("a part under the pointer shows its depth and the reason", one(DOLL), async (page) => {
  await shown(page);
  await press(page, "l");
  await page.locator("[data-part=Nose]").hover();
  await still(page);
  assert.match(await note(page), /^Nose .*the drawing plane\s+lies on Head/);
  await page.locator("[data-part=Larm]").hover();
  await still(page);
  assert.match(await note(page), /^Larm \d+(\.\d+)? (in front of|behind) the drawing plane\s+(in front of|behind) \w+ by \d+/);
  const plane = (await page.locator(".layers-plane").boundingBox())!;
  assert.ok(Math.abs(plane.x - (await project(page, 0, 0.5, 0)).x) < 1.5, "the line of the drawing plane lies on it");
  const mark = (await page.locator(".layers-mark").boundingBox())!;
  assert.ok(Math.abs(mark.x - plane.x) > 2, "the line of the arm lies beside it");
  await page.locator("canvas").evaluate((canvas) => canvas.blur());
  await manual(page, "preview-layers.png");
  await page.locator("[data-part=Body]").click();
  await page.mouse.move(2, 2);
  await still(page);
  assert.match(await note(page), /^Body in the drawing plane/);
  assert.match(await page.locator(".inspector").innerText(), /Depth\s+in the drawing plane/);
}, { smoothEdges: true });

browse("turning the view away, or Escape, ends it", one(DOLL), async (page) => {
  await shown(page);
  await press(page, "l");
  await press(page, "ArrowRight");
  const turned = await camera(page);
  assert.equal(await page.locator(".layers").isVisible(), false);
  assert.equal(await page.getAttribute("canvas", "data-layers"), "");
  await press(page, "l");
  assert.equal(await page.locator(".layers").isVisible(), true);
  await press(page, "+");
  assert.equal(await page.locator(".layers").isVisible(), true, "zooming keeps it");
  await press(page, "Escape");
  assert.equal(await page.locator(".layers").isVisible(), false);
  assert.equal(await camera(page), turned);
});

browse("the layers fit on a phone", one(DOLL), async (page) => {
  await shown(page);
  await page.getByRole("button", { name: "More tools" }).click();
  await page.getByRole("button", { name: "Layers from the side" }).click();
  await page.keyboard.press("Escape");
  await still(page);
  assert.equal(await page.locator(".layers").isVisible(), true);
  assert.deepEqual(await overlaps(page), []);
  await picture(page, "layers-phone");
}, phone);
