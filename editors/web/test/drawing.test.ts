// Drawing on the page beside the model, with the real program: what a person does, and the bytes of the file.

import assert from "node:assert/strict";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { found } from "./axe";
import { manual, overlaps, pass, picture, shown, still } from "./browser";
import { drag, FIRST_FIGURE, oval, spot, type Spot } from "./drawn";
import { edit, type Edited } from "./edited";
import { FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

const BEFORE = source(FIGURE);
const SIZE: Spot = [300, 300];
const EMPTY = join("..", "..", "src", "starters", "empty.svg");
const PAGE: Spot = [210, 297];

/** Turns on editing, and shows the page. */
async function begin(page: Page): Promise<void> {
  await page.locator("canvas").focus();
  await page.keyboard.press("w");
  await page.keyboard.press("2");
  await page.locator(".paper-marks[viewBox]").waitFor({ state: "attached" });
  await page.locator(".draw-tools").waitFor();
  await still(page);
}

const tool = (page: Page, name: string) => page.getByRole("button", { name, exact: true });

/** Waits until nothing is shown that the drawing does not show itself. */
const settled = (page: Page) => page.waitForFunction(() => document.querySelector(".paper-drafts")!.childElementCount === 0);

const selected = (page: Page) => page.locator(".tree-item[aria-selected=true]").first().getAttribute("data-part");

/** What stands in the file behind the head, in front of the strings. */
const added = (edited: Edited): string => edited.text().slice(BEFORE.indexOf("\n  <text"), edited.text().indexOf("\n  <text"));

edit("an ellipse, a rectangle and a shape by hand are written in front of the others, and undo takes them back", async (edited) => {
  const { page } = edited;
  await begin(page);
  await tool(page, "Ellipse").click();
  await drag(page, [[20, 220], [60, 240], [80, 270]], SIZE);
  await edited.until(() => edited.text() !== BEFORE, "an ellipse");
  const [, ellipse] = /^\n  <ellipse id="ellipse-1" style="fill:#d1495b;stroke:none" (.*) \/>$/.exec(added(edited)) ?? [];
  const numbers = ellipse!.match(/[\d.]+/g)!.map(Number);
  [50, 245, 30, 25].forEach((wanted, at) => assert.ok(Math.abs(numbers[at]! - wanted) < 1, ellipse));
  assert.equal(edited.text().replace(added(edited), ""), BEFORE, "nothing else has changed");
  await settled(page);
  assert.equal(await selected(page), "U-1", "what was drawn is selected");

  await page.keyboard.press("y");
  await page.keyboard.down("Shift");
  await tool(page, "Green").click();
  await drag(page, [[200, 220], [240, 230]], SIZE);
  await page.keyboard.up("Shift");
  await edited.until(() => added(edited).includes("<rect id=\"rect-1\""), "a rectangle");
  const [, width, height] = /id="rect-1" style="fill:#5fa55a;stroke:none" x="[\d.]+" y="[\d.]+" width="([\d.]+)" height="([\d.]+)"/.exec(added(edited)) ?? [];
  assert.ok(width === height && Math.abs(Number(width) - 40) < 1, added(edited));
  const two = edited.text();
  await settled(page);

  await page.keyboard.press("x");
  await drag(page, oval([150, 250], 60, 50), SIZE);
  await edited.until(() => added(edited).includes("<path id=\"path-1\""), "a shape by hand");
  const [, path] = /<path id="path-1" style="fill:#5fa55a;stroke:none" d="(M [-\d.,]+(?: C [-\d.,]+ [-\d.,]+ [-\d.,]+)+ Z)" \/>/.exec(added(edited)) ?? [];
  const nodes = path!.match(/C/g)!.length;
  assert.ok(nodes >= 2 && nodes <= 20, path);
  assert.doesNotMatch(path!, /\.\d{4}/, "no more digits than a screen can show");
  await settled(page);

  // A click and a dot draw nothing.
  const whole = edited.text();
  await drag(page, [[250, 40]], SIZE);
  await drag(page, [[250, 40], [250.5, 40.5]], SIZE);
  await page.keyboard.press("Control+z");
  await edited.has(two, "the line is undone");
  await page.getByRole("button", { name: /^Redo: / }).and(page.locator(":enabled")).waitFor();
  await page.keyboard.press("Control+Shift+z");
  await edited.has(whole, "and made again");
  await settled(page);
  assert.equal(await selected(page), "U-3");
  for (let step = 0; step < 3; step++) await page.getByRole("button", { name: /^Undo: / }).and(page.locator(":enabled")).click();
  await edited.has(BEFORE, "undone");
});

edit("a page that moves while a shape is drawn does not tear it apart", async (edited) => {
  const { page } = edited;
  await begin(page);
  await tool(page, "Rectangle").click();
  const [from, to] = [await spot(page, [20, 220], SIZE), await spot(page, [100, 270], SIZE)];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x + 20, from.y + 20, { steps: 2 });
  await page.locator(".paper-desk").evaluate((desk) => (desk.style.transform = "translate(60px, -40px)"));
  await page.mouse.move(to.x, to.y, { steps: 2 });
  await page.mouse.up();
  await edited.until(() => edited.text() !== BEFORE, "a rectangle");
  const numbers = /x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"/.exec(added(edited))!.slice(1).map(Number);
  [20, 220, 80, 50].forEach((wanted, at) => assert.ok(Math.abs(numbers[at]! - wanted) < 1, added(edited)));
});

