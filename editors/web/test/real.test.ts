// The page with the real program: `okoshi preview`, files that are saved, and the result on the page.

import assert from "node:assert/strict";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import type { Browser, Page } from "playwright-core";
import { camera, launch, noBrowser, open, picture, project, shown, still } from "./browser";
import { closeAll, closing, preview, TEST_LIMIT } from "./closing";
import { assertLike, example, FIGURE, isLike, source } from "./setup";

const okoshi = process.env["OKOSHI"] ?? "";
const skip = noBrowser !== false ? noBrowser : !okoshi ? "there is no okoshi program; OKOSHI names one" : false;
const RED = [255, 0, 0] as const;
const GREEN = [0, 160, 0] as const;
const BLUE = [0, 0, 255] as const;

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

/** A test with a figure in a folder, and `okoshi preview` of the folder or of the drawing. */
function real(name: string, target: string, run: (page: Page, folder: string) => Promise<void>): void {
  test(name, { skip, timeout: TEST_LIMIT }, async (t) => {
    const onClose = closing(t);
    const folder = mkdtempSync(join(tmpdir(), "okoshi-page-"));
    onClose(() => rmSync(folder, { recursive: true }));
    copyFileSync(FIGURE, join(folder, "figure.svg"));
    mkdirSync(join(folder, "more"));
    copyFileSync(example("human"), join(folder, "more", "human.svg"));
    if (target === "moving") {
      mkdirSync(join(folder, "moving"));
      for (const file of ["kick.svg", "kick.bvh"]) copyFileSync(join("..", "..", "examples", "motion", file), join(folder, "moving", file));
    }
    if (target === "empty") mkdirSync(join(folder, "empty"));
    const { address } = await preview(okoshi, folder, target === "moving" ? join(target, "kick.svg") : target, onClose);
    browser ??= launch();
    const { page, wrong } = await open(await browser, address, onClose);
    await run(page, folder);
    assert.deepEqual(wrong, []);
  });
}

/** The position in the window of a point of the figure's drawing; `front` is the height of its face. */
const at = (page: Page, x: number, y: number, front: number): Promise<{ x: number; y: number }> => project(page, (x - 180) / 100, (200 - y) / 100, front);
const save = (folder: string, change: (text: string) => string): void => writeFileSync(join(folder, "figure.svg"), change(source(FIGURE)));

real("a save changes the picture, and the camera stays", "figure.svg", async (page, folder) => {
  await shown(page, 1);
  for (const key of ["1", "ArrowLeft", "ArrowUp"]) await page.keyboard.press(key);
  await still(page);
  const view = await camera(page);
  assertLike((await picture(page)).at(await at(page, 140, 180, 0.2)), RED, "the body", 80);
  assertLike((await picture(page)).at(await at(page, 220, 120, 0.08)), GREEN, "the arm", 80);
  save(folder, (text) => text.replace("#ff0000", "#0000ff"));
  await shown(page, 2);
  assert.equal(await camera(page), view);
  assertLike((await picture(page, "real")).at(await at(page, 140, 180, 0.2)), BLUE, "the body that was saved", 80);
});

real("an error is shown over what can be built until it is fixed", "figure.svg", async (page, folder) => {
  await shown(page, 1);
  await page.keyboard.press("1");
  save(folder, (text) => text.replace("#ff0000", "#0000ff").replace("Arm@Body", "Arm@Bdoy"));
  await page.waitForSelector(".findings[data-open=true]");
  const finding = await page.locator(".finding").first().innerText();
  assert.match(finding, /Problem: there is no part named Bdoy/);
  assert.equal(await page.locator(".finding mark").first().innerText(), "Bdoy");
  await still(page);
  assertLike((await picture(page)).at(await at(page, 140, 110, 0.2)), BLUE, "what can be built", 80);
  save(folder, (text) => text.replace("#ff0000", "#0000ff"));
  await page.locator(".findings").waitFor({ state: "hidden" });
  await shown(page);
  assertLike((await picture(page)).at(await at(page, 140, 180, 0.2)), BLUE, "the new body", 80);
});

real("posing turns the half of an arm that is taken hold of, and the elbow stays whole", "figure.svg", async (page, folder) => {
  await shown(page, 1);
  save(folder, (text) => text.replace(" Bend 0", ""));
  await shown(page, 2);
  await page.keyboard.press("1");
  await page.keyboard.press("p");
  await still(page);
  const [elbow, tip, shoulder] = [await at(page, 210, 120, 0.08), await at(page, 240, 120, 0.08), await at(page, 180, 120, 0.08)];
  await page.mouse.move(tip.x, tip.y);
  await page.mouse.down();
  await page.mouse.move(elbow.x, elbow.y - (tip.x - elbow.x), { steps: 6 });
  await page.mouse.up();
  assert.match((await page.locator(".pose-readout").innerText()).trim(), /^Arm\.2 \+(8[5-9]|9\d|10[0-5])°$/);
  await page.keyboard.press("p");
  await page.mouse.move(5, 5);
  await still(page);
  const seen = await picture(page, "real-bent");
  assertLike(seen.at(shoulder), GREEN, "the upper half stays", 80);
  assertLike(seen.at(elbow), GREEN, "the elbow is whole", 80);
  assertLike(seen.at({ x: elbow.x + 12, y: elbow.y - (tip.x - elbow.x) }), GREEN, "the lower half is turned", 80);
  assert.ok(!isLike(seen.at(tip), GREEN, 80), "nothing is left where it was");
  // The outline of the selected part follows its bones.
  await page.mouse.click(shoulder.x, shoulder.y);
  assert.equal(await page.locator(".tree-item[aria-selected=true]").getAttribute("data-part"), "Arm");
});

