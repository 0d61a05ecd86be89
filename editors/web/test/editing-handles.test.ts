// Handles over the model, with the real program: what a person drags, and the bytes of the file.

import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { picture, shown, still } from "./browser";
import { edit, type Edited } from "./edited";
import { FIGURE, source } from "./setup";

const BEFORE = source(FIGURE);

type Place = { readonly x: number; readonly y: number };

/** The middle of what is taken hold of. */
async function grip(page: Page, kind: string): Promise<Place> {
  await still(page);
  const { x, y, width, height } = (await page.locator(`[data-handle=${kind}] .handle-grip`).boundingBox())!;
  return { x: x + width / 2, y: y + height / 2 };
}

/** The arm from a view, with its handles. */
async function arm(edited: Edited, view: string): Promise<Page> {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  await page.locator("canvas").focus();
  for (const key of [view, "5"]) await page.keyboard.press(key);
  await still(page);
  return page;
}

edit("arrows make a part thicker on both sides, or with Alt on one, and move it; Esc gives up", async (edited) => {
  // From the side: the front is on the left.
  const page = await arm(edited, "3");
  const [front, back] = [await grip(page, "front"), await grip(page, "back")];
  assert.ok(Math.abs(front.y - back.y) < 2 && Math.abs(front.x - back.x) > 60, "the arrows point in depth");
  const out = Math.sign(front.x - back.x);
  const drag = async (kind: string, by: number): Promise<void> => {
    const { x, y } = await grip(page, kind);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + by, y, { steps: 5 });
  };
  await drag("front", out * 60);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
  const label = page.locator(".handle-label");
  assert.match(await label.innerText(), /^back -[\d.]+ · front [\d.]+$/);
  await picture(page, "edit-handle-front");
  assert.equal(edited.text(), BEFORE, "nothing is written before it is let go");
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] === "");
  assert.equal(await label.isVisible(), false);
  assert.equal(edited.text(), BEFORE);

  await drag("front", out * 60);
  await page.mouse.up();
  await page.getByRole("button", { name: /^Undo: / }).waitFor();
  await edited.until(() => edited.text() !== BEFORE, "thicker");
  const [, low, high] = /default (-[\d.]+) ([\d.]+) Bend 0/.exec(edited.text())!.map(Number);
  assert.ok(high! > 9 && low === -high!, edited.text());
  assert.equal(edited.text().replace(/default -[\d.]+ [\d.]+ Bend/, "default -8 8 Bend"), BEFORE);
  const thick = edited.text();
  const formed = () => page.waitForFunction((now) => document.querySelector<HTMLInputElement>('[aria-label="Shape: z1, as a number"]')?.value === now, String(high));
  await formed();

  await page.keyboard.down("Alt");
  await drag("back", -out * 40);
  await page.mouse.up();
  await page.keyboard.up("Alt");
  await page.waitForFunction(([low]) => document.querySelector<HTMLInputElement>('[aria-label="Shape: z0, as a number"]')?.value !== low, [String(low)]);
  await edited.until(() => edited.text() !== thick, "thicker at the back");
  const [, lower, same] = /default (-[\d.]+) ([\d.]+) Bend 0/.exec(edited.text())!.map(Number);
  assert.ok(lower! < low! && same === high, edited.text());
  await page.keyboard.press("Control+z");
  await edited.has(thick, "undone");
  await formed();

  await drag("offset", out * 50);
  await page.mouse.up();
  await page.getByRole("button", { name: "Reset Offset" }).waitFor();
  await edited.matches(/Bend 0 Offset \d/);
});

