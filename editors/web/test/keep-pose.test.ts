// Keeping poses with the real program: what a person turns on the page becomes key poses in the drawing.

import assert from "node:assert/strict";
import type { ElementHandle, Page } from "playwright-core";
import { manual, overlaps, picture, project, shown, still } from "./browser";
import { edit, type Edited } from "./edited";
import { example, FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

const BEFORE = source(FIGURE);

/** From the front. */
async function beginPosing(page: Page): Promise<void> {
  await page.locator("canvas").focus();
  await page.keyboard.press("1");
  await page.keyboard.press("p");
  await still(page);
}

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
  await beginPosing(page);
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

/** The key poses of a part in a drawing: seconds, and degrees of its clones. */
function poses(text: string, id: string): (readonly [seconds: number, degrees: number])[] {
  const layers = [...text.matchAll(/<g id="pose-[^]*?<desc>Body\$Pose ([\d.]+)<[^]*?<\/g>/g)];
  return layers.flatMap(([layer, seconds]) => {
    const turned = new RegExp(`href="#${id}" transform="rotate\\(([-\\d.]+),`).exec(layer);
    return turned ? [[Number(seconds), Number(turned[1])] as const] : [];
  });
}

edit("a movement that is recorded becomes key poses, also while a clip plays", async (edited) => {
  const { page } = edited;
  await beginPosing(page);
  const record = page.locator(".posebar").getByRole("button", { name: "Record" });
  const stop = page.locator(".posebar").getByRole("button", { name: "Stop" });
  await record.click();
  await stop.click();
  await page.getByText("Nothing was dragged.").waitFor();

  // What is given up is not written; the limb stays where it is until the next Esc.
  await record.click();
  await turn(edited, [240, 120], [170, 50]);
  await page.keyboard.press("Escape");
  await record.waitFor();
  assert.equal(await page.locator("canvas").getAttribute("data-posed"), "Arm");
  await page.keyboard.press("Escape");
  await page.locator("canvas[data-posed='']").waitFor();
  assert.equal(edited.text(), BEFORE);

  await record.click();
  assert.equal(await stop.getAttribute("aria-pressed"), "true");
  await turn(edited, [240, 120], [170, 50]);
  await turn(edited, [170, 50], [100, 120]);
  await stop.click();
  await edited.until(() => edited.text().includes("Body$Pose"), "pose layers");
  const once = edited.text();
  const arm = poses(once, "arm");
  assert.ok(arm.length >= 2, once.slice(-900));
  for (const [at, [seconds, degrees]] of arm.entries()) {
    const [earlier, before] = arm[at - 1] ?? [0, 0];
    assert.ok(seconds > earlier && (degrees <= before || at === arm.length - 1), JSON.stringify(arm));
  }
  assert.ok(Math.abs(Math.abs(arm.at(-1)![1]) - 180) < 8, JSON.stringify(arm));
  await shown(page, 2);
  await still(page);

  // A clip plays, and the arm is turned further: both are in the poses, after those that were there.
  const slider = page.locator(".timeline input");
  const played = async (from: number): Promise<void> => void (await page.waitForFunction(([input, from]) => Math.abs(Number(input.value) - from) > Number(input.max) / 10, [(await slider.elementHandle()) as ElementHandle<HTMLInputElement>, from] as const));
  await page.locator("[data-part=Arm]").click();
  await page.locator(".clips").getByRole("button", { name: "Play" }).click();
  await record.click();
  await played(0);
  await page.locator("canvas").focus();
  await page.keyboard.press(".");
  await played(Number(await slider.inputValue()));
  await stop.click();
  await edited.until(() => poses(edited.text(), "arm").length > arm.length + 1, "more pose layers");
  assert.ok(edited.text().startsWith(once.slice(0, once.lastIndexOf("</svg>"))));
  const later = poses(edited.text(), "arm").slice(arm.length);
  assert.ok(later.every(([seconds], at) => seconds > (later[at - 1] ?? arm.at(-1)!)[0]), JSON.stringify(later));
  await shown(page, 3);

  const undo = page.getByRole("button", { name: /^Undo/ });
  await undo.click();
  await edited.has(once, "undone");
  await undo.click();
  await edited.has(BEFORE, "undone");
});

edit("the page of the manual shows a movement that is recorded", async (edited) => {
  const { page } = edited;
  await beginPosing(page);
  await page.locator(".posebar").getByRole("button", { name: "Record" }).click();
  // The last rows are not there before they are scrolled to.
  await page.locator(".tree").evaluate((list) => list.scrollTo(0, list.scrollHeight));
  await page.locator("[data-part=Larm]").click();
  await page.locator("canvas").focus();
  // Up, as somebody who waves.
  for (let step = 0; step < 24; step++) await page.keyboard.press(",");
  await still(page);
  await page.locator("canvas").evaluate((canvas) => canvas.blur());
  await manual(page, "without-strings/7-record.png");
  await page.locator(".posebar").getByRole("button", { name: "Stop" }).click();
  await edited.until(() => edited.text().includes("$Pose"), "pose layers");
  await page.waitForFunction(() => /^poses/.test(document.querySelector<HTMLSelectElement>(".clip-choice")?.selectedOptions[0]?.textContent ?? ""));
}, { drawing: example("girl"), viewport: { width: 1060, height: 720 }, smoothEdges: true });

edit("where nothing can be written, no pose is kept", async ({ page }) => {
  await page.locator("canvas").focus();
  await page.keyboard.press("p");
  await page.getByRole("button", { name: "Leave posing" }).waitFor();
  for (const name of ["Keep pose", "Record"]) assert.equal(await page.locator(".posebar").getByRole("button", { name }).isVisible(), false);
}, { arguments: ["--read-only"] });

for (const { name, ...size } of SIZES) {
  edit(`${name}: the bar has space for its buttons`, async ({ page }) => {
    await page.locator("canvas").focus();
    await page.keyboard.press("p");
    await page.locator(".posebar").getByRole("button", { name: "Record" }).click();
    await page.locator(".posebar").getByRole("button", { name: "Stop" }).waitFor();
    const bar = page.locator(".posebar");
    assert.ok(await bar.evaluate((bar) => [...bar.children].every((one) => one.getBoundingClientRect().right <= bar.getBoundingClientRect().right)), "nothing sticks out");
    assert.deepEqual(await overlaps(page), []);
    await picture(page, `recording-${name}`);
  }, size);
}
