// Editing with the real program: what a person does on the page, and the bytes of the file.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import type { AxeResults } from "axe-core";
import { doubleClick, isFirefox, manual, middle, overlaps, picture, project, shown, still, type } from "./browser";
import { BY_OTHERS, byModule, edit } from "./edited";
import { example, FIGURE, source } from "./setup";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const BEFORE = source(FIGURE);

/** What Firefox's driver types without a key for it is no change by a person. */
const HAND = isFirefox ? "Paw" : "腕";

edit("by mouse: a thickness, a name, a parent, a colour and a kind reach the file, and undo brings the bytes back", async (edited) => {
  const { page } = edited;
  // Off at first: a double click names nothing.
  assert.equal(await page.locator(".part-form").isVisible(), false);
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  const texts = [BEFORE];
  const now = async (change: (text: string) => string, what: string): Promise<void> => {
    texts.push(change(texts.at(-1)!));
    assert.notEqual(texts.at(-1), texts.at(-2), what);
    await edited.has(texts.at(-1)!, what);
  };

  // The slider is dragged to its end.
  const slider = edited.label("Shape: z1");
  await slider.scrollIntoViewIfNeeded();
  const { x, y, width, height } = (await slider.boundingBox())!;
  const most = await slider.getAttribute("max");
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width + 20, y + height / 2, { steps: 8 });
  assert.equal(edited.text(), BEFORE, "nothing is written before the slider is let go");
  await page.mouse.up();
  await now((text) => text.replace("default -8 8", `default -8 ${most}`), "thickness");

  // A double click in the list goes to the name.
  await doubleClick(page, await middle(page.locator("[data-part=Arm]")));
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Name");
  await page.keyboard.type("Left arm");
  await page.locator(".inspector-title").click();
  await now((text) => text.replace("Arm@Body", '"Left arm"@Body'), "name");
  await page.locator('[data-part="Left arm"][aria-selected=true]').waitFor();

  // A parent is clicked in the list.
  await page.getByRole("button", { name: "Click what it hangs on" }).click();
  await page.getByText("Click what Left arm hangs on").waitFor();
  await page.locator("[data-part=Head]").click();
  await now((text) => text.replace('"Left arm"@Body', '"Left arm"@Head'), "parent");

  await edited.label("Color: swatch").fill("#123456");
  await now((text) => text.replace("Bend 0", "Bend 0 Color #123456"), "colour");

  const kinds = page.getByRole("radiogroup", { name: "Shape: which" });
  const pictures = await kinds.getByRole("radio").evaluateAll((all) => all.map((one) => [one.textContent, one.querySelectorAll("svg path").length > 0] as const));
  assert.ok(pictures.length >= 12);
  assert.deepEqual(pictures.filter(([, has]) => !has), [], "each kind has a picture");
  assert.equal(await kinds.getByRole("radio", { checked: true }).textContent(), "default");
  await kinds.getByRole("radio", { name: "roundv" }).hover();
  // The form may be made anew under the mouse, for the colour.
  await page.locator(".kind-about").filter({ hasText: /^rounded about the part's axis/ }).waitFor();
  await kinds.getByRole("radio", { name: "roundv" }).click();
  await now((text) => text.replace(`default -8 ${most}`, "roundv"), "kind");

  const undo = page.getByRole("button", { name: /^Undo/ });
  for (const text of texts.slice(0, -1).reverse()) {
    await undo.click();
    await edited.has(text, "undone");
  }
  await page.locator('button[aria-label="Undo"]:disabled').waitFor();
  const redo = page.getByRole("button", { name: /^Redo/ });
  for (const text of texts.slice(1)) {
    await redo.click();
    await edited.has(text, "made again");
  }
});

edit("by keyboard: the same", async (edited) => {
  const { page } = edited;
  await page.locator("canvas").focus();
  await page.keyboard.press("w");
  await page.keyboard.press("t");
  await page.keyboard.press("a");
  await page.waitForSelector("[data-part=Arm][aria-selected=true], [data-part=Arm][tabindex='0']");
  await page.keyboard.press("Enter");
  await page.locator(".part-form").waitFor();
  // F2 goes to the name, and Enter sends it.
  await page.keyboard.press("F2");
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Name");
  await page.keyboard.type(HAND);
  await page.keyboard.press("Enter");
  const named = BEFORE.replace("Arm@", `${HAND}@`);
  await edited.has(named, "name");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Hangs on");
  await page.keyboard.type("Head");
  const hung = named.replace("@Body", "@Head");
  await edited.has(hung, "parent");
  await edited.label("Color: as text").focus();
  // What is no colour is refused, and can be corrected at once.
  await page.keyboard.press("Control+a");
  await page.keyboard.type("tomatoe");
  await page.keyboard.press("Enter");
  await page.locator(".refusal").waitFor();
  await page.waitForFunction(() => document.querySelector<HTMLInputElement>('[aria-label="Color: as text"]')?.value === "#00a000");
  await page.keyboard.press("Control+a");
  await page.keyboard.type("tomato");
  await page.keyboard.press("Enter");
  const red = hung.replace("Bend 0", "Bend 0 Color tomato");
  await edited.has(red, "colour");
  // Keys that are pressed after each other are one change.
  const before = edited.label("Shape: z1");
  await before.focus();
  const step = Number(await before.getAttribute("step"));
  // They are sent together: on a busy machine one that is waited for may come too late.
  await Promise.all([1, 2, 3, 4].map(() => page.keyboard.press("ArrowRight")));
  const thick = red.replace("-8 8", `-8 ${Number((8 + 4 * step).toFixed(3))}`);
  await edited.has(thick, "thickness");
  // Tab goes to the kind that is chosen, a letter to the next one that begins with it.
  await page.locator(".kind[tabindex='0']").focus();
  await page.keyboard.press("End");
  assert.equal(await page.evaluate(() => document.activeElement?.textContent), "none");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.evaluate(() => document.activeElement?.textContent), "default");
  await page.keyboard.press("i");
  assert.equal(edited.text(), thick, "going through the kinds chooses none");
  await page.keyboard.press("Enter");
  await edited.has(thick.replace(/default -8 [\d.]+/, "inflate"), "kind");
  for (const text of [thick, red, hung, named, BEFORE]) {
    await page.keyboard.press("Control+z");
    await edited.has(text, "undone");
  }
  await page.keyboard.press("Control+Shift+z");
  await edited.has(named, "made again");
});

