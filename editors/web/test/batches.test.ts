// Large models are drawn in batches: everything works as in small ones.

import assert from "node:assert/strict";
import { writeFileSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import type { Page } from "playwright-core";
import { picture, project, shown, still, type Colour } from "./browser";
import { assertLike, browse, build, isLike } from "./setup";

const SIDE = 20;
const COLOURS: readonly Colour[] = [[200, 55, 55], [42, 127, 255], [55, 200, 113], [255, 204, 0], [141, 95, 211]];
const colourOf = (at: number): Colour => COLOURS[at % COLOURS.length]!;

/** Boxes in rows; all hang on the first one but P1, which carries P2. */
const parts = Array.from({ length: SIDE * SIDE }, (_, at) => {
  const [x, y] = [20 * (at % SIDE), 20 * Math.floor(at / SIDE)];
  const parent = at === 0 ? "" : at === 2 ? "@P1" : "@P0";
  return `<rect id="e${at}" x="${x}" y="${y}" width="16" height="16" fill="rgb(${colourOf(at).join()})"/><text x="${x + 2}" y="${y + 9}" font-size="3">P${at}${parent}$Shape default -4 4</text>`;
});
const folder = mkdtempSync(join(tmpdir(), "okoshi-batches-"));
const FILE = join(folder, "grid.svg");
writeFileSync(FILE, `<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">\n${parts.join("\n")}\n</svg>\n`);
after(() => rmSync(folder, { recursive: true }));

/** The position in the window of the middle of a part's face, seen from the front. */
const middle = (page: Page, at: number): Promise<{ x: number; y: number }> => project(page, (20 * (at % SIDE) + 8 - 200) / 100, (400 - 20 * Math.floor(at / SIDE) - 8) / 100, 0.04);
const PAPER = [245, 243, 238] as const;

/** The number of draw calls of the last frame. */
const count = (page: Page) => page.evaluate(() => (window as unknown as { calls: number }).calls);

browse("a large model takes few draw calls; its parts are coloured, hidden, picked, posed and lined like others", (host) => {
  host.add("grid.svg");
  host.built("grid.svg", build(FILE));
}, async (page, host) => {
  await page.addInitScript(() => {
    const counted = window as unknown as { calls: number };
    counted.calls = 0;
    const { prototype } = WebGL2RenderingContext;
    const draw = prototype.drawElements;
    prototype.drawElements = function (...rest) {
      counted.calls++;
      draw.apply(this, rest);
    };
  });
  await page.reload();
  await shown(page, 1);
  await page.keyboard.press("1");
  await still(page);
  const places = await Promise.all([0, 1, 2, 47, 203, 399].map(async (at) => [at, await middle(page, at)] as const));
  const whole = await picture(page, "batches");
  for (const [at, place] of places) assertLike(whole.at(place), colourOf(at), `part ${at}`, 80);
  await page.evaluate(() => ((window as unknown as { calls: number }).calls = 0));
  await page.keyboard.press("ArrowLeft");
  await still(page);
  assert.ok(await count(page) < 20, `${await count(page)} draw calls`);
  await page.keyboard.press("1");
  await still(page);

  // Picking and marks.
  const [, leaf] = places[4]!;
  await page.mouse.click(leaf.x, leaf.y);
  await page.waitForSelector("[data-part=P203][aria-selected=true]");
  assert.equal(await page.getAttribute("canvas", "data-selected"), "P203");
  await still(page);
  const marked = await picture(page);
  assert.notDeepEqual(marked.data, whole.data);
  await page.keyboard.press("Escape");

  // All looks, and back.
  for (const look of ["flat", "wire", "edges", "smooth"]) {
    await page.keyboard.press("z");
    await still(page);
    assert.equal(await page.getAttribute("canvas", "data-shading"), look);
    const seen = await picture(page, `batches-${look}`);
    const [at, place] = places[3]!;
    if (look === "wire") assert.ok(!isLike(seen.at({ x: place.x + 3, y: place.y + 1 }), colourOf(at), 30), "wires have gaps");
    else assertLike(seen.at({ x: place.x + 3, y: place.y + 1 }), colourOf(at), `part ${at}, ${look}`, 90);
  }

  // A save of one part; the others stay.
  host.built("grid.svg", build(FILE, (text) => text.replace(/(id="e47"[^>]*)fill="[^"]*"/, '$1fill="#000000"')));
  await shown(page, 2);
  await page.mouse.move(5, 5);
  await still(page);
  const saved = await picture(page);
  assertLike(saved.at(places[3]![1]), [0, 0, 0], "the changed part", 60);
  assertLike(saved.at(leaf), colourOf(203), "another part", 80);

  // A hidden part leaves a hole.
  await page.mouse.click(leaf.x, leaf.y);
  await page.waitForSelector("[data-part=P203][aria-selected=true]");
  await page.keyboard.press("h");
  await page.mouse.move(5, 5);
  await still(page);
  assert.match((await page.getAttribute("canvas", "data-hidden")) ?? "", /P203/);
  assertLike((await picture(page)).at(leaf), PAPER, "where the hidden part was", 60);
  await page.keyboard.press("a");
  await still(page);
  assertLike((await picture(page)).at(leaf), colourOf(203), "the part that is shown again", 80);

  // Turning P1 carries P2 along.
  const [, carrier] = places[1]!;
  const [, carried] = places[2]!;
  await page.mouse.click(carrier.x, carrier.y);
  await page.keyboard.press("p");
  await page.locator("canvas").focus();
  for (let n = 0; n < 9; n++) await page.keyboard.press(",");
  await page.mouse.move(5, 5);
  await still(page);
  assert.ok(!isLike((await picture(page, "batches-posed")).at(carried), colourOf(2), 40), "P2 has left its place");
});
