// Keeping poses with the real program: what a person turns on the page becomes key poses in the drawing.

import assert from "node:assert/strict";
import { overlaps, project, shown, still } from "./browser";
import { edit, type Edited } from "./edited";
import { FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

const BEFORE = source(FIGURE);

/** Turns the arm by dragging its tip to a point of the page. */
async function turn({ page }: Edited, from: readonly [number, number], to: readonly [number, number]): Promise<void> {
  const [start, end] = [await project(page, ...point(from)), await project(page, ...point(to))];
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await page.mouse.move((start.x + end.x) / 2 + 3, (start.y + end.y) / 2, { steps: 5 });
  await page.mouse.move(end.x, end.y, { steps: 5 });
  await page.mouse.up();
  await still(page);
}

/** A point of the drawing in the model: its lowest edge stands on the ground. */
const point = ([x, y]: readonly [number, number]): [number, number, number] => [(x - 180) / 100, (200 - y) / 100, 0.08];

edit("poses that are kept become a clip, and undo takes them back", async (edited) => {
  const { page } = edited;
  await page.locator("canvas").focus();
  await page.keyboard.press("1");
  await page.keyboard.press("p");
  await still(page);
  const keep = page.getByRole("button", { name: "Keep pose" });
  assert.ok(await keep.isDisabled(), "nothing is posed yet");
  // About the shoulder at (170, 120): from the right to above it.
  await turn(edited, [240, 120], [170, 50]);
  await keep.click();
  await edited.until(() => edited.text().includes("Body$Pose 0.5"), "a pose layer");
  const once = edited.text();
  const layer = once.slice(once.indexOf("<g id=\"pose-1\""));
  // Everything before the layer stays as it is.
  assert.ok(once.startsWith(BEFORE.slice(0, BEFORE.lastIndexOf("</svg>"))));
  assert.equal(layer.match(/<use /g)?.length, 1, layer);
  const [, degrees, x, y] = /href="#arm" transform="rotate\(([-\d.]+),([-\d.]+),([-\d.]+)\)"/.exec(layer) ?? [];
  assert.ok(Math.abs(Number(degrees) + 90) < 4, layer);
  assert.ok(Math.abs(Number(x) - 170) < 0.5 && Math.abs(Number(y) - 120) < 0.5, layer);

  // The page is in the pose that was kept, at the end of the clip, and nothing is turned by hand.
  await shown(page, 2);
  await page.getByRole("button", { name: "Keep pose", disabled: true }).waitFor();
  await still(page);
  // The next pose goes on from there.
  await turn(edited, [171, 80], [100, 120]);
  await keep.click();
  await edited.until(() => edited.text().includes("Body$Pose 1<"), "the next pose layer");
  const [, more] = /id="pose-2"[^]*rotate\(([-\d.]+),/.exec(edited.text()) ?? [];
  assert.ok(Math.abs(Math.abs(Number(more)) - 180) < 6, edited.text().slice(-600));

  const undo = page.getByRole("button", { name: /^Undo/ });
  await undo.click();
  await edited.has(once, "undone");
  await undo.click();
  await edited.has(BEFORE, "undone");
});

edit("where nothing can be written, no pose is kept", async ({ page }) => {
  await page.locator("canvas").focus();
  await page.keyboard.press("p");
  await page.getByRole("button", { name: "Leave posing" }).waitFor();
  assert.equal(await page.getByRole("button", { name: "Keep pose" }).isVisible(), false);
}, { arguments: ["--read-only"] });

for (const { name, ...size } of SIZES) {
  edit(`${name}: the bar has space for its buttons`, async ({ page }) => {
    await page.locator("canvas").focus();
    await page.keyboard.press("p");
    await page.getByRole("button", { name: "Keep pose" }).waitFor();
    const bar = page.locator(".posebar");
    assert.ok(await bar.evaluate((bar) => [...bar.children].every((one) => one.getBoundingClientRect().right <= bar.getBoundingClientRect().right)), "nothing sticks out");
    assert.deepEqual(await overlaps(page), []);
  }, size);
}