edit("a part is moved with its string, by the mouse and by keys, and what hangs on it stays", async (edited) => {
  const { page } = edited;
  await begin(page);
  await drag(page, [[230, 120], [230, 130], [230, 150]], SIZE);
  await edited.until(() => edited.text() !== BEFORE, "the arm is moved");
  const [, y] = /id="arm" x="170" y="([\d.]+)"/.exec(edited.text()) ?? [];
  const down = Number(y) - 110;
  assert.ok(Math.abs(down - 30) < 1, y);
  const moved = (right: number, down: number): string => {
    const at = (number: number) => String(Number(number.toFixed(2)));
    return BEFORE.replace('id="arm" x="170" y="110"', `id="arm" x="${at(170 + right)}" y="${at(110 + down)}"`).replace('id="arm-text" x="190" y="122"', `id="arm-text" x="${at(190 + right)}" y="${at(122 + down)}"`);
  };
  assert.equal(edited.text(), moved(0, down));
  await settled(page);
  assert.equal(await selected(page), "Arm");
  // From the page, as the driver may take longer from one key to the next than what is still quick.
  await page.evaluate(() => {
    for (const [key, shiftKey] of [["ArrowRight", false], ["ArrowRight", false], ["ArrowDown", false], ["ArrowLeft", true]] as const) {
      document.activeElement!.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey, bubbles: true, cancelable: true }));
    }
  });
  await edited.has(moved(5.7, down + 3), "presses of keys in quick succession are one change");
  await settled(page);
  await page.keyboard.press("Control+z");
  await edited.has(moved(0, down), "one step");
  await page.keyboard.press("Control+z");
  await edited.has(BEFORE, "undone");
  await page.waitForFunction(() => document.querySelector<SVGPathElement>(".paper-mark.chosen")?.getBBox().y === 110);

  // Escape gives up while the pointer is down.
  const [from, to] = [await spot(page, [230, 120], SIZE), await spot(page, [230, 200], SIZE)];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 3 });
  await page.locator(".paper-ghost").waitFor({ state: "attached" });
  await page.keyboard.press("Escape");
  await settled(page);
  await page.mouse.up();
  // A click selects as before, and the page is moved beside the parts.
  await page.mouse.click(from.x, from.y);
  assert.equal(await selected(page), "Arm");
  const before = (await page.locator(".paper-sheet").boundingBox())!;
  await drag(page, [[20, 20], [40, 30]], SIZE);
  assert.ok((await page.locator(".paper-sheet").boundingBox())!.x > before.x);
  assert.equal(edited.text(), BEFORE);
});

edit("a part is painted, stacked and deleted, and what others hang on stays", async (edited) => {
  const { page } = edited;
  await begin(page);
  await edited.select("Arm");
  for (const name of ["To the front", "To the back", "Delete"]) assert.ok(await tool(page, name).isEnabled());
  await tool(page, "Blue").click();
  const blue = BEFORE.replace("#00a000", "#3d7ea6");
  await edited.has(blue, "blue");
  await tool(page, "To the front").click();
  const [, arm] = /(\n  <rect id="arm"[^>]*>)/.exec(blue)!;
  const [, head] = /(\n  <rect id="head"[^>]*>)/.exec(blue)!;
  const front = blue.replace(arm! + head!, head! + arm!);
  await edited.has(front, "to the front");
  await tool(page, "To the back").click();
  const [, body] = /(\n  <rect id="body"[^>]*>)/.exec(blue)!;
  await edited.has(front.replace(body! + head! + arm!, arm! + body! + head!), "to the back");
  await page.locator(".paper-desk").focus();
  await page.keyboard.press("Delete");
  await edited.until(() => !edited.text().includes("arm"), "deleted with its string");
  assert.equal(edited.text().match(/<text/g)!.length, 2);
  await page.locator("[data-part=Arm]").waitFor({ state: "hidden" });
  assert.equal(await page.locator(".tree-item[aria-selected=true]").count(), 0);
  await edited.select("Body");
  await tool(page, "Delete").click();
  await page.getByText("Head hangs on Body: hang it elsewhere first.").waitFor();
  await page.keyboard.press("Escape");
  assert.ok(await tool(page, "Delete").isEnabled());
  for (let step = 0; step < 4; step++) await page.getByRole("button", { name: /^Undo/ }).click();
  await edited.has(BEFORE, "undone");
});

