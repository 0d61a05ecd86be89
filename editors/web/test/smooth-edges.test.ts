import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { pass, picture, shown, still } from "./browser";
import { browse, FIGURE, one } from "./setup";

/** The number of colours around the model: edges that are not smooth have no mixed ones. */
async function colours(page: Page, name?: string): Promise<number> {
  const { data, width } = await picture(page, name);
  const found = new Set<number>();
  for (let y = 150; y < 700; y++) for (let x = 100; x < 800; x++) found.add(data.readUInt32BE(4 * (y * width + x)));
  return found.size;
}

/** Waits until edges are smooth. */
const smoothed = (page: Page) => page.waitForSelector("canvas[data-smooth=true]", { state: "attached" });

browse("edges are smooth when the picture is still, and drawn at once when it moves", one(FIGURE), async (page) => {
  // Pictures that take long to draw are not smoothed: by this clock none does, however busy the machine is.
  await page.addInitScript(() => (performance.now = () => 0));
  await page.reload();
  await shown(page);
  await page.keyboard.press("z");
  await still(page);
  const frames = await page.getAttribute("canvas", "data-frames");
  await smoothed(page);
  const smooth = await colours(page, "smooth-edges");
  await pass(page, 20);
  assert.equal(await page.getAttribute("canvas", "data-frames"), frames, "smoothing is no frame");
  assert.equal(await colours(page), smooth, "a smooth picture stays");

  // Another direction, and back.
  await page.evaluate(() => {
    const canvas = document.querySelector("canvas")!;
    const seen = ((window as unknown as { seen: string[] }).seen = [] as string[]);
    new MutationObserver(() => seen.push(canvas.dataset["smooth"]!)).observe(canvas, { attributeFilter: ["data-smooth"] });
  });
  for (const key of ["ArrowLeft", "ArrowRight"]) await page.keyboard.press(key);
  await still(page);
  await smoothed(page);
  assert.equal((await page.evaluate(() => (window as unknown as { seen: string[] }).seen))[0], "false");
  assert.ok(Math.abs((await colours(page)) - smooth) < 0.1 * smooth);

  // Without it, edges have steps. It begins after a pause, which never ends here.
  await page.addInitScript(() => {
    const wait = window.setTimeout as (step: () => void, milliseconds?: number) => number;
    window.setTimeout = ((step: () => void, milliseconds?: number) => {
      if (milliseconds !== 200) return wait(step, milliseconds);
      (window as unknown as { pauses: boolean }).pauses = true;
      return 0;
    }) as typeof window.setTimeout;
  });
  await page.reload();
  await shown(page);
  await page.keyboard.press("z");
  await still(page);
  await page.waitForFunction(() => (window as unknown as { pauses?: boolean }).pauses);
  assert.equal(await page.getAttribute("canvas", "data-smooth"), "false");
  const rough = await colours(page, "rough-edges");
  assert.ok(smooth > 1.3 * rough, `${smooth} colours, ${rough} without smooth edges`);
}, { smoothEdges: true });
