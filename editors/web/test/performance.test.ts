// Performances: their chart, and the performed clip beside its original.

import assert from "node:assert/strict";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { manual, noBrowser, overlaps, picture, project, resize, seekTo, shown, still } from "./browser";
import type { Made } from "./drawings";
import type { MockHost } from "./mock";
import { performed, puppet } from "./performed";
import { browse, example, source } from "./setup";
import { SIZES } from "./sizes";

const FPS = 24;
/** The frames of the performance in which the right hand is fastest, and of the motion, from 0. */
const KEY = 36;
const MOTION_KEY = 25;
const FRAMES = 49;

const okoshi = process.env["OKOSHI"] ?? "";
const make = async (drawing: string): Promise<Made | null> => (okoshi && !noBrowser ? performed(okoshi, drawing) : null);
const made = await make(puppet('%Motion punch Perform "hands.json" Motion punch Perform "hands.json" Limited 2 12 Motion walk Perform "hands.json" Motion walk'));
const playing = (host: MockHost): void => {
  host.add("puppet.svg");
  if (made) host.built("puppet.svg", made);
};
const chart = (page: Page) => page.locator(".performance");
const drawing = (page: Page) => page.locator(".performance-picture");
const at = (page: Page) => drawing(page).evaluate((element) => [(element as SVGElement).dataset["frame"], (element as SVGElement).dataset["motion"]].map(Number));
const readout = (page: Page) => page.locator(".clips .readout").innerText();
const choose = (page: Page, clip: number) => page.locator(".clip-choice").selectOption({ index: clip });
const seek = async (page: Page, frame: number): Promise<void> => {
  await seekTo(page, (frame + 0.02) / FPS);
  await still(page);
};
const open = async (page: Page): Promise<void> => {
  await page.locator("canvas").focus();
  await page.keyboard.press("i");
  await chart(page).waitFor();
};
/** The numbers of a path. */
const numbers = async (page: Page, path: string): Promise<number[]> => ((await page.locator(path).getAttribute("d")) ?? "").match(/-?[\d.]+/g)!.map(Number);
/** The place of a frame in one of the chart's rows. */
const inChart = async (page: Page, row: "performance" | "motion", frame: number): Promise<{ x: number; y: number }> => {
  const box = (await drawing(page).boundingBox())!;
  const { x, width } = (await page.locator(".timeline").boundingBox())!;
  const seconds = Number(await page.locator(".slider").getAttribute("max"));
  return { x: x + 8 + ((width - 16) * frame) / FPS / seconds, y: box.y + (row === "performance" ? 40 : box.height - 40) };
};

/** The middle of what is red in a picture, the arm that strikes, between two x coordinates. */
async function arm(page: Page, from: number, to: number): Promise<{ x: number; y: number; count: number }> {
  const { data, width, height } = await picture(page);
  const { y: top, height: high } = (await page.locator("canvas").boundingBox())!;
  let [x, y, count] = [0, 0, 0];
  for (let row = Math.ceil(top); row < Math.min(top + high, height); row++) {
    for (let column = Math.max(Math.ceil(from), 0); column < Math.min(to, width); column++) {
      const start = (row * width + column) * 4;
      if (data[start]! - data[start + 1]! < 70 || data[start]! - data[start + 2]! < 70) continue;
      x += column;
      y += row;
      count++;
    }
  }
  return { x: x / count, y: y / count, count };
}

/** The arm of the performed figure and that of the original, each relative to its own figure. */
async function arms(page: Page): Promise<{ own: { x: number; y: number }; other: { x: number; y: number } }> {
  const offset = Number(await page.getAttribute("canvas", "data-beside"));
  const [left, right] = await Promise.all([0, offset].map((x) => project(page, x, 0, 0)));
  const box = (await page.locator("canvas").boundingBox())!;
  const middle = (left!.x + right!.x) / 2;
  const [own, other] = [await arm(page, box.x, middle), await arm(page, middle, box.x + box.width)];
  assert.ok(own.count > 30 && other.count > 30, "both arms are seen");
  return { own: { x: own.x - left!.x, y: own.y }, other: { x: other.x - right!.x, y: other.y } };
}
const far = (a: { x: number; y: number }, b: { x: number; y: number }): number => Math.hypot(a.x - b.x, a.y - b.y);