edit("while a slider or a swatch is dragged the model follows, and the drawing does not", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  await page.locator("canvas").focus();
  await page.keyboard.press("3");
  await page.keyboard.press("5");
  await still(page);
  // From the side: before the plane of the drawing, where the arm is not yet.
  const place = await project(page, (220 - 180) / 100, (200 - 120) / 100, 0.5);
  const at = async (name?: string): Promise<string> => {
    await still(page);
    const [red, green, blue] = (await picture(page, name)).at(place);
    return green > red + 60 && green > blue + 60 ? "arm" : "nothing";
  };
  const tried = (is: boolean) => page.waitForFunction((is) => (document.querySelector("canvas")!.dataset["tried"] !== "") === is, is);
  assert.equal(await at(), "nothing");
  const slider = edited.label("Shape: z1");
  await slider.scrollIntoViewIfNeeded();
  const drag = async (): Promise<void> => {
    const { x, y, width, height } = (await slider.boundingBox())!;
    await page.mouse.move(x + width * 0.54, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width * 0.9, y + height / 2, { steps: 5 });
    await tried(true);
    assert.equal(await at("edit-dragged"), "arm");
    assert.equal(edited.text(), BEFORE);
  };
  // Escape takes it back, also if the pointer moves on and lets go then.
  await drag();
  await page.keyboard.press("Escape");
  await tried(false);
  await page.mouse.move(600, 500, { steps: 3 });
  await page.mouse.up();
  assert.equal(await at(), "nothing");
  assert.equal(await edited.label("Shape: z1, as a number").inputValue(), "8");
  assert.equal(edited.text(), BEFORE);

  await drag();
  let saved = BEFORE;
  if (!byModule) {
    // Another program saves while it is dragged: its save is kept and shown, and the change is made in what it saved.
    saved = BEFORE.replace("#ff0000", "#0000ff");
    await edited.save(saved);
    await shown(page, 2);
    await tried(true);
    assert.equal(await at(), "arm");
  }
  await page.mouse.up();
  await tried(false);
  await edited.until(() => edited.text() !== saved, "thicker");
  await page.locator(".part-form[aria-busy=false]").waitFor();
  assert.equal(await at(), "arm");
  const thick = edited.text();
  assert.match(thick, /default -8 [3-9]\d(\.\d+)? Bend 0/);
  assert.equal(thick.replace(/default -8 [\d.]+ Bend/, "default -8 8 Bend"), saved);

  // A colour is dragged in the browser's picker, and let go.
  const color = (type: string) => edited.label("Color: swatch").evaluate((one, type) => {
    (one as HTMLInputElement).value = "#00e0ff";
    one.dispatchEvent(new Event(type, { bubbles: true }));
  }, type);
  await color("input");
  await tried(true);
  await still(page);
  const [red, , blue] = (await picture(page)).at(place);
  assert.ok(blue > red + 60);
  assert.equal(edited.text(), thick);
  await color("change");
  await edited.has(thick.replace("Bend 0", "Bend 0 Color #00e0ff"), "colour");
  await tried(false);
});

