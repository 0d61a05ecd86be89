// The drawing beside the model, with the real program.

import assert from "node:assert/strict";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { after, test } from "node:test";
import type { Browser, Page } from "playwright-core";
import { found } from "./axe";
import { launch, manual, noBrowser, open, shown, still, type PageOptions } from "./browser";
import { closeAll, closing, preview, TEST_LIMIT } from "./closing";
import { example } from "./setup";

const okoshi = process.env["OKOSHI"] ?? "";
const skip = noBrowser !== false ? noBrowser : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
const selected = (page: Page) => page.locator(".tree-item[aria-selected=true]").first().getAttribute("data-part");

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

/** A test of the page of one drawing in a folder of its own, with the drawing beside the model. */
function beside(name: string, file: string, run: (page: Page, file: string) => Promise<void>, { change = (text) => text, ...options }: PageOptions & { change?: (text: string) => string } = {}): void {
  test(name, { skip, timeout: TEST_LIMIT }, async (t) => {
    const onClose = closing(t);
    const folder = mkdtempSync(join(tmpdir(), "okoshi-paper-"));
    onClose(() => rmSync(folder, { recursive: true }));
    const drawing = join(folder, basename(file));
    copyFileSync(file, drawing);
    writeFileSync(drawing, change(readFileSync(drawing, "utf8")));
    const { address } = await preview(okoshi, folder, basename(file), onClose);
    browser ??= launch();
    const { page, wrong } = await open(await browser, address, onClose, options);
    await shown(page, 1);
    await page.locator("canvas").focus();
    await page.keyboard.press("2");
    await page.locator(".paper-marks[viewBox]").waitFor();
    await still(page);
    await run(page, drawing);
    assert.deepEqual(wrong, []);
  });
}

/** Selects a part in the list, and returns where the drawing marks it. */
async function marked(page: Page, part: string): Promise<{ x: number; y: number; width: number; height: number }> {
  await page.locator(`.tree-item[data-part="${part}"]`).click();
  await page.mouse.move(1, 1);
  return (await page.locator(".paper-mark.chosen").boundingBox())!;
}

beside("a click on a shape or a string of the drawing selects its part", example("human"), async (page) => {
  let parts = 0;
  for (const part of ["Head", "Rarm", "Larm", "Ubody", "Lbody", "U-1", "U-2"]) {
    const { x, y, width, height } = await marked(page, part);
    await page.locator("canvas").focus();
    await page.keyboard.press("Escape");
    assert.equal(await page.locator(".paper-mark").count(), 0);
    // Arms are drawn obliquely, and the middle of the head is between its eyes.
    await page.mouse.click(x + width / 2, y + height / 2);
    assert.equal(await selected(page), part);
    parts++;
  }
  assert.equal(parts, 7);
  await page.locator(`.tree-item[data-part="Rarm"]`).click();
  const { x, y, height } = (await page.locator(".paper-string.chosen").boundingBox())!;
  await page.keyboard.press("Escape");
  await page.mouse.click(x + 3, y + height / 2);
  assert.equal(await selected(page), "Rarm", "the beginning of its string lies beside the arm");
  const sheet = (await page.locator(".paper-sheet").boundingBox())!;
  await page.mouse.click(sheet.x + sheet.width - 4, sheet.y + sheet.height / 2);
  assert.equal(await page.locator(".paper-mark.chosen").count(), 0, "where nothing is drawn, nothing is selected");
});

beside("what the pointer is on is marked in both, and the parts in the model too", example("human"), async (page) => {
  const { x, y, width, height } = await marked(page, "Head");
  await page.keyboard.press("Escape");
  await page.mouse.move(x + width / 2, y + height / 4);
  await page.locator(".paper-mark.hovered").waitFor();
  assert.match((await page.locator(".tree-item[data-part=Head]").getAttribute("class")) ?? "", /hover/);
  await page.mouse.move(1, 1);
  await page.waitForFunction(() => document.querySelector(".paper-mark") === null);
});

