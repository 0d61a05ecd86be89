// The drawings of a limited clip above its timeline, with the real program: what a person drags, and the bytes of the file.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import type { AxeResults } from "axe-core";
import type { Page } from "playwright-core";
import { broughtBack, heldWords, nearestEnd, readHeld, standing, type Sheet } from "../src/editing/drawings";
import { manual, overlaps, picture, shown, still } from "./browser";
import { edit, type Edited } from "./edited";
import { FIGURE, example, source } from "./setup";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const BODY = "Body$Shape default -20 20";
const BEFORE = source(FIGURE).replace(BODY, `${BODY} Motion wave Limited 2 8`);

/** Drawings of so many frames each, of which some source frames are not shown. */
function sheet(runs: readonly (readonly [source: number, frames: number])[], words: string | null = null): Sheet {
  let start = 0;
  const drawings = runs.map(([source, frames]) => ({ source, start: (start += frames) - frames, frames }));
  return { drawings, held: readHeld(words) };
}

const says = (made: Sheet | null) => made && [made.drawings.map(({ source, frames }) => [source, frames]), heldWords(made.held)];

test("a drawing that stands for longer covers others, and for less, the next begins sooner", () => {
  const before = sheet([[0, 1], [1, 2], [3, 1], [4, 3], [7, 1]]);
  assert.deepEqual(says(standing(before, 1, 4)), [[[0, 1], [1, 4], [4, 2], [7, 1]], "2 4"]);
  assert.deepEqual(says(standing(before, 1, 1)), [[[0, 1], [1, 1], [3, 2], [4, 3], [7, 1]], "2 1"]);
  assert.deepEqual(says(standing(before, 1, 9)), [[[0, 1], [1, 7]], "2 7"]);
  assert.deepEqual(says(standing(before, 2, 0)), [[[0, 1], [1, 3], [4, 3], [7, 1]], "4 0"]);
  assert.deepEqual([standing(before, 0, 0), standing(before, 4, 2), standing(before, 1, 2)], [null, null, null], "the first, the last, and nothing new");
  // What is chosen behind ends where it did, and what is covered is no longer chosen.
  const chosen = sheet([[0, 1], [1, 2], [3, 1], [4, 3], [7, 1]], "4 1 5 3");
  assert.deepEqual(says(standing(chosen, 1, 4)), [[[0, 1], [1, 4], [4, 2], [7, 1]], "2 4 5 2"]);
  assert.deepEqual(says(standing(chosen, 3, 0)), [[[0, 1], [1, 2], [3, 4], [7, 1]], "4 4 5 0"]);
});

test("a drawing comes back in the last frame of the one before, one that was left out by hand first", () => {
  const before = sheet([[0, 3], [4, 1], [5, 2]], "2 0");
  assert.deepEqual(says(broughtBack(before, 0, 8)), [[[0, 2], [1, 1], [4, 1], [5, 2]], "2 1"]);
  assert.deepEqual(says(broughtBack(sheet([[0, 3], [4, 1]], "1 3"), 0, 5)), [[[0, 2], [3, 1], [4, 1]], "1 2 4 1"]);
  assert.deepEqual(says(broughtBack(before, 2, 8)), [[[0, 3], [4, 1], [5, 1], [7, 1]], "2 0 8 1"]);
  assert.equal(broughtBack(before, 1, 8), null);
  assert.deepEqual(nearestEnd(before, 3.4)?.at, 0);
  assert.deepEqual(nearestEnd(before, 9)?.at, 1, "the last one has no end that moves");
});

/** A limited clip that is edited. */
async function limited(edited: Edited): Promise<Page> {
  const { page } = edited;
  await edited.save(BEFORE);
  await shown(page, 2);
  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator(".sheet").waitFor();
  return page;
}

const EDGE = ".sheet-edge";
const frames = async (page: Page): Promise<number> => Number(await page.locator(EDGE).getAttribute("aria-valuenow"));
const label = (page: Page) => page.locator(EDGE).getAttribute("aria-label");
const drawn = (page: Page) => page.evaluate(() => Number(document.querySelector<SVGElement>(".timeline > .ticks")!.dataset["keys"]));