edit("a part is dragged onto another one in the list, by mouse", async (edited) => {
  const { page } = edited;
  const row = (part: string) => middle(page.locator(`[data-part="${part}"]`));
  const drag = async (part: string, to: { x: number; y: number }): Promise<void> => {
    const from = await row(part);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 6 });
  };
  const label = page.locator(".hanging");
  // Nothing is dragged before parts are edited.
  await drag("Arm", await row("Head"));
  assert.equal(await label.isVisible(), false);
  await page.mouse.up();
  await page.getByRole("button", { name: "Edit" }).click();
  await drag("Arm", await row("Head"));
  assert.equal(await label.innerText(), "Hang Arm on Head");
  await picture(page, "edit-hanging");
  await page.keyboard.press("Escape");
  assert.equal(await label.isVisible(), false);
  await page.mouse.up();
  await drag("Arm", await row("Head"));
  await page.mouse.up();
  const onHead = BEFORE.replace("Arm@Body", "Arm@Head");
  await edited.has(onHead, "onto the head");
  await page.locator("[data-part=Arm][aria-level='3'][aria-selected=true]").waitFor();
  // What hangs on a part cannot carry it: the same refusal as in the form.
  await drag("Head", await row("Arm"));
  await page.mouse.up();
  const refusal = page.locator(".refusal");
  await refusal.waitFor();
  assert.match(await refusal.innerText(), /`?Arm`? hangs on `?Head`?/);
  assert.equal(edited.text(), onHead);
  await page.locator(".refusal").getByRole("button", { name: "Close" }).click();
  // On itself, or where it hangs already, nothing changes.
  await drag("Arm", await row("Head"));
  assert.equal(await label.innerText(), "Arm");
  await page.mouse.up();
  // Where the list is empty, a part hangs on nothing.
  const { x, y, width, height } = (await page.getByRole("tree").boundingBox())!;
  await drag("Arm", { x: x + width / 2, y: y + height - 12 });
  assert.equal(await label.innerText(), "Hang Arm on nothing");
  await page.mouse.up();
  await edited.has(BEFORE.replace("Arm@Body", "Arm@Root"), "on nothing");
  await page.locator("[data-part=Arm][aria-level='1']").waitFor();
});