edit("without a pointer: tools by key, shapes in the middle, moved and deleted; Escape leaves a tool", async (edited) => {
  const { page } = edited;
  await begin(page);
  await page.keyboard.press("u");
  assert.equal(await tool(page, "Ellipse").getAttribute("aria-pressed"), "true");
  await tool(page, "Ellipse").focus();
  await page.keyboard.press("Enter");
  await edited.until(() => added(edited).includes("<circle id=\"circle-1\""), "a circle in the middle");
  await settled(page);
  await page.locator(".paper-desk").focus();
  await page.keyboard.press("y");
  await page.keyboard.press("Enter");
  await edited.until(() => added(edited).includes("<rect id=\"rect-1\""), "a square in the middle");
  await page.locator("[data-part=U-1]").waitFor();
  await page.keyboard.press("Escape");
  assert.equal(await tool(page, "Select and move").getAttribute("aria-pressed"), "true");
  assert.equal(await selected(page), "U-1", "the tool is left before the selection");
  await page.keyboard.press("Delete");
  await edited.until(() => !added(edited).includes("<rect id=\"rect-1\""), "deleted");
  await page.locator("[data-part=U-1]").waitFor({ state: "hidden" });
  assert.equal(await page.locator(".tree-item[aria-selected=true]").count(), 0);
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+z");
  await page.keyboard.press("Control+z");
  await edited.has(BEFORE, "undone");
});

edit("a shape that lies on a part goes with it, and is moved and deleted by itself once it is selected", async (edited) => {
  const { page } = edited;
  await begin(page);
  await tool(page, "Ellipse").click();
  await drag(page, [[125, 175], [130, 180], [135, 185]], SIZE);
  await page.locator("[data-part=circle-1]").waitFor();
  await settled(page);
  assert.equal(await selected(page), "circle-1", "it is a detail of the body, and selected");
  const drawn = edited.text();
  await page.keyboard.press("q");
  await drag(page, [[130, 180], [130, 185], [130, 190]], SIZE);
  await edited.until(() => edited.text() !== drawn, "moved");
  const [, y] = /<circle id="circle-1"[^>]* cy="([\d.]+)"/.exec(edited.text()) ?? [];
  assert.ok(Math.abs(Number(y) - 190) < 1.5, y);
  assert.equal(edited.text().replace(`cy="${y}"`, ""), drawn.replace(/cy="[\d.]+"/, ""), "alone");
  await settled(page);
  await edited.select("Body");
  await drag(page, [[130, 190], [130, 195], [130, 200]], SIZE);
  await edited.until(() => !edited.text().includes(`cy="${y}"`) && !edited.text().includes('x="110" y="100"'), "the body takes it along");
  await settled(page);
  // A click into the selected body means it again.
  const place = await spot(page, [130, 200], SIZE);
  await page.waitForTimeout(600);
  await page.mouse.click(place.x, place.y);
  assert.equal(await selected(page), "circle-1");
  await page.keyboard.press("Delete");
  await edited.until(() => !edited.text().includes("circle"), "deleted");
});

edit("a finger draws, and two fingers look around instead", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit", exact: true }).tap();
  await page.getByRole("button", { name: "Drawing beside the model" }).tap();
  await page.locator(".draw-tools").waitFor();
  await tool(page, "Draw a shape").tap();
  const session = await page.context().newCDPSession(page);
  const touch = async (type: "touchStart" | "touchMove" | "touchEnd", ...spots: readonly Spot[]): Promise<void> => {
    const touchPoints = [];
    for (const [id, one] of spots.entries()) touchPoints.push({ id, ...(await spot(page, one, SIZE)) });
    await session.send("Input.dispatchTouchEvent", { type, touchPoints });
  };
  await touch("touchStart", [60, 250]);
  for (const point of oval([50, 250], 40, 40)) await touch("touchMove", point);
  await page.locator(".paper-draft").waitFor({ state: "attached" });
  await touch("touchEnd");
  await edited.until(() => added(edited).includes("<path id=\"path-1\""), "a shape");
  const drawn = edited.text();
  await settled(page);
  const before = (await page.locator(".paper-sheet").boundingBox())!;
  const [a, b]: [Spot, Spot] = [[100, 200], [200, 200]];
  await touch("touchStart", a);
  await touch("touchMove", [102, 202]);
  await touch("touchStart", a, b);
  await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: [{ id: 0, x: before.x + 20, y: before.y + 150 }, { id: 1, x: before.x + 220, y: before.y + 150 }] });
  await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: [{ id: 0, x: before.x + 5, y: before.y + 150 }, { id: 1, x: before.x + 260, y: before.y + 150 }] });
  await touch("touchEnd");
  await pass(page);
  assert.ok((await page.locator(".paper-sheet").boundingBox())!.width > before.width, "two fingers look closer");
  assert.equal(await page.locator(".paper-draft").count(), 0);
  assert.equal(edited.text(), drawn);
}, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