/** The end of the drawing that is shown, and how wide a frame is. */
async function end(page: Page): Promise<{ readonly x: number; readonly y: number; readonly frame: number }> {
  await still(page);
  const { x, y, width, height } = (await page.locator(EDGE).boundingBox())!;
  const strip = (await page.locator(".sheet").boundingBox())!;
  const count = Number(/frame \d+ of (\d+)/.exec(await page.locator(".readout").innerText())![1]);
  return { x: x + width / 2, y: y + height / 2, frame: strip.width / count };
}

/** The list that the drawing has, once it is another one. */
async function list(edited: Edited, before: string | null): Promise<string> {
  const held = () => /Limited 2 8 Held ([\d ]+)</.exec(edited.text())?.[1]?.trim() ?? null;
  await edited.until(() => held() !== before && held() !== null, "another list");
  const now = held()!;
  assert.equal(edited.text().replace(` Held ${now}`, ""), BEFORE, "nothing else is changed");
  return now;
}

edit("the end of a drawing is dragged: it stands for longer, Escape gives up, at its beginning it is left out, and undo takes it back", async (edited) => {
  const page = await limited(edited);
  for (let times = 0; times < 4; times++) await page.keyboard.press("k");
  assert.equal(await label(page), "Drawing 5: how long it stands");
  const [before, count] = [await frames(page), await drawn(page)];
  const drag = async (by: number): Promise<void> => {
    const { x, y, frame } = await end(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + by * frame, y, { steps: 6 });
  };
  await drag(3);
  const words = page.locator(".sheet-label");
  assert.equal(await words.innerText(), `${before + 3} frames`);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
  await picture(page, "edit-sheet-dragged");
  assert.equal(edited.text(), BEFORE, "nothing is written before it is let go");
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] === "");
  assert.deepEqual([await frames(page), await words.isVisible(), edited.text()], [before, false, BEFORE]);

  await drag(3);
  await page.mouse.up();
  const longer = await list(edited, null);
  assert.match(longer, new RegExp(`^\\d+ ${before + 3}$`));
  // The program's build says the same as the page has shown.
  await page.waitForFunction((count) => Number(document.querySelector<SVGElement>(".timeline > .ticks")!.dataset["keys"]) < count, count);
  assert.equal(await frames(page), before + 3);
  assert.equal(await page.locator(".clips").getAttribute("data-changed"), "false");

  await drag(-before - 5);
  assert.equal(await words.innerText(), "left out");
  await page.mouse.up();
  assert.match(await list(edited, longer), new RegExp(`^${longer.split(" ")[0]} 0$`));
  await page.getByRole("button", { name: /^Undo: / }).click();
  await edited.has(BEFORE.replace("Limited 2 8", `Limited 2 8 Held ${longer}`), "undone");
  await page.getByRole("button", { name: /^Undo: / }).click();
  await edited.has(BEFORE, "undone");
});

