import assert from "node:assert/strict";
import { test } from "node:test";
import { Matrix4, Vector3 } from "three";
import type { Page } from "playwright-core";
import { bendFor, ratioAt } from "../src/viewport/bend";
import { camera, overlaps, picture, project, resize, shown, still, type Colour } from "./browser";
import { FRONT, island, SIDE, TOP } from "./cube";
import { browse, build, FIGURE, isLike } from "./setup";

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

test("the stretch grows to √2 at 45° and is gone at the ground and from above", () => {
  for (const [elevation, ratio] of [[0, 1], [22.5, (1 + Math.SQRT2) / 2], [45, Math.SQRT2], [-45, Math.SQRT2], [67.5, (1 + Math.SQRT2) / 2], [90, 1], [-90, 1]] as const) assert.ok(Math.abs(ratioAt(radians(elevation)) - ratio) < 1e-12, `${elevation}°`);
});

test("the bend is a rotation by 45°, a stretch upward and the rotation back, relative to the viewer", () => {
  const near = (a: Matrix4, b: Matrix4): void => a.elements.forEach((value, at) => assert.ok(Math.abs(value - b.elements[at]!) < 1e-9, `${a.elements.join(" ")} is not ${b.elements.join(" ")}`));
  for (const [elevation, amount] of [[30, 1], [45, 1], [45, 0.5], [70, 1]] as const) {
    const stretch = 1 + amount * (ratioAt(radians(elevation)) - 1);
    const turn = new Matrix4().makeRotationX(radians(45));
    const drawn = turn.clone().invert().multiply(new Matrix4().makeScale(1, stretch, 1)).multiply(turn);
    const towards = new Vector3(0, Math.sin(radians(elevation)), Math.cos(radians(elevation)));
    near(bendFor(towards, amount), drawn);
    const round = new Matrix4().makeRotationY(2);
    near(bendFor(towards.clone().applyMatrix4(round), amount), round.clone().multiply(drawn).multiply(round.clone().invert()));
  }
  near(bendFor(new Vector3(0, 1, 0), 1), new Matrix4());
});

const prepare = (host: { add(id: string): void; built(id: string, made: ReturnType<typeof island>): void }): void => {
  host.add("island.svg");
  host.built("island.svg", island());
};

/** The bounding box of the coloured pixels in the picture, and which share of it is filled. */
async function box(page: Page, colour: Colour, name?: string): Promise<{ width: number; height: number; top: number; filled: number }> {
  const { data, width: wide } = await picture(page, name);
  let [left, right, top, bottom, count] = [Infinity, -1, Infinity, -1, 0];
  for (let at = 0; at < data.length; at += 4) {
    if (!isLike([data[at]!, data[at + 1]!, data[at + 2]!], colour, 12)) continue;
    const [x, y] = [(at / 4) % wide, Math.floor(at / 4 / wide)];
    [left, right, top, bottom, count] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y), count + 1];
  }
  const [width, height] = [right - left + 1, bottom - top + 1];
  return { width, height, top, filled: count / (width * height) };
}

const near = (a: number, b: number, what: string, most = 3): void => assert.ok(Math.abs(a - b) <= most, `${what}: ${a} is not ${b}`);
const slider = (page: Page) => page.getByRole("slider", { name: "From true 3D to the drawn look" });

browse("in the drawn view tops and fronts are squares; the slider leads to true 3D", prepare, async (page) => {
  await shown(page);
  await page.getByRole("button", { name: "Drawn view" }).click();
  await still(page);
  assert.match(await camera(page), /parallel$/);
  const [top, front] = [await box(page, TOP, "drawn-view"), await box(page, FRONT)];
  assert.ok(top.width > 100, `${top.width} pixels`);
  for (const [what, one] of [["top", top], ["front", front]] as const) {
    near(one.height, one.width, `the ${what} is square`);
    assert.ok(one.filled > 0.97, `the ${what} fills ${one.filled}`);
  }
  near(front.width, top.width, "as wide");
  near(front.top, top.top + top.height, "the front begins where the top ends");

  await slider(page).focus();
  await page.keyboard.press("Home");
  await still(page);
  assert.equal(await slider(page).getAttribute("aria-valuetext"), "true 3D");
  const [low, plain] = [await box(page, TOP, "true-3d"), await box(page, FRONT)];
  near(low.height, low.width * Math.SQRT1_2, "the top in true 3D");
  near(plain.height, plain.width * Math.SQRT1_2, "the front in true 3D");
  near(low.width, top.width, "the width stays");
  await slider(page).fill("0.5");
  await still(page);
  assert.equal(await slider(page).getAttribute("aria-valuetext"), "50 % of the drawn look");
  near((await box(page, TOP)).height, (low.height + top.height) / 2, "half of it");
});