edit("a part is dragged onto another one in the list, by touch", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator(".drawer-opener").click();
  const [arm, head] = await Promise.all(["Arm", "Head"].map(async (part) => {
    const { x, y, width, height } = (await page.locator(`[data-part="${part}"]`).boundingBox())!;
    return { x: x + width / 3, y: y + height / 2 };
  }));
  const session = await page.context().newCDPSession(page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", at?: { x: number; y: number }) => session.send("Input.dispatchTouchEvent", { type, touchPoints: at ? [at] : [] });
  // A finger that rests on a row drags it.
  await touch("touchStart", arm);
  await page.locator(".hanging").waitFor();
  await touch("touchMove", { x: arm!.x, y: (arm!.y + head!.y) / 2 });
  await touch("touchMove", head);
  assert.equal(await page.locator(".hanging").innerText(), "Hang Arm on Head");
  await picture(page, "edit-hanging-phone");
  await touch("touchEnd");
  await edited.has(BEFORE.replace("Arm@Body", "Arm@Head"), "by touch");
}, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

edit("a refusal is a sentence with its choices, and a choice is made", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Body");
  await page.getByRole("button", { name: "Leave this part out" }).click();
  const refusal = page.locator(".refusal");
  await refusal.waitFor();
  assert.match(await refusal.innerText(), /hang/i);
  assert.equal(edited.text(), BEFORE);
  await page.locator(".refusal").getByRole("button", { name: "Close" }).click();
  await type(edited.label("Name"), "Arm");
  await page.keyboard.press("Enter");
  await refusal.waitFor();
  assert.match(await refusal.innerText(), /There is a part named Arm already/);
  // The field shows what is so.
  await page.waitForFunction(() => document.querySelector<HTMLInputElement>("[data-key=name]")?.value === "Body");
  await page.keyboard.press("Escape");
});

edit("reset takes an attribute away", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  await page.getByRole("button", { name: "Reset Bend" }).click();
  await edited.has(BEFORE.replace(" Bend 0", ""), "reset");
  await page.getByRole("button", { name: "Reset Bend" }).waitFor({ state: "detached" });
});

edit("a save from elsewhere meanwhile is kept, and a change of the same is asked about", async (edited) => {
  const { page, file } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await edited.select("Arm");
  const number = edited.label("Shape: z1, as a number");
  await number.fill("12");
  // Another program saves before the number is sent.
  const saved = BEFORE.replace("#ff0000", "#0000ff");
  writeFileSync(file, saved);
  await number.press("Enter");
  const both = saved.replace("-8 8", "-8 12");
  await edited.has(both, "both");
  await page.waitForFunction(() => document.querySelector<HTMLInputElement>('[aria-label="Shape: z1, as a number"]')?.value === "12");
  // Requests are held back until the other program has saved the very same attribute.
  await page.route("**/changes", async (route) => {
    writeFileSync(file, both.replace("-8 12", "-8 30"));
    await route.continue();
  }, { times: 1 });
  await number.fill("14");
  await number.press("Enter");
  const choice = page.getByRole("button", { name: "Change it all the same" });
  await choice.waitFor();
  assert.equal(edited.text(), both.replace("-8 12", "-8 30"));
  await page.waitForFunction(() => document.querySelector<HTMLInputElement>('[aria-label="Shape: z1, as a number"]')?.value === "30");
  await choice.click();
  await edited.has(both.replace("-8 12", "-8 14"), "all the same");
}, { program: BY_OTHERS });

edit("read-only has no button", async ({ page }) => {
  assert.equal(await page.getByRole("button", { name: "Edit" }).count(), 0);
  await page.locator("canvas").focus();
  await page.keyboard.press("w");
  await page.locator("[data-part=Arm]").click();
  assert.equal(await page.locator(".part-form").isVisible(), false);
}, { arguments: ["--read-only"] });

edit("a part without a name is named", async (edited) => {
  const { page } = edited;
  await edited.save(BEFORE.replace("</svg>", '  <rect x="20" y="240" width="60" height="40" fill="#00ffff"/>\n</svg>'));
  await page.getByRole("button", { name: "Edit" }).click();
  const automatic = page.locator(".tree-item.automatic.main");
  await automatic.click();
  await page.keyboard.press("F2");
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Name");
  assert.equal(await edited.label("Name").inputValue(), "");
  await page.keyboard.type("Plate");
  await page.keyboard.press("Enter");
  await page.locator("[data-part=Plate][aria-selected=true]").waitFor();
  await edited.matches(/Plate/);
});

