import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { overlaps, picture, project, shown, still } from "./browser";
import { aside, FRAMES, kick, raised, SECONDS } from "./kick";
import { browse, build, example, one } from "./setup";
import type { MockHost } from "./mock";
import { SIZES } from "./sizes";

const HUMAN = example("human");
const kicking = (host: MockHost): void => {
  host.add("kick.svg");
  host.built("kick.svg", kick());
};
/** How much of the window's height an element has. */
async function share(page: Page, selector: string): Promise<number> {
  return ((await page.locator(selector).boundingBox())?.height ?? 0) / page.viewportSize()!.height;
}

for (const { name, ...size } of SIZES) {
  const small = name !== "desktop";
  browse(`${name}: the model has most of the window`, one(HUMAN), async (page) => {
    await shown(page);
    assert.ok((await share(page, ".viewport")) >= 0.6, `the model has ${await share(page, ".viewport")}`);
    assert.deepEqual(await overlaps(page), []);
    await picture(page, `layout-${name}`);
  }, size);

  browse(`${name}: a clip leaves the model most of the window, and a chart half of it`, kicking, async (page) => {
    await shown(page);
    assert.ok((await share(page, ".viewport")) >= 0.6, `the model has ${await share(page, ".viewport")}`);
    assert.deepEqual(await overlaps(page), []);
    await page.getByRole("button", { name: "Chart" }).click();
    await still(page);
    assert.ok((await share(page, ".viewport")) >= 0.5, `beside the chart the model has ${await share(page, ".viewport")}`);
    assert.ok((await share(page, ".chart")) <= 0.5 && (await share(page, ".chart .chart-picture")) > 0.07, "the chart can be read");
    assert.deepEqual(await overlaps(page), []);
    await picture(page, `layout-chart-${name}`);
  }, size);

  browse(`${name}: the whole way of a figure is in the picture`, kicking, async (page) => {
    await shown(page);
    await page.locator("canvas").focus();
    for (const view of ["0", "1"]) {
      await page.keyboard.press(view);
      await page.keyboard.press("Home");
      await still(page);
      const { x, y, width, height } = (await page.locator("canvas").boundingBox())!;
      for (let frame = 0; frame < FRAMES; frame++) {
        // The end of the leg, and the top of the head.
        const [foot, head] = [await project(page, aside(frame) + 0.1 + 0.8 * Math.sin(raised(frame)), 0.8 - 0.8 * Math.cos(raised(frame)), 0.08), await project(page, aside(frame), 1.74, 0)];
        for (const place of [foot, head]) assert.ok(place.x > x && place.x < x + width && place.y > y && place.y < y + height, `frame ${frame} of ${SECONDS} s is in the picture from ${view}`);
      }
    }
  }, size);

  browse(`${name}: what is wrong never covers more than a third of the model`, one(HUMAN), async (page, host) => {
    await shown(page);
    host.built("human.svg", build(HUMAN, (text) => text.replaceAll("@Ubody", "@Ubdoy")));
    await page.waitForSelector(".findings[data-open=true]");
    const [list, stage] = await Promise.all([".findings", ".viewport"].map(async (selector) => (await page.locator(selector).boundingBox())!));
    assert.ok(list!.height <= stage!.height / 3 + 1, `${list!.height} of ${stage!.height}`);
    assert.ok((await page.locator(".finding").first().boundingBox())!.y < list!.y + list!.height - 40, "the first can be read");
    assert.deepEqual(await overlaps(page), []);
    await picture(page, `layout-findings-${name}`);
  }, size);

  if (!small) continue;
  browse(`${name}: the parts are a drawer`, one(HUMAN), async (page) => {
    await shown(page);
    const before = await share(page, ".viewport");
    const opener = page.locator(".drawer-opener");
    assert.equal(await opener.innerText(), "Parts");
    assert.equal(await page.locator(".side").isVisible(), false);
    await opener.click();
    assert.equal(await page.locator(".tree").isVisible(), true);
    assert.equal(await page.locator(".inspector").isVisible(), false);
    assert.equal(await share(page, ".viewport"), before, "it lies over the model");
    await page.locator("[data-part=Head]").click();
    await page.getByRole("group", { name: "Shown" }).getByRole("button", { name: "Head" }).click();
    assert.match(await page.locator(".inspector").innerText(), /Bound/);
    assert.equal(await page.locator(".tree").isVisible(), false);
    await picture(page, `layout-drawer-${name}`);
    await page.keyboard.press("Escape");
    assert.equal(await page.locator(".side").isVisible(), false);
    assert.equal(await opener.innerText(), "Head");
    assert.equal(await opener.evaluate((button) => button === document.activeElement), true, "the focus returns");
    assert.equal(await page.getAttribute("canvas", "data-selected"), "Head", "Escape closes only the drawer");
    await page.keyboard.press("t");
    assert.equal(await page.evaluate(() => document.activeElement?.getAttribute("data-part")), "Head");
    await page.getByRole("button", { name: "Close the parts" }).click();
    await page.keyboard.press("/");
    assert.equal(await page.evaluate(() => document.activeElement?.getAttribute("aria-label")), "Search parts");
  }, size);

  browse(`${name}: tools that have no space are a press away`, kicking, async (page) => {
    await shown(page);
    const wire = page.getByRole("button", { name: "Wireframe" });
    assert.equal(await wire.isVisible(), false);
    const opener = page.getByRole("button", { name: "More tools" });
    await opener.click();
    await wire.click();
    assert.equal(await page.getAttribute("canvas", "data-shading"), "wire");
    assert.equal(await opener.getAttribute("aria-expanded"), "true");
    await picture(page, `layout-tools-${name}`);
    await page.keyboard.press("Escape");
    assert.equal(await wire.isVisible(), false);
    assert.equal(await opener.evaluate((button) => button === document.activeElement), true, "the focus returns");
    const beside = page.getByRole("button", { name: "side by side" });
    // A wide window has space for the clip's tools, however low it is.
    const folded = size.viewport.width < 700;
    assert.equal(await beside.isVisible(), !folded);
    if (folded) await page.getByRole("button", { name: "More about the clip" }).click();
    await beside.click();
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
    await page.mouse.click(20, 200);
    assert.equal(await beside.isVisible(), !folded, "a press elsewhere closes it");
  }, size);
}