edit("by keyboard: arrow keys, Delete and Insert, and of quick presses none is lost", async (edited) => {
  const page = await limited(edited);
  for (let times = 0; times < 4; times++) await page.keyboard.press("k");
  const before = await frames(page);
  await page.locator(EDGE).focus();
  await Promise.all([1, 2, 3].map(() => page.keyboard.press("ArrowRight")));
  assert.equal(await frames(page), before + 3);
  const first = await list(edited, null);
  assert.match(first, new RegExp(`^\\d+ ${before + 3}$`));
  // Before the build of that is there, the next press goes on from it.
  await page.keyboard.press("ArrowRight");
  const longer = await list(edited, first);
  assert.match(longer, new RegExp(`^\\d+ ${before + 4}$`));
  await page.waitForSelector(".clips[data-changed=false]");
  await page.keyboard.press("k");
  assert.equal(await label(page), "Drawing 6: how long it stands");
  await page.keyboard.press("Delete");
  const shorter = await list(edited, longer);
  assert.match(shorter, new RegExp(`^${longer.split(" ")[0]} \\d+ \\d+ 0$`));
  assert.equal(await label(page), "Drawing 5: how long it stands", "the one before stands in its place");
  await page.keyboard.press("Insert");
  assert.match(await list(edited, shorter), new RegExp(`^${longer} \\d+ 1$`));
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Escape");
  for (const _ of [1, 2]) await page.keyboard.press("Control+z");
  await edited.has(BEFORE.replace("Limited 2 8", `Limited 2 8 Held ${longer}`), "undone");
  // The form forgets it at once.
  await edited.select("Body");
  await page.getByText("One drawing is chosen by hand").waitFor();
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => (globalThis as unknown as { axe: { run(): Promise<AxeResults> } }).axe.run());
  assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes[0]?.failureSummary}`), []);
  // Another change of the clip keeps what is chosen.
  await page.getByLabel("in place").check();
  await edited.has(BEFORE.replace("Motion wave Limited 2 8", `Motion -i wave Limited 2 8 Held ${longer}`), "in place");
  await page.getByRole("button", { name: "Reset Held" }).click();
  await edited.has(BEFORE.replace("Motion wave", "Motion -i wave"), "forgotten");
});

for (const [held, width, height] of [["upright", 390, 844], ["lying", 844, 390]] as const) {
  edit(`a finger drags the end of a drawing on a phone that is held ${held}`, async (edited) => {
    const { page } = edited;
    await edited.save(BEFORE);
    await shown(page, 2);
    await page.getByRole("button", { name: "Edit" }).click();
    await page.locator(".sheet").waitFor();
    for (let times = 0; times < 2; times++) await page.getByRole("button", { name: "Next key" }).click();
    const before = await frames(page);
    const { x, y, frame } = await end(page);
    const session = await page.context().newCDPSession(page);
    const touch = (type: "touchStart" | "touchMove" | "touchEnd", x?: number) => session.send("Input.dispatchTouchEvent", { type, touchPoints: x === undefined ? [] : [{ x, y }] });
    await touch("touchStart", x);
    for (const by of [1, 3, 4]) await touch("touchMove", x + by * frame);
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
    await picture(page, `edit-sheet-phone-${held}`);
    await touch("touchEnd");
    assert.match(await list(edited, null), new RegExp(`^\\d+ ${before + 4}$`));
    assert.equal(await page.getAttribute("canvas", "data-selected"), "", "whatever is selected stays so");
  }, { viewport: { width, height }, hasTouch: true, isMobile: true });
}

edit("the page of the manual shows how a drawing is dragged", async (edited) => {
  const { page } = edited;
  await edited.save(edited.text().replace("Motion walk", "Motion dance Limited 4 16"));
  await shown(page, 2);
  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator(".sheet").waitFor();
  for (let times = 0; times < 12; times++) await page.keyboard.press("k");
  const { x, y, frame } = await end(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 4 * frame, y, { steps: 4 });
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
  await still(page);
  assert.deepEqual(await overlaps(page), []);
  await manual(page, join("without-strings", "5-drawings.png"));
  await page.mouse.up();
  await edited.until(() => /Limited 4 16 Held \d+ \d+</.test(edited.text()), "dragged");
}, { drawing: example("girl"), viewport: { width: 1060, height: 720 }, smoothEdges: true });

edit("the drawings of a clip are there also where another part than the one that says it carries its hips", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Ubody");
  await edited.label("Motion: clip").selectOption("=wave");
  await page.locator('[data-key="Motion limited"]').click();
  await page.locator(".sheet").waitFor();
  // Nothing is asked for again and again.
  const forms: string[] = [];
  page.on("request", (request) => void (request.url().endsWith("forms") && forms.push(request.postData() ?? "")));
  await edited.select("Lbody");
  await page.locator(".sheet").waitFor();
  await still(page);
  assert.ok(forms.length < 10, `${forms.length} forms`);
}, { drawing: example("human") });