edit("a double click in the model goes to the name, while it is edited", async (edited) => {
  const { page } = edited;
  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator("canvas").focus();
  await page.keyboard.press("1");
  await still(page);
  await doubleClick(page, await project(page, (140 - 180) / 100, (200 - 180) / 100, 0.2));
  await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Name");
  assert.equal(await edited.label("Name").inputValue(), "Body");
});

edit("a drawing without a string becomes a figure, and nobody writes one", async (edited) => {
  const { page } = edited;
  const shot = async (name: string): Promise<void> => {
    await page.mouse.move(5, 5);
    await still(page);
    await manual(page, join("without-strings", `${name}.png`));
  };
  await page.getByRole("button", { name: "Edit" }).click();
  const automatic = page.locator(".tree-item.automatic.main").first();
  for (const name of ["Body", "Left arm", "Right arm", "Head"]) {
    const unnamed = await automatic.getAttribute("data-part");
    await edited.select(unnamed!);
    await page.keyboard.press("F2");
    await page.waitForFunction(() => document.activeElement?.getAttribute("aria-label") === "Name");
    await page.keyboard.type(name);
    if (name === "Left arm") await shot("1-name");
    await page.keyboard.press("Enter");
    await page.locator(`[data-part="${name}"][aria-selected=true]`).waitFor();
    await edited.formOf(name);
  }
  for (const name of ["Left arm", "Right arm", "Head"]) {
    await edited.select(name);
    const hangs = edited.label("Hangs on");
    if ((await hangs.inputValue()) !== "@Body") {
      await hangs.selectOption("@Body");
    }
    await page.locator(`[data-part="${name}"][aria-level="2"]`).waitFor();
  }
  await edited.select("Body");
  await edited.label("Color: swatch").fill("#2f7fc1");
  await page.waitForFunction(() => document.querySelector<HTMLInputElement>('[aria-label="Color: as text"]')?.value === "#2f7fc1");
  await shot("2-colour");
  const text = edited.text();
  await page.getByRole("radio", { name: "roundv" }).click();
  const choice = page.getByRole("button", { name: /^Give Body this Shape/ });
  await choice.waitFor();
  assert.equal(edited.text(), text, "it is asked before");
  await shot("3-question");
  await choice.click();
  await page.getByRole("button", { name: "Reset Shape" }).waitFor();
  await edited.matches(/Shape roundv/);
  await page.keyboard.press("Control+z");
  await edited.has(text, "undone");
  assert.equal(await page.locator(".finding .badge.error").count(), 0);
}, { drawing: example(join("tutorial", "2-arms")), viewport: { width: 1060, height: 720 }, smoothEdges: true });