browse("the bend follows the camera around and up, and keys have the effects of buttons", prepare, async (page) => {
  await shown(page);
  await page.keyboard.press("4");
  await still(page);
  const drawn = await box(page, FRONT);
  near(drawn.height, drawn.width, "the front");
  for (let n = 0; n < 9; n++) await page.keyboard.press("ArrowRight");
  await still(page);
  const side = await box(page, SIDE, "drawn-from-the-side");
  near(side.height, side.width, "the side, from the side");
  near(side.width, drawn.width, "as large as the front");
  await page.keyboard.press("b");
  await still(page);
  assert.equal(await slider(page).inputValue(), "0");
  near((await box(page, SIDE)).height, drawn.width * Math.SQRT1_2, "the side in true 3D");
  // Where nothing is bent, both are the same.
  for (const view of ["1", "7"]) {
    await page.keyboard.press(view);
    await still(page);
    const colour = view === "1" ? FRONT : TOP;
    const plain = await box(page, colour);
    near(plain.height, plain.width, `${view} in true 3D`);
    await page.keyboard.press("b");
    await still(page);
    const bent = await box(page, colour);
    // Pixels that the edges cross are counted until the page has smoothed the edges, which takes a while: one on each side.
    for (const side of ["width", "height"] as const) near(bent[side], plain[side], `${view} as drawn: the ${side}`, 2);
  }
  assert.equal(await page.locator("canvas").getAttribute("data-view").then((view) => view?.endsWith("parallel")), true);
});

browse("bent terrain is picked and framed as it appears", prepare, async (page, host) => {
  await shown(page);
  await page.keyboard.press("4");
  await still(page);
  const canvas = (await page.locator("canvas").boundingBox())!;
  const [top, front] = [await box(page, TOP), await box(page, FRONT)];
  const high = top.height + front.height;
  assert.ok(high > canvas.height * 0.7 && high < canvas.height * 0.95, `${high} of ${canvas.height} pixels`);
  near(top.top - canvas.y, canvas.y + canvas.height - (front.top + front.height), "as much is left above as below", 6);
  // The back edge of the top, which without the bend would be a fifth of the cube lower. Its node is at (3, 0, −2).
  const edge = await project(page, 3.5, 0, -2);
  const unit = top.width;
  await page.mouse.click(edge.x, edge.y - unit * 0.97);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["selected"] === "Island");
  await page.mouse.click(edge.x, edge.y - unit * 1.06);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["selected"] === "");
  await page.mouse.click(edge.x, edge.y + unit * 0.97);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["selected"] === "Island");
  await still(page);
  await picture(page, "drawn-selected");
  // The next build keeps the view and the slider.
  await slider(page).fill("0.25");
  const view = await camera(page);
  host.built("island.svg", island());
  await shown(page, 2);
  assert.equal(await camera(page), view);
  assert.equal(await slider(page).inputValue(), "0.25");
});

browse("the slider is shown only for models with terrain, also on a phone and in dark mode", prepare, async (page, host) => {
  await shown(page);
  const bar = page.locator(".bendbar");
  assert.deepEqual(await overlaps(page), []);
  await picture(page, "phone-bend");
  const target = (await slider(page).boundingBox())!;
  assert.ok(target.height >= 36 && target.width >= 60, `${target.width} by ${target.height}`);
  for (const width of [320, 500, 761, 1200]) {
    await resize(page, width, 740);
    assert.deepEqual(await overlaps(page), [], `at ${width} pixels`);
  }
  host.built("island.svg", island(false));
  await shown(page, 2);
  await bar.waitFor({ state: "hidden" });
  const before = await camera(page);
  for (const key of ["4", "b"]) await page.keyboard.press(key);
  await still(page);
  assert.equal(await camera(page), before);
  host.built("island.svg", island());
  await shown(page, 3);
  await bar.waitFor();
  host.built("island.svg", build(FIGURE));
  await shown(page, 4);
  await bar.waitFor({ state: "hidden" });
}, { viewport: { width: 380, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2, colorScheme: "dark" });