edit("the joint is dragged in the plane of the drawing, and snaps to what has a word", async (edited) => {
  const page = await arm(edited, "1");
  assert.equal(await page.locator("[data-handle=front]").count(), 0, "in depth nothing can be dragged from here");
  const joint = await grip(page, "joint");
  // The arm is 80 units long, and turns about its left end: to the right of it is its middle.
  const far = await page.evaluate(() => document.querySelector("canvas")!.dataset["view"]!);
  const height = Number(far.split(" ")[6]);
  const box = (await page.locator("canvas").boundingBox())!;
  const unit = box.height / height / 100;
  const drag = async (right: number, down: number): Promise<void> => {
    await page.mouse.move(joint.x, joint.y);
    await page.mouse.down();
    await page.mouse.move(joint.x + right * unit, joint.y + down * unit, { steps: 5 });
  };
  await drag(40, 1);
  assert.equal(await page.locator(".handle-label").innerText(), "joint: center");
  await picture(page, "edit-handle-joint");
  await page.mouse.up();
  await edited.has(BEFORE.replace("Bend 0", "Bend 0 Origin center"), "it snaps");
  // The handles are those of the model that is shown.
  await shown(page, 2);
  await page.keyboard.press("Control+z");
  await edited.has(BEFORE, "undone");
  await shown(page, 3);
  await drag(20, 30);
  assert.match(await page.locator(".handle-label").innerText(), /^joint: [\d.]+, [\d.]+$/);
  await page.mouse.up();
  await page.getByRole("button", { name: "Reset Origin" }).waitFor();
  const [, x, y] = (await edited.matches(/Bend 0 Origin ([\d.]+) ([\d.]+)/)).map(Number);
  assert.ok(Math.abs(x! - 190) < 2 && Math.abs(y! - 150) < 2, edited.text());
});

edit("a finger drags a handle, and the view does not turn", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator(".drawer-opener").click();
  await page.locator("[data-part=Arm]").click();
  await page.keyboard.press("Escape");
  await page.locator("canvas").focus();
  await page.keyboard.press("3");
  const { x, y } = await grip(page, "front");
  const view = () => page.getAttribute("canvas", "data-view");
  const before = await view();
  const session = await page.context().newCDPSession(page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", at?: Place) => session.send("Input.dispatchTouchEvent", { type, touchPoints: at ? [at] : [] });
  await touch("touchStart", { x, y });
  for (const by of [10, 20, 30]) await touch("touchMove", { x: x - by, y });
  await picture(page, "edit-handle-phone");
  await touch("touchEnd");
  await page.locator('button[aria-label^="Undo: "]').waitFor();
  await edited.until(() => edited.text() !== BEFORE, "thicker");
  assert.match(edited.text(), /default -[\d.]+ [\d.]+ Bend 0/);
  assert.equal(await view(), before);
}, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

for (const [kind, says, label] of [
  ["inflate", /Shape inflate [\d.]+ Bend 0/, /^to both sides [\d.]+$/],
  ["roundv", /Shape roundv -\d+ \d+ Bend 0/, /^back -\d+° · front \d+°$/],
] as const) {
  edit(`an arrow makes a part of the kind ${kind} thinner and thicker, and undo takes it back`, async (edited) => {
    const before = BEFORE.replace("default -8 8 Bend 0", `${kind} Bend 0`);
    await edited.save(before);
    await shown(edited.page, 2);
    const page = await arm(edited, "3");
    const [front, back] = [await grip(page, "front"), await grip(page, "back")];
    const out = Math.sign(front.x - back.x);
    const drag = async (by: number): Promise<void> => {
      const { x, y } = await grip(page, "front");
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + by * out, y, { steps: 5 });
    };
    await drag(-12);
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
    assert.match(await page.locator(".handle-label").innerText(), label);
    await picture(page, `edit-handle-${kind}`);
    await page.mouse.up();
    await edited.until(() => says.test(edited.text()), "thinner");
    const thin = edited.text();
    await edited.made();
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] === "");
    // The arrow is where the part ends.
    const nearer = await grip(page, "front");
    assert.ok((front.x - nearer.x) * out > 4, "the arrow has come along");
    await drag(8);
    await page.mouse.up();
    await edited.until(() => edited.text() !== thin, "thicker again");
    for (const text of [thin, before]) {
      await page.keyboard.press("Control+z");
      await edited.has(text, "undone");
    }
  });
}
