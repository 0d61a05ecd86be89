// Clips that are chosen in the form of a part, with the real program: what a person does on the page, and the bytes of the file.

import assert from "node:assert/strict";
import { join } from "node:path";
import { manual, picture, still, type } from "./browser";
import { edit } from "./edited";
import { example, FIGURE, source } from "./setup";

const BEFORE = source(FIGURE);
const BODY = "Body$Shape default -20 20";

edit("a figure gets a clip, a speed, limited animation and another clip, and undo and Reset take all of it back", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Body");
  const texts = [BEFORE];
  const says = async (string: string): Promise<void> => {
    texts.push(BEFORE.replace(BODY, `${BODY}${string}`));
    await edited.has(texts.at(-1)!, string);
  };
  const clips = () => page.locator(".clip-choice option").allInnerTexts();
  assert.equal(await page.locator(".motion").isVisible(), false);
  const clip = edited.label("Motion: clip");
  assert.equal(await clip.inputValue(), "none");
  await clip.selectOption("=wave");
  await says(" Motion wave");
  await page.locator(".motion").waitFor();
  await page.waitForFunction(() => /^wave · 2\.5 s/.test(document.querySelector(".clip-choice option")?.textContent ?? ""));
  await type(edited.label("Motion: speed, as a number"), "2");
  await page.keyboard.press("Enter");
  await says(" Motion wave speed 2");
  await page.waitForFunction(() => /^wave · 1\.3 s/.test(document.querySelector(".clip-choice option")?.textContent ?? ""));

  // While the slider is dragged the model shows it, and the drawing stays as it is.
  const seconds = edited.label("Motion: seconds");
  await page.locator(".part-form[aria-busy=false]").waitFor();
  await seconds.scrollIntoViewIfNeeded();
  const { x, y, width, height } = (await seconds.boundingBox())!;
  await page.mouse.move(x + 3, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width + 20, y + height / 2, { steps: 4 });
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["tried"] !== "");
  assert.equal(edited.text(), texts.at(-1));
  await page.mouse.up();
  await says(" Motion wave 10 speed 2");
  await type(edited.label("Motion: seconds, as a number"), "");
  await page.keyboard.press("Enter");
  await says(" Motion wave speed 2");
  await page.locator(".part-form[aria-busy=false]").waitFor();
  // Whoever is quick does not wait for the form to say what was changed last: nothing of that is lost.
  await page.evaluate(() => ["Motion -i", "Motion limited"].forEach((key) => document.querySelector<HTMLInputElement>(`[data-key="${key}"]`)!.click()));
  await says(" Motion -i wave speed 2 Limited 2 8");
  await type(edited.label("Limited: hold, as a number"), "12");
  await page.keyboard.press("Enter");
  await says(" Motion -i wave speed 2 Limited 2 12");
  await page.waitForFunction(() => /drawings/.test(document.querySelector(".clip-choice option")?.textContent ?? ""));
  await picture(page, "edit-clip");

  await page.getByRole("button", { name: "Add a clip" }).click();
  await edited.label("Motion 2: clip").selectOption("=idle");
  await says(" Motion -i wave speed 2 Limited 2 12 Motion idle");
  await page.waitForFunction(() => document.querySelectorAll(".clip-choice option").length === 2);
  assert.deepEqual((await clips()).map((text) => text.split(" ")[0]), ["wave", "idle"]);

  const undo = page.getByRole("button", { name: /^Undo/ });
  await undo.click();
  await edited.has(texts.at(-2)!, "undone");
  await page.getByRole("button", { name: /^Redo/ }).click();
  await edited.has(texts.at(-1)!, "made again");
  await page.getByRole("button", { name: "Reset Motion", exact: true }).click();
  await edited.has(BEFORE.replace(BODY, `${BODY} Motion idle`), "the first one is taken away");
  await clip.selectOption("none");
  await edited.has(BEFORE, "none");
  await page.locator(".motion").waitFor({ state: "hidden" });
});

edit("another part of the figure has its clips in a field of its own, and a clip for all is changed where it is said", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  const field = page.locator("details[data-attribute=Motion]");
  assert.match(await field.innerText(), /Motion of Body\s+none/);
  await field.locator("summary").click();
  await edited.label("Motion: clip").selectOption("=");
  await edited.has(BEFORE.replace(BODY, `${BODY} Motion`), "the one that fits");
  await page.locator("[data-part=Arm][aria-selected=true]").waitFor();
  await edited.made();
  // It is still open, and says what the drawing says.
  await page.waitForFunction(() => document.querySelector<HTMLSelectElement>('[aria-label="Motion: clip"]')?.value === "=");
});

edit("a clip that the drawing's text gives to the figure is changed in that text", async (edited) => {
  const { page } = edited;
  const before = edited.text();
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Dress");
  const clip = edited.label("Motion: clip");
  assert.equal(await clip.inputValue(), "=walk");
  await page.locator("section[data-attribute=Motion] h3").evaluate((one) => one.scrollIntoView({ block: "start" }));
  await page.getByLabel("limited animation").check();
  await edited.has(before.replace("Motion walk", "Motion walk Limited 2 8"), "limited");
  await edited.label("Limited: hold").waitFor();
  await page.locator("section[data-attribute=Motion] h3").evaluate((one) => one.scrollIntoView({ block: "start" }));
  await page.mouse.move(5, 5);
  await still(page);
  await manual(page, join("without-strings", "4-clip.png"));
  await clip.selectOption("=run");
  await edited.has(before.replace("Motion walk", "Motion run Limited 2 8"), "another clip");
}, { drawing: example("girl"), viewport: { width: 1060, height: 720 }, smoothEdges: true });

edit("a motion file beside the drawing is chosen, with its range and speed", async (edited) => {
  const { page } = edited;
  await edited.link(join("..", "..", "examples", "motion", "kick.bvh"));
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Body");
  const says = (words: string): Promise<void> => edited.has(BEFORE.replace(BODY, `${BODY} Motion ${words}`), words);
  const enter = async (which: string, number: string): Promise<void> => {
    await type(edited.label(`Motion: ${which}, as a number`), number);
    await page.keyboard.press("Enter");
  };
  const clip = edited.label("Motion: clip");
  assert.deepEqual(await clip.locator("optgroup option").allInnerTexts(), ["kick.bvh"]);
  await clip.selectOption('"kick.bvh"');
  await says('"kick.bvh"');
  await edited.label("Motion: end").waitFor();
  assert.equal(await clip.inputValue(), '"kick.bvh"');
  await enter("start", "0.5");
  await says('"kick.bvh" from 0.5');
  await enter("end", "1.5");
  await says('"kick.bvh" from 0.5 to 1.5');
  await enter("speed", "0.5");
  await says('"kick.bvh" from 0.5 to 1.5 speed 0.5');
  await page.getByLabel("in place").check();
  await says('-i "kick.bvh" from 0.5 to 1.5 speed 0.5');
  await page.waitForFunction(() => /^kick · 2\.0 s/.test(document.querySelector(".clip-choice option")?.textContent ?? ""));
  await page.locator("section[data-attribute=Motion] h3").evaluate((one) => one.scrollIntoView({ block: "start" }));
  await picture(page, "edit-file");
  // What is said of a part of the file is of no other clip.
  await clip.selectOption("=wave");
  await says("-i wave speed 0.5");
});