for (const colorScheme of ["light", "dark"] as const) {
  for (const [name, options] of [["desktop", { viewport: { width: 1400, height: 900 } }], ["phone", { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }]] as const) {
    edit(`axe finds nothing while a part is edited, ${name}, ${colorScheme}`, async (edited) => {
      const { page } = edited;
      const is = async (state: string): Promise<void> => {
        if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(AXE);
        const { violations } = await page.evaluate(() => (globalThis as unknown as { axe: { run(): Promise<AxeResults> } }).axe.run());
        assert.deepEqual(violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")} ${failureSummary ?? ""}`)), [], state);
        assert.deepEqual(await overlaps(page), [], state);
      };
      await page.getByRole("button", { name: "Edit" }).click();
      await is("nothing selected");
      if (name === "phone") {
        await page.locator(".drawer-opener").click();
        await page.locator("[data-part=Arm]").click();
        await page.locator(".drawer-tab").nth(1).click();
      } else await edited.select("Arm");
      await page.locator(".part-form").waitFor();
      await is("form");
      await picture(page, `edit-${name}-${colorScheme}`);
      await page.evaluate(() => document.querySelectorAll("details.field").forEach((one) => ((one as HTMLDetailsElement).open = true)));
      await is("all fields");
      await type(edited.label("Name"), "Body");
      await edited.label("Name").press("Enter");
      await page.locator(".refusal").waitFor();
      await is("refused");
      await picture(page, `edit-refused-${name}-${colorScheme}`);
    }, { ...options, colorScheme });
  }
}

const BARE = join("..", "..", "tests", "cases", "art-fluent-person-standing", "drawing.svg");

edit("a drawing without names is named in one step and moves by another, and undo takes all names back", async (edited) => {
  const { page } = edited;
  const before = source(BARE);
  // Before anybody has heard of editing.
  await page.getByText("Nothing here has a name yet.").waitFor();
  assert.equal(await page.getByRole("button", { name: "Edit" }).getAttribute("aria-pressed"), "false");
  await page.getByRole("button", { name: "Name the parts for me" }).click();
  await page.locator("[data-part=Head]").waitFor();
  await page.getByText("Nothing here has a name").waitFor({ state: "hidden" });
  await picture(page, "edit-named");
  await edited.matches(/="Body"/);
  await page.getByRole("button", { name: "Let it move" }).click();
  await page.locator(".clips").waitFor();
  await page.getByRole("button", { name: "Let it move" }).waitFor({ state: "hidden" });
  await edited.matches(/Motion/);
  await picture(page, "edit-moves");
  await page.getByRole("button", { name: /^Undo/ }).click();
  await page.locator(".clips").waitFor({ state: "hidden" });
  await page.getByRole("button", { name: "Let it move" }).waitFor();
  await page.getByRole("button", { name: /^Undo/ }).click();
  await edited.has(before, "undo");
  await page.getByText("Nothing here has a name.").waitFor();
}, { drawing: BARE });

edit("the offer to name the parts is closed for a drawing, and gives way to posing", async (edited) => {
  const { page } = edited;
  const offer = page.getByRole("button", { name: "Name the parts for me" });
  await offer.waitFor();
  await page.getByRole("button", { name: "Pose", exact: true }).click();
  await offer.waitFor({ state: "hidden" });
  await page.getByRole("button", { name: "Leave posing" }).click();
  await page.getByRole("button", { name: "Name them myself" }).click();
  await page.getByText("Click a part and name it, or let okoshi do it.").waitFor();
  assert.equal(await page.getByRole("button", { name: "Edit", exact: true }).getAttribute("aria-pressed"), "true");
  await page.getByRole("button", { name: "Close the offer" }).click();
  await offer.waitFor({ state: "hidden" });
  await page.getByRole("button", { name: "Stop editing" }).click();
  await page.locator(".editbar").waitFor({ state: "hidden" });
}, { drawing: BARE });

edit("the offer to name the parts fits on a phone", async (edited) => {
  const { page } = edited;
  const offer = page.getByRole("button", { name: "Name the parts for me" });
  await offer.waitFor();
  assert.deepEqual(await overlaps(page), []);
  const box = (await offer.boundingBox())!;
  assert.ok(box.x >= 0 && box.x + box.width <= 390, JSON.stringify(box));
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is no wider than the phone");
  await picture(page, "edit-nameless-phone");
  await offer.click();
  await offer.waitFor({ state: "hidden" });
  await page.getByRole("button", { name: "Let it move" }).waitFor();
  assert.deepEqual(await overlaps(page), []);
  await picture(page, "edit-named-phone");
  await edited.matches(/="Head"/);
}, { drawing: BARE, viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

edit(
  "of a drawing that is open in Inkscape, a copy is changed, and the bar says how the changes come into the drawing",
  async (edited) => {
    const { page } = edited;
    await page.getByRole("button", { name: "Edit" }).click();
    await edited.select("Arm");
    await page.locator(".edit-words").filter({ hasText: "When you are done, call Take In Changes in Inkscape" }).waitFor();
    await edited.label("Name").fill("Wing");
    await edited.label("Name").press("Enter");
    await page.locator(".edit-words").filter({ hasText: "Changed in the copy" }).waitFor();
    assert.equal(edited.text(), BEFORE.replace("Arm@Body", "Wing@Body"));
  },
  { arguments: ["--unsaved", "figure.svg"] },
);
