// Tests that what is changed by mouse in the model beside the text is changed in the text, exactly as `okoshi edit` changes a file.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const DRAWING = "human.svg";

/** The joint's handle is dragged by so many pixels, which is not onto a place that has a word. */
const DRAGGED = { x: 9, y: 31 };

/** How much longer the drawing stands whose end is dragged, in frames. */
const LONGER = 3;

/** What `okoshi edit` makes of a text. */
export function edited(okoshi, room, before, change) {
  const copy = join(room, "edited.svg");
  writeFileSync(copy, before);
  execFileSync(okoshi, ["edit", "-q", copy, "--change", JSON.stringify(change)]);
  return readFileSync(copy, "utf8");
}

export async function edits({ editor, page, panel, step, open, read, configure, okoshi, project, room, manual }) {
  const { frame } = panel;
  const label = (name) => frame.getByLabel(name, { exact: true });
  const selected = (part) => frame.locator(`.part-form[data-form-of="${part}"]:not([inert])[aria-busy=false]`).waitFor();
  const select = async (part) => {
    await frame.locator(`[data-part="${part}"]`).click();
    await selected(part);
  };
  /** The place in the window of the middle of something in the panel. */
  const middle = async (one) => {
    await one.scrollIntoViewIfNeeded();
    const { x, y, width, height } = await one.boundingBox();
    return { x: x + width / 2, y: y + height / 2, width };
  };
  const drag = async (from, by) => {
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(from.x + by.x, from.y + by.y, { steps: 6 });
  };
  const made = (before, change) => edited(okoshi, room, before, change);
  const set = (part, attribute, value) => ({ change: "set", part, attribute, value });
  const clip = (motion, limited = null, held = null) => ({ change: "clip", part: "Ubody", clip: 0, motion, limited, held });
  /** Gives a part a colour of its own, where it has that of a legend: the panel asks which is meant. The picker is the browser's own: what it would say is filled in. */
  const paint = async (part, color) => {
    await label("Color: swatch").fill(color);
    await frame.locator(".refusal").getByRole("button", { name: /^Give .* its own/ }).click();
    return { ...set(part, "Color", color), place: "own" };
  };
  /**
   * A change by mouse: the text has the bytes of `okoshi edit`, and the file the same once it is saved, and not before. The editor's own
   * undo brings the bytes back. `act` returns the change.
   */
  const changes = async (what, act) => {
    const before = read(DRAWING);
    const expected = made(before, await act());
    assert.notEqual(expected, before, what);
    await editor.has(expected, what);
    assert.equal(read(DRAWING), before, `${what}: nothing is saved before a person saves`);
    await editor.press("Control+z");
    await editor.has(before, `${what}: undone`);
    await editor.press("Control+y");
    await editor.has(expected, `${what}: made again`);
    await editor.save();
    assert.equal(read(DRAWING), expected, `${what}: saved`);
  };

  await step("what is edited by mouse in the model has the bytes of okoshi edit, and the text's own undo takes it back", async () => {
    // Wide enough for the list of parts beside the model.
    await page.setViewportSize({ width: 1700, height: 900 });
    // The program that the extension brings.
    configure({}, "okoshi");
    await open(DRAWING);
    await editor.see(".codelens-decoration a", "Preview in 3D");
    await editor.press("Control+b");
    await editor.press("Control+k");
    await editor.press("v");
    await panel.shows();
    await frame.getByRole("button", { name: "Edit" }).click();
    await select("Rarm");

    await changes("a thickness", async () => {
      const slider = label("Shape: a1");
      await drag(await middle(slider), { x: -40, y: 0 });
      await page.mouse.up();
      return set("Rarm", "Shape", `roundv -90 ${await label("Shape: a1, as a number").inputValue()}`);
    });
    await changes("a joint", async () => {
      // Its string is shown beside it.
      await select("Rarm");
      await editor.see(".editor-instance .selected-text");
      const words = frame.locator(".handle-label");
      await drag(await middle(frame.locator("[data-handle=joint] .handle-grip")), DRAGGED);
      const [, x, y] = /^joint: (-?[\d.]+), (-?[\d.]+)$/.exec(await words.innerText());
      await manual("vscode-edit");
      await page.mouse.up();
      return set("Rarm", "Origin", `${x} ${y}`);
    });
    await changes("a name", async () => {
      await frame.locator("[data-part=Rarm]").dblclick();
      await editor.until("the field of the name", () => label("Name").evaluate((one) => one === document.activeElement));
      await editor.type("Right arm");
      await frame.locator(".inspector-title").click();
      return { change: "name", part: "Rarm", name: "Right arm" };
    });
    await changes("a parent", async () => {
      await selected("Right arm");
      await frame.getByRole("button", { name: "Click what it hangs on" }).click();
      await frame.locator("[data-part=Head]").click();
      return { change: "hang", part: "Right arm", parent: "Head" };
    });
    await changes("a colour", async () => {
      await selected("Right arm");
      return paint("Right arm", "#123456");
    });
    await changes("a kind", async () => {
      await selected("Right arm");
      await frame.getByRole("radiogroup", { name: "Shape: which" }).getByRole("radio", { name: "inflate" }).click();
      return set("Right arm", "Shape", "inflate");
    });
    await changes("a clip", async () => {
      await select("Ubody");
      await label("Motion: clip").selectOption("=wave");
      return clip("wave");
    });
    await changes("limited animation", async () => {
      await frame.locator('[data-key="Motion limited"]').click();
      return clip("wave", "2 8");
    });
    await changes("a hold", async () => {
      const edge = frame.locator(".sheet-edge");
      await edge.waitFor();
      const held = await edge.getAttribute("aria-valuenow").then(Number);
      const count = Number(/frame \d+ of (\d+)/.exec(await frame.locator(".readout").innerText())[1]);
      const { width } = await frame.locator(".sheet").boundingBox();
      await drag(await middle(edge), { x: (LONGER * width) / count, y: 0 });
      assert.equal(await frame.locator(".sheet-label").innerText(), `${held + LONGER} frames`);
      await page.mouse.up();
      // Which frame of the clip it is, only the text tells.
      let words;
      await editor.until("the list of holds", async () => (words = /Held (\d+ \d+)/.exec(await editor.text())?.[1]));
      assert.equal(words.split(" ")[1], String(held + LONGER));
      return clip("wave", "2 8", words);
    });
  });

  await step("undo in the panel takes back one step of the text", async () => {
    const saved = read(DRAWING);
    await select("Ubody");
    await label("Color: swatch").fill("#00aa00");
    const green = made(saved, set("Ubody", "Color", "#00aa00"));
    await editor.has(green, "the first change");
    await label("Color: swatch").fill("#0000aa");
    await editor.has(made(green, set("Ubody", "Color", "#0000aa")), "the second change");
    // By key, which the workbench hears too, and by button.
    await panel.canvas.focus();
    await editor.press("Control+z");
    await editor.stays("one step back", async () => {
      await page.waitForTimeout(500);
      return (await editor.text()) === green;
    });
    await frame.getByRole("button", { name: /^Undo/ }).click();
    await editor.has(saved, "undone by button");
    await frame.getByRole("button", { name: /^Redo/ }).click();
    await editor.has(green, "made again by button");
    await panel.canvas.focus();
    await editor.press("Control+s");
    await editor.until("the text to be saved from the panel", () => read(DRAWING) === green);
  });

  await step("a save by another program is kept, and so is what is changed in the panel", async () => {
    const file = join(project, DRAWING);
    const other = (text) => text.replace("#Human Character", "#Human character, seen by another program");
    // The text is saved: the editor reads what the other program wrote, and the change is made in that.
    const elsewhere = other(read(DRAWING));
    assert.notEqual(elsewhere, read(DRAWING));
    writeFileSync(file, elsewhere);
    await select("Head");
    const both = made(elsewhere, await paint("Head", "#aa5500"));
    await editor.has(both, "the change in what was saved elsewhere");
    // The text is not saved, and the other program saves: the editor asks before it writes over that.
    const again = elsewhere.replace("another program", "a third one");
    writeFileSync(file, again);
    await editor.press("Control+1");
    await editor.until("the question", async () => {
      await editor.press("Control+s");
      return (await editor.messages()).some((one) => /newer/.test(one));
    });
    assert.equal(read(DRAWING), again, "what was saved elsewhere is there");
    assert.equal(await editor.text(), both, "and so is what was changed here");
    await (await editor.see(".notifications-toasts .monaco-button", "Overwrite")).click();
    await editor.until("the text to be saved", () => read(DRAWING) === both);
    await page.setViewportSize({ width: 1280, height: 800 });
  });
}