beside("the wheel and dragging look at a piece of the drawing, and clicks still mean what is under them", example("human"), async (page) => {
  const before = await marked(page, "Head");
  await page.mouse.move(before.x + before.width / 2, before.y + before.height / 2);
  await page.mouse.wheel(0, -400);
  await page.waitForFunction((width) => document.querySelector(".paper-mark.chosen")!.getBoundingClientRect().width > 2 * width, before.width);
  await page.mouse.down();
  await page.mouse.move(before.x + 60, before.y + 90, { steps: 4 });
  await page.mouse.up();
  assert.equal(await selected(page), "Head", "a drag is no click");
  const after = (await page.locator(".paper-mark.chosen").boundingBox())!;
  await page.keyboard.press("Escape");
  await page.mouse.click(after.x + after.width / 2, after.y + after.height * 0.9);
  assert.equal(await selected(page), "Head");
  await page.getByRole("button", { name: "Show all of the drawing" }).click();
  const again = (await page.locator(".paper-mark.chosen").boundingBox())!;
  assert.ok(Math.abs(again.x - before.x) < 1 && Math.abs(again.width - before.width) < 1);
});

beside("a save changes the drawing, and what cannot be read leaves the last one", example("human"), async (page, file) => {
  const text = readFileSync(file, "utf8");
  const before = await marked(page, "Head");
  writeFileSync(file, text.replace("Head@Ubody", "Face@Ubody"));
  await shown(page, 2);
  const after = await marked(page, "Face");
  assert.ok(Math.abs(after.x - before.x) < 1 && Math.abs(after.width - before.width) < 1);
  writeFileSync(file, text.slice(0, text.length / 2));
  await page.locator(".finding").first().waitFor({ state: "attached" });
  assert.ok((await page.locator(".paper-mark.chosen").boundingBox())!.width > 0);
  assert.equal(await page.locator(".paper-note").isVisible(), false);
});

beside("nothing in a drawing is executed or fetched", example("human"), async (page) => {
  const bodies = await page.evaluate(() => document.querySelectorAll("script").length);
  assert.equal(bodies, 1, "the page's own");
  assert.equal(await page.evaluate(() => (window as { hit?: boolean }).hit), undefined);
  assert.equal(await page.locator(".paper-sheet img").evaluate((image: HTMLImageElement) => image.complete && image.naturalWidth > 0), true);
}, { change: (text) => text.replace("</svg>", '<script>window.hit = top.hit = true; fetch("/hit")</script><image href="http://127.0.0.1:9/hit.png" width="9" height="9" onload="top.hit = true"/></svg>') });

/** Pictures of one pixel. */
const RED = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC";
const GREEN = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNg+M8AAAICAQB7CYF4AAAAAElFTkSuQmCC";

beside("a picture that the drawing links to is there, and follows its file", example("human"), async (page, file) => {
  const save = (color: string): void => writeFileSync(join(dirname(file), "a b.png"), Buffer.from(color, "base64"));
  save(RED);
  writeFileSync(file, readFileSync(file, "utf8").replace("</svg>", '<image href="a%20b.png" x="0" y="0" width="40" height="40"/></svg>'));
  const corner = (color: string) => page.waitForFunction(async (color) => {
    const image = document.querySelector<HTMLImageElement>(".paper-sheet img")!;
    await image.decode();
    const context = new OffscreenCanvas(420, 440).getContext("2d")!;
    context.drawImage(image, 0, 0, 420, 440);
    return [...context.getImageData(10, 10, 1, 1).data].join() === color;
  }, color);
  await corner("255,0,0,255");
  save(GREEN);
  await corner("0,255,0,255");
  assert.equal(await page.locator(".paper-lacking").isVisible(), false);
});

for (const [name, size] of [["desktop", { viewport: { width: 1400, height: 900 } }], ["phone", { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }]] as const) {
  beside(`it has half of the window, and axe finds nothing, ${name}`, example("human"), async (page) => {
    const [paper, model] = await Promise.all([".paper", ".viewport"].map(async (place) => (await page.locator(place).boundingBox())!));
    assert.ok(Math.abs(paper!.width * paper!.height - model!.width * model!.height) < 0.02 * model!.width * model!.height);
    assert.deepEqual(await found(page), []);
    await page.keyboard.press("2");
    await page.locator(".paper").waitFor({ state: "hidden" });
  }, size);
}

beside("the picture of the manual", example("girl"), async (page) => {
  await page.locator(".tree-item[data-part=Lleg]").click();
  await page.locator("canvas").evaluate((canvas) => canvas.blur());
  await page.mouse.move(1, 1);
  await still(page);
  await manual(page, "preview-drawing.png");
}, { viewport: { width: 1060, height: 640 }, smoothEdges: true });
