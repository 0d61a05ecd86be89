import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { camera, shown, still } from "./browser";
import { kick } from "./kick";
import { FIGURE, browse, build, example, one } from "./setup";

const HUMAN = example("human");
const focus = (page: Page) => page.evaluate(() => document.activeElement?.getAttribute("data-drawing") ?? document.activeElement?.getAttribute("aria-label") ?? document.activeElement?.tagName);

browse("shortcuts of single letters can be turned off, and stay off", one(HUMAN), async (page) => {
  await shown(page);
  assert.equal(await page.getAttribute("canvas", "role"), "application");
  const shading = () => page.getAttribute("canvas", "data-shading");
  await page.getByRole("button", { name: "Help" }).click();
  const letters = page.getByRole("checkbox", { name: /^Letters, digits and signs are shortcuts/ });
  assert.equal(await letters.isChecked(), true);
  await letters.uncheck();
  await page.keyboard.press("Escape");
  await page.reload();
  await shown(page);
  const view = await camera(page);
  for (const key of ["z", "1", "?", "+", "/"]) await page.keyboard.press(key);
  await still(page);
  assert.deepEqual([await shading(), await camera(page), await page.getByRole("dialog").isVisible()], ["smooth", view, false]);
  assert.equal(await focus(page), "BODY");
  await page.keyboard.press("ArrowLeft");
  await still(page);
  assert.notEqual(await camera(page), view, "the arrow keys work");
  await page.getByRole("button", { name: "Help" }).click();
  await letters.check();
  await page.keyboard.press("Escape");
  await page.keyboard.press("z");
  assert.equal(await shading(), "flat");
});

browse("the focus does not get lost when what has it disappears", (host) => {
  for (const [name, file] of [["human", HUMAN], ["figure", FIGURE]] as const) {
    host.add(name, `${name}.svg`);
    host.built(name, build(file));
  }
}, async (page) => {
  await page.locator("[data-drawing=figure] img").waitFor();
  assert.equal(await focus(page), "BODY", "a page that opens does not take it");
  await page.locator("[data-drawing=figure]").focus();
  await page.keyboard.press("Enter");
  await shown(page);
  assert.match((await focus(page))!, /^Model of figure\.svg/);
  await page.getByRole("link", { name: "Drawings" }).focus();
  await page.keyboard.press("Enter");
  await page.locator("[data-drawing=figure]").waitFor();
  assert.equal(await focus(page), "figure");
  await page.keyboard.press("Enter");
  await shown(page);
  await page.locator("[data-part=Arm]").click();
  await page.locator(".facts .link").first().focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Body");
  assert.match(await page.evaluate(() => document.activeElement!.className), /link/, "another link in its place");
  await page.locator("canvas").focus();
  await page.keyboard.press("p");
  await page.getByRole("button", { name: "Leave posing" }).focus();
  await page.keyboard.press("Enter");
  assert.match((await focus(page))!, /^Model of/);
});

browse("in a narrow panel the keyboard alone does everything", (host) => {
  host.add("kick.svg");
  host.built("kick.svg", kick());
}, async (page, host) => {
  await shown(page);
  /** Presses Tab until an element of this name has the focus, which it must show. */
  const tabTo = async (name: RegExp): Promise<void> => {
    for (let n = 0; n < 40; n++) {
      await page.keyboard.press("Tab");
      const [at, ring] = await page.evaluate(() => {
        const one = document.activeElement!;
        return [one.getAttribute("aria-label") ?? one.getAttribute("data-part") ?? one.textContent ?? "", getComputedStyle(one).outlineStyle !== "none"] as const;
      });
      if (!name.test(at)) continue;
      assert.ok(ring, `${at} shows that it has the focus`);
      return;
    }
    assert.fail(`Tab does not reach ${name}`);
  };
  await tabTo(/^More tools/);
  await page.keyboard.press("Enter");
  await tabTo(/^Wireframe/);
  await page.keyboard.press(" ");
  assert.equal(await page.getAttribute("canvas", "data-shading"), "wire");
  await page.keyboard.press("Escape");
  assert.match((await focus(page))!, /^More tools/);

  await tabTo(/^Model of/);
  await tabTo(/^Parts/);
  await page.keyboard.press("Enter");
  assert.equal(await page.locator(".side").isVisible(), true);
  await tabTo(/^Search parts/);
  await page.keyboard.type("leg");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Leg");
  await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("Shift+Tab");
  assert.equal(await page.evaluate(() => document.activeElement?.textContent), "Leg", "its tab");
  await page.keyboard.press("Enter");
  await tabTo(/^Hide/);
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "Leg");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-hidden"), "");
  await page.keyboard.press("Escape");
  assert.equal(await page.locator(".side").isVisible(), false);

  await tabTo(/^(Play|Pause)/);
  await tabTo(/^Time/);
  await page.keyboard.press("Home");
  assert.match(await page.locator(".readout").innerText(), /frame 1 of/);
  await tabTo(/^Chart/);
  await page.keyboard.press("Enter");
  assert.equal(await page.locator(".chart").isVisible(), true);
  await tabTo(/^More about the clip/);
  await page.keyboard.press("Enter");
  await tabTo(/^Onion skin/);
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-onion-skin"), "1");
  assert.ok(host.heard.some(({ type, part }) => type === "pick" && part === "Leg"));
}, { viewport: { width: 520, height: 760 } });