real("a click reports the part, and posing turns the limb about its joint", "figure.svg", async (page) => {
  await shown(page, 1);
  await page.keyboard.press("1");
  await still(page);
  const tip = await at(page, 240, 120, 0.08);
  await page.mouse.click(tip.x, tip.y);
  await page.waitForSelector("[data-part=Arm][aria-selected=true]");
  assert.equal(await page.locator(".inspector code").innerText(), "Arm@Body$Shape default -8 8 Bend 0");
  // The joint is where the arm meets the body, at (170, 120): dragging its tip to above the joint turns it up.
  await page.locator("canvas").focus();
  await page.keyboard.press("p");
  const above = await at(page, 172, 50, 0.08);
  await page.mouse.move(tip.x, tip.y);
  await page.mouse.down();
  await page.mouse.move(above.x + 30, above.y + 10, { steps: 6 });
  await page.mouse.move(above.x, above.y, { steps: 6 });
  await page.mouse.up();
  await still(page);
  const seen = await picture(page, "real-posed");
  assert.ok(!isLike(seen.at(await at(page, 230, 120, 0)), GREEN), "the arm has left its place");
  assertLike(seen.at(await at(page, 171, 60, 0.08)), GREEN, "the arm above its joint", 80);
});

real("a folder is a gallery with pictures; new drawings appear", ".", async (page, folder) => {
  await page.waitForFunction(() => [...document.querySelectorAll<HTMLImageElement>(".card img")].filter((image) => image.complete && image.naturalWidth > 0).length === 2);
  assert.match(await page.locator(".gallery").innerText(), /figure\.svg\s+3 parts\s+human\.svg\s+more\s+7 parts/);
  copyFileSync(example("dog"), join(folder, "more", "dog.svg"));
  await page.waitForFunction(() => document.querySelectorAll(".card img").length === 3);
  await page.locator(".card", { hasText: "human.svg" }).click();
  await shown(page);
  assert.equal(await page.locator("[data-part=Ubody]").count(), 1);
});

real("an empty folder offers starters, and a click begins one", "empty", async (page, folder) => {
  await page.waitForFunction(() => document.querySelectorAll("[data-starter] img").length === 8);
  await picture(page, "starters");
  assert.equal(await page.locator("[data-starter]").count(), 9);
  await page.locator("[data-starter=robot]").click();
  await shown(page, 1);
  assert.equal(await page.title(), "robot.svg · okoshi");
  assert.ok(existsSync(join(folder, "empty", "robot.svg")));
  assert.match(await page.locator(".clips").innerText(), /walk/);
});

real("a clip plays, its drawings are marked, and the full motion is shown beside it", "moving", async (page, folder) => {
  await shown(page, 1);
  assert.match(await page.locator(".clips").innerText(), /kick · 2\.8 s · 34 drawings/);
  await page.keyboard.press("c");
  assert.equal(await page.locator(".chart-gone").getAttribute("data-marks"), "4");
  assert.match(await page.locator(".chart").innerText(), /68 frames, 34 drawings, 4 in-betweens omitted, 30 held/);
  await page.keyboard.press("o");
  await page.waitForFunction(() => [...document.querySelectorAll<HTMLElement>(".captions > *")].map((caption) => caption.innerText).sort().join() === "full,limited");
  await page.locator("[data-part=Rshin]").click();
  assert.match(await page.locator(".inspector").innerText(), /RightLeg/);
  // A moving picture of the clip, with each of its drawings.
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Shift+D")]);
  assert.equal(download.suggestedFilename(), "kick-kick.gif");
  const gif = readFileSync(await download.path());
  assert.equal(gif.subarray(0, 6).toString(), "GIF89a");
  assert.equal(gif.readUInt16LE(6), 480);
  assert.equal(await page.locator(".notes").isVisible(), false);
  const drawing = join(folder, "moving", "kick.svg");
  writeFileSync(drawing, source(drawing).replace("Limited 4 30", ""));
  await page.waitForFunction(() => /kick · 2\.8 s$/.test(document.querySelector<HTMLSelectElement>(".clips select")?.selectedOptions[0]?.text ?? ""));
  assert.equal(await page.locator(".captions").isVisible(), false);
});