browse("the chart of a performance shows marks, joints, and which frame stands in which", playing, async (page) => {
  await shown(page);
  assert.equal(await chart(page).isVisible(), false);
  await open(page);
  assert.equal(await page.getByRole("button", { name: "Performance", exact: true }).getAttribute("aria-pressed"), "true");
  assert.equal(await chart(page).locator(".chart-summary").innerText(), "frame 26 of the motion stands in frame 37 of 49");
  assert.equal(await drawing(page).getAttribute("aria-label"), "How much the marks of hands.json move, and the joints of punch. The marks move most in frame 37 of 49, the joints in frame 26 of 49: frame 26 of the motion stands in frame 37 of 49.");
  const rows = await chart(page).getByRole("row").allInnerTexts();
  assert.deepEqual(rows.map((row) => row.split(/\s+/).filter(Boolean).join(" ")), ["Mark Parts R Effect", "red Rarm 1.00 emphasised", "green Larm 0.09 damped"]);

  assert.match(await chart(page).locator(".performance-marks p").innerText(), /^filmed by a camera that is nearest in frame 38$/);

  // A curve for each mark in both rows, in the mark's colour; the one of the emphasised mark reaches the top at its key.
  assert.equal(await page.locator(".performance-picture .performance-curve").count(), 4);
  for (const [row, frame] of [["performance", KEY], ["motion", MOTION_KEY]] as const) {
    const curve = await numbers(page, `.performance-picture .emphasized[data-row=${row}]`);
    const points = curve.flatMap((x, place) => (place % 2 === 0 ? [{ x, y: curve[place + 1]! }] : []));
    assert.equal(points.length, FRAMES);
    const top = points.reduce((a, b) => (b.y < a.y ? b : a));
    const [key] = await numbers(page, `.performance-key[data-frame="${frame + 1}"]`);
    assert.ok(Math.abs(top.x - key!) < 0.02, `the peak is at ${top.x}, the key at ${key}`);
  }
  const [from, , to] = await numbers(page, ".performance-link.of-key");
  assert.ok(from! > to!, "the key comes later in the performance");
  assert.equal(await page.locator(".performance-link").count(), 3);
  const hues = await page.locator(".performance-picture .performance-curve[data-row=motion]").evaluateAll((all) => all.map((one) => getComputedStyle(one).stroke));
  const [red, green] = hues.map((colour) => colour.match(/[\d.]+/g)!.map(Number));
  assert.ok(red![0]! > red![1]! && green![1]! > green![0]!, hues.join(" "));

  // The playhead is in both rows, through the timing.
  await seek(page, 0);
  assert.deepEqual(await at(page), [1, 1]);
  await seek(page, KEY);
  assert.deepEqual(await at(page), [KEY + 1, MOTION_KEY + 1]);
  const [above, , , below] = await numbers(page, ".performance-head");
  assert.ok(Math.abs(above! - from!) < 0.5 && Math.abs(below! - to!) < 0.5, "at the keys it lies on their line");
  await seek(page, 48);
  assert.deepEqual(await at(page), [49, 49]);
  // A click goes to a frame of either row.
  const motion = await inChart(page, "motion", MOTION_KEY);
  await page.mouse.move(motion.x, motion.y);
  assert.match(await chart(page).locator(".chart-tip").innerText(), /^frame 26 of the motion · red 1\.00 · green 0\.\d\d$/);
  await page.mouse.click(motion.x, motion.y);
  assert.match(await readout(page), /^frame 37 of 49 /);
  const input = await inChart(page, "performance", 10);
  await page.mouse.move(input.x, input.y);
  assert.match(await chart(page).locator(".chart-tip").innerText(), /^frame 11 · red 0\.\d\d · green 0\.\d\d$/);
  await page.mouse.click(input.x, input.y);
  assert.match(await readout(page), /^frame 11 of 49 /);

  // Held drawings of the limited clip stand for frames of the performance; the key pose keeps its frame.
  await choose(page, 1);
  assert.match(await chart(page).locator(".chart-summary").innerText(), /in frame 37 of 49$/);
  await seek(page, KEY);
  assert.deepEqual(await at(page), [KEY + 1, MOTION_KEY + 1]);
  // A clip that is not performed has no such chart; it opens again with the page.
  await choose(page, 3);
  assert.equal(await chart(page).isVisible(), false);
  assert.equal(await page.getByRole("button", { name: "Performance", exact: true }).isVisible(), false);
  await page.reload();
  await shown(page);
  await chart(page).waitFor();
});