edit("what would rebind a string is refused with what to do, and leaves nothing behind", async (edited) => {
  const { page } = edited;
  await begin(page);
  await tool(page, "Rectangle").click();
  await drag(page, [[168, 108], [252, 132]], SIZE);
  await page.getByText("would mean another shape then, or none: draw it farther from that text.").waitFor();
  await settled(page);
  assert.equal(edited.text(), BEFORE);
  await page.keyboard.press("Escape");
  assert.equal(await tool(page, "Rectangle").getAttribute("aria-pressed"), "true", "first the message goes");
}, {});

edit("from an empty page a figure is drawn by hand, named and moved", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Draw something" }).click();
  await page.getByText("Draw each part as a shape of its own").waitFor();
  for (const [at, points] of FIRST_FIGURE.entries()) {
    // Until the page has its place, the pointer would be elsewhere on it.
    await settled(page);
    await still(page);
    await drag(page, points, PAGE);
    await edited.until(() => (edited.text().match(/<path\b/g) ?? []).length === at + 1, `shape ${at + 1}`);
  }
  await settled(page);
  await picture(page, "drawn-figure");
  await page.getByRole("button", { name: "Name the parts for me" }).click();
  for (const part of ["Body", "Head", "Larm", "Rarm", "Lleg", "Rleg"]) await page.locator(`[data-part=${part}]`).waitFor();
  assert.equal(await page.getByText("Draw each part as a shape of its own").isVisible(), false);
  await edited.select("Body");
  await edited.label("Motion: clip").selectOption("=walk");
  await page.waitForFunction(() => /^walk/.test(document.querySelector(".clip-choice option")?.textContent ?? ""));
  await page.locator(".part-form[aria-busy=false]").waitFor();
  await still(page);
  await page.locator("canvas").evaluate((canvas) => canvas.blur());
  await manual(page, "without-strings/6-draw.png");
  await picture(page, "drawn-figure-walks");
}, { drawing: EMPTY, viewport: { width: 1240, height: 760 } });

edit("where nothing can be changed there are no tools, and keys do what they did", async ({ page }) => {
  await page.locator("canvas").focus();
  await page.keyboard.press("2");
  await page.locator(".paper-marks[viewBox]").waitFor({ state: "attached" });
  assert.equal(await page.locator(".draw-tools").isVisible(), false);
  assert.equal(await page.locator(".paper-desk").getAttribute("tabindex"), null);
  await drag(page, [[230, 120], [230, 150]], SIZE);
  assert.equal(await page.locator(".paper-ghost").count(), 0);
}, { arguments: ["--read-only"] });

for (const { name, ...size } of SIZES) {
  edit(`${name}: the tools leave room for the page, and axe finds nothing`, async (edited) => {
    const { page } = edited;
    await page.getByRole("button", { name: "Edit", exact: true }).click();
    await page.locator("canvas").focus();
    await page.keyboard.press("2");
    await page.locator(".draw-tools").waitFor();
    await shown(page);
    const [tools, desk] = [(await page.locator(".draw-tools").boundingBox())!, (await page.locator(".paper-desk").boundingBox())!];
    assert.ok(desk.height > 1.5 * tools.height, `${tools.height} of ${tools.height + desk.height} pixels are tools`);
    const inside = await page.locator(".draw-tools button, .draw-tools input").evaluateAll((all) => all.every((one) => one.getBoundingClientRect().right <= one.closest(".draw-tools")!.getBoundingClientRect().right));
    assert.ok(inside, "nothing sticks out");
    assert.deepEqual(await overlaps(page), []);
    assert.deepEqual(await found(page), []);
    await picture(page, `drawing-tools-${name.replace(" ", "-")}`);
  }, size);
}
