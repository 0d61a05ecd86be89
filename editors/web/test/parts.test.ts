import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { camera, countRows, picture, project, shown, still, type Colour } from "./browser";
import { browse, build, example, FIGURE, isLike, one } from "./setup";
import { kick, LEG } from "./kick";

const HUMAN = example("human");
const MANY = 10_000;
const active = (page: Page) => page.evaluate(() => document.activeElement?.getAttribute("data-part") ?? document.activeElement?.getAttribute("aria-label"));
const rows = (page: Page) => page.locator(".tree-item").evaluateAll((items) => items.map((item) => item.getAttribute("data-part")));

/** Ten thousand parts: ten hang on each of the first thousand. */
const name = (at: number): string => `${at % 7 === 0 ? "Leaf" : "Twig"}-${at}`;
const many = (joint: string | null) => Array.from({ length: MANY }, (_, at) => ({ name: name(at), parent: at === 0 ? null : name(Math.floor((at - 1) / 10)), kind: "main", element: `e${at}`, string: null, named_by: "id", attributes: {}, joint }));

browse("of ten thousand parts only the visible rows are made", (host) => {
  const { build: facts, ...rest } = build(FIGURE);
  host.add("many.svg");
  host.built("many.svg", { ...rest, build: { ...facts, findings: [], parts: many(null) } });
}, async (page, host) => {
  await shown(page, 1);
  assert.equal(await page.locator(".bar-facts span").first().innerText(), "10,000 parts");
  const count = await page.locator(".tree-item").count();
  assert.ok(count > 10 && count < 80, `${count} rows are in the page`);
  const list = page.locator(".tree");
  assert.ok(await list.evaluate((tree) => tree.scrollHeight) > MANY * 26);
  // Folds and opens the root, which shows other rows, as a save does: only those in sight are made.
  await page.keyboard.press("t");
  for (const [key, most] of [["ArrowLeft", 1], ["ArrowRight", count]] as const) {
    const rows = await countRows(page);
    await page.keyboard.press(key);
    const made = await rows();
    assert.ok(made > 0 && made <= most, `${key} makes ${made} rows`);
  }

  await page.keyboard.press("End");
  const last = (await active(page))!;
  assert.ok(await page.locator(`[data-part="${last}"]`).isVisible());
  assert.equal(await page.locator(`[data-part="${last}"]`).evaluate((item) => item.getBoundingClientRect().bottom <= item.closest(".tree")!.getBoundingClientRect().bottom + 1), true, "the last row is in sight");
  // The row with the focus stays, wherever the list is scrolled.
  await list.evaluate((tree) => {
    const scrolled = new Promise((resolve) => tree.addEventListener("scroll", resolve, { once: true }));
    tree.scrollTop = 0;
    return scrolled;
  });
  assert.equal(await active(page), last);
  await page.keyboard.press("ArrowUp");
  assert.notEqual(await active(page), last);
  // A save that changes a row keeps place and focus.
  const at = await active(page);
  host.built("many.svg", { model: null, picture: null, build: { milliseconds: 1, stale: false, triangles: 0, findings: [], parts: many("Hips") } });
  await page.waitForSelector(".tree-note >> text=Hips");
  assert.equal(await active(page), at);
  // A part that is lit from the editor is scrolled to.
  host.say({ type: "light", drawing: "many.svg", part: "Twig-5003" });
  await page.waitForSelector(".tree-item.lit[data-part='Twig-5003']");
  assert.equal(await page.locator("[data-part='Twig-5003']").getAttribute("aria-posinset"), "3");
  assert.equal(await page.locator("[data-part='Twig-5003']").getAttribute("aria-setsize"), "10");
});

browse("letters typed in the list go to the part whose name begins so", one(HUMAN), async (page) => {
  await shown(page);
  // The time at which keys are pressed, in milliseconds.
  const setTime = (time: number) => page.evaluate((time) => Object.defineProperty(Event.prototype, "timeStamp", { get: () => time, configurable: true }), time);
  await setTime(1000);
  await page.keyboard.press("t");
  await page.keyboard.type("he");
  assert.equal(await active(page), "Head");
  await setTime(2000);
  await page.keyboard.press("u");
  const first = await active(page);
  assert.match(first!, /^[Uu]/);
  await setTime(3000);
  await page.keyboard.press("u");
  const second = await active(page);
  assert.match(second!, /^[Uu]/);
  assert.notEqual(second, first, "the same letter again goes on");
  // Whoever chose a part with the pointer types shortcuts.
  await page.locator("[data-part=Ubody]").click();
  await page.keyboard.press("z");
  assert.equal(await page.getAttribute("canvas", "data-shading"), "flat");
});