browse("a performed clip and its original play side by side, by the same clock", playing, async (page) => {
  await shown(page);
  await page.keyboard.press("1");
  await page.keyboard.press("5");
  await page.getByRole("button", { name: "Performed and original side by side" }).click();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  assert.deepEqual(await page.locator(".caption").allInnerTexts(), ["performed", "original"]);
  // The pose that stands in the key frame is that of the original's key.
  await seek(page, MOTION_KEY);
  const before = await arms(page);
  await seek(page, KEY);
  const after = await arms(page);
  assert.ok(far(after.own, before.other) < 2, `the key pose: ${JSON.stringify([after.own, before.other])}`);
  assert.ok(far(before.own, before.other) > 5, "at the same time the two differ");
  await picture(page, "performance-beside");

  // The original of a limited clip is the motion in full, without the performance.
  await choose(page, 1);
  await seek(page, MOTION_KEY);
  assert.ok(far((await arms(page)).other, before.other) < 2);
  // A shorter original waits at its end.
  await choose(page, 2);
  await seek(page, 30);
  const waits = await arms(page);
  await seek(page, 44);
  assert.ok(far((await arms(page)).other, waits.other) < 1);
  assert.ok(far((await arms(page)).own, waits.own) > 2);
  // A clip without a performance is the same on both sides.
  await choose(page, 3);
  await seek(page, 7);
  const same = await arms(page);
  assert.deepEqual(await page.locator(".caption").allInnerTexts(), ["full", "full"]);
  assert.ok(far(same.own, same.other) < 2);
});

browse("in the dark and at any width the chart of a performance has its place", playing, async (page) => {
  await shown(page);
  await open(page);
  await page.locator("canvas").focus();
  await page.keyboard.press("o");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  await seek(page, KEY - 6);
  for (const width of [1600, 1200, 1024, 900, 761, 760, 500, 380, 320]) {
    await resize(page, width, 800);
    assert.deepEqual(await overlaps(page), [], `at ${width} pixels`);
    const clipped = await page.locator(".performance-marks").evaluate((element) => element.scrollWidth > element.clientWidth + 1);
    assert.equal(clipped, false, `the table is whole at ${width} pixels`);
  }
  await resize(page, 1200, 800);
  await still(page);
  await picture(page, "performance-dark");
}, { colorScheme: "dark" });

browse("on a phone the chart of a performance is touched, and leaves room for the model", playing, async (page) => {
  await shown(page);
  await page.getByRole("button", { name: "Performance", exact: true }).tap();
  assert.deepEqual(await overlaps(page), []);
  const key = await inChart(page, "motion", MOTION_KEY);
  await page.touchscreen.tap(key.x, key.y);
  await still(page);
  assert.match(await readout(page), /frame 37 of 49/);
  await picture(page, "performance-phone");
  const { height } = (await page.locator("canvas").boundingBox())!;
  assert.ok(height > 140, `the model has ${height} pixels`);
}, { viewport: { width: 380, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });

for (const { name, ...size } of SIZES) {
  browse(`${name}: both charts leave the model half of the window, and their curves have names`, playing, async (page) => {
    await shown(page);
    for (const chart of ["Chart", "Performance"]) {
      await page.getByRole("button", { name: chart, exact: true }).click();
    }
    await still(page);
    const { height } = (await page.locator("canvas").boundingBox())!;
    const share = height / page.viewportSize()!.height;
    assert.ok(share >= 0.499, `the model has ${share}`);
    assert.deepEqual(await overlaps(page), []);
    // In the table, or in the chart where the table has no room.
    const table = await page.locator(".performance-marks").evaluate(({ clientHeight }) => clientHeight);
    assert.equal(await page.locator(".performance-legend").isVisible(), table < 44);
    assert.match(await page.locator(table < 44 ? ".performance-legend" : ".performance-marks").innerText(), /red[^]*green/);
    await picture(page, `charts-${name}`);
  }, size);
}

const kicker = await make(
  source(example(join("motion", "kick")))
    .replace("Rforearm@Rarm<", "Rforearm@Rarm$Mark red<")
    .replace("Lforearm@Larm<", "Lforearm@Larm$Mark green<")
    .replace(/Motion "kick\.bvh"[^<]*/, 'Motion punch Perform "hands.json"'),
);

browse("the picture of the manual", (host) => {
  host.add("kick.svg");
  if (kicker) host.built("kick.svg", kicker);
}, async (page) => {
  await shown(page);
  await open(page);
  await page.locator("canvas").focus();
  await page.keyboard.press("o");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  // Just after the key, so that the playhead does not cover the line between the keys.
  await seek(page, KEY + 1);
  await page.evaluate(() => (document.activeElement as HTMLElement).blur());
  await page.mouse.move(2, 2);
  await still(page);
  await manual(page, "preview-performance.png");
  assert.deepEqual(await page.locator(".caption").allInnerTexts(), ["performed", "original"]);
}, { viewport: { width: 1180, height: 760 }, smoothEdges: true });