browse("the search lists the parts that match and what they hang on", one(HUMAN), async (page) => {
  await shown(page);
  const all = await rows(page);
  await page.keyboard.press("/");
  assert.equal(await active(page), "Search parts");
  await page.keyboard.type("head");
  assert.deepEqual((await rows(page)), ["Ubody", "Head"]);
  assert.match(await page.locator(".tree-panel h2").innerText(), /\d+ of \d+/);
  assert.ok(await page.locator("[data-part=Ubody]").evaluate((row) => row.classList.contains("above")));
  await picture(page, "search");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Head");
  await page.keyboard.press("ArrowDown");
  assert.equal(await active(page), "Head");
  await page.keyboard.press("/");
  await page.keyboard.type("nothing like this");
  await page.getByText("No part matches.").waitFor();
  assert.deepEqual(await rows(page), []);
  await page.keyboard.press("Escape");
  assert.deepEqual(await rows(page), all);
  assert.equal(await active(page), "Search parts");
  await page.keyboard.press("Escape");
  assert.equal(await active(page), "Head");
});

browse("parts are hidden and shown by key, button and eye, and one is shown alone", (host) => {
  host.add("kick.svg");
  host.built("kick.svg", kick());
}, async (page) => {
  await shown(page);
  await page.locator(".slider").fill("0");
  await page.locator("canvas").focus();
  await page.keyboard.press("1");
  await still(page);
  // In the middle of the leg's front; the camera of the test looks where the page does.
  const at = await project(page, 0.1, 0.5, 0.08);
  const sees = async (): Promise<boolean> => {
    await page.mouse.move(2, 2);
    await still(page);
    return isLike((await picture(page)).at(at), LEG as Colour);
  };
  assert.ok(await sees(), "the leg is seen");
  await page.locator("[data-part=Leg]").click();
  await page.keyboard.press("h");
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "Leg");
  assert.equal(await sees(), false);
  assert.equal(await page.locator("[data-part=Leg]").getAttribute("aria-description"), "hidden");
  await page.mouse.click(at.x, at.y);
  assert.equal(await page.getAttribute("canvas", "data-selected"), "", "the pointer does not meet it");
  await page.locator("[data-part=Leg] .tree-eye").click();
  assert.ok(await sees());

  await page.locator("[data-part=Leg]").click();
  const only = page.getByRole("button", { name: "Show only this part" });
  await only.click();
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "Body Stand Head");
  assert.ok(await sees(), "a part is shown although the one that carries it is hidden");
  assert.equal(await only.evaluate((button) => button === document.activeElement), true, "the button keeps the focus");
  await page.getByRole("button", { name: "Show all: 3 parts are hidden" }).click();
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "");
  assert.equal(await active(page), "Leg");

  await page.locator("[data-part=Body]").click();
  await page.getByRole("button", { name: "Hide" }).click();
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "Body Leg Stand Head", "what hangs on a part is hidden with it");
  await page.getByRole("button", { name: "Show", exact: true }).click();
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "");
});

browse("F frames the selected part, Home the whole model", one(HUMAN), async (page) => {
  await shown(page);
  const whole = await camera(page);
  const height = async () => Number((await camera(page)).split(" ")[6]);
  const before = await height();
  await page.locator("[data-part=Head]").click();
  await page.keyboard.press("f");
  await still(page);
  assert.ok((await height()) < before * 0.7, "nearer");
  await page.locator("canvas").focus();
  await page.keyboard.press("Home");
  await still(page);
  assert.equal(await camera(page), whole);
  await page.keyboard.press("Escape");
  await page.keyboard.press("+");
  await page.keyboard.press("f");
  await still(page);
  assert.equal(await camera(page), whole, "without a selection all of it");
});
