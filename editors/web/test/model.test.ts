import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { PNG } from "pngjs";
import type { Page } from "playwright-core";
import { camera, pass, picture, project, shown, still } from "./browser";
import { animate } from "./animate";
import { assertLike, browse, build, example, FIGURE, isLike, one } from "./setup";
import { SPIN } from "./spin";

const RED = [255, 0, 0] as const;
const GREEN = [0, 160, 0] as const;
const PAPER = [245, 243, 238] as const;

/** The position in the model of a point of the fixture's drawing; `front` is the height of its face. */
const at = (page: Page, x: number, y: number, front = 0): Promise<{ x: number; y: number }> => project(page, (x - 180) / 100, (200 - y) / 100, front);
const frames = (page: Page) => page.getAttribute("canvas", "data-frames").then(Number);
const front = async (page: Page) => {
  await page.keyboard.press("1");
  await still(page);
};

browse("fills have the drawing's colours, from all sides and in both projections", one(FIGURE), async (page) => {
  await shown(page);
  for (const key of ["1", "5", "0", "Shift+1"]) {
    await page.keyboard.press(key);
    await still(page);
    const seen = await picture(page);
    const side = key === "Shift+1" ? -1 : 1;
    assertLike(seen.at(await at(page, 140, 180, 0.2 * side)), RED, `the body after ${key}`);
    assertLike(seen.at(await at(page, 220, 120, 0.08 * side)), GREEN, `the arm after ${key}`);
    const head = seen.at(await at(page, 140, 80, 0.12 * side));
    assert.ok(Math.min(...head) > 205 && Math.max(...head) - Math.min(...head) < 12, `white is rgb(${head.join(" ")})`);
    assertLike(seen.at(await at(page, 240, 180, 0)), PAPER, "beside the model", 40);
  }
});

browse("nothing is drawn while nothing changes", one(FIGURE), async (page) => {
  await shown(page);
  const before = await frames(page);
  await pass(page, 60);
  assert.equal(await frames(page), before);
  await page.keyboard.press("ArrowLeft");
  await still(page);
  assert.ok((await frames(page)) > before);
});

browse("a new build replaces the old one; camera, selection, pose and shading stay", one(FIGURE), async (page, host) => {
  await shown(page, 1);
  await page.keyboard.press("z");
  for (const key of ["1", "ArrowLeft", "ArrowUp", "+"]) await page.keyboard.press(key);
  await page.locator("[data-part=Arm]").click();
  await page.locator("canvas").focus();
  for (const key of ["p", ".", ".", ".", "p"]) await page.keyboard.press(key);
  await still(page);
  const view = await camera(page);
  assertLike((await picture(page)).at(await at(page, 140, 180, 0.2)), RED, "the old body", 90);
  host.built("figure.svg", build(FIGURE, (text) => text.replace("#ff0000", "#0000ff").replace('height="100"', 'height="140"')));
  await shown(page, 2);
  assert.equal(await camera(page), view);
  assert.equal(await page.getAttribute("canvas", "data-shading"), "flat");
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Arm");
  assert.equal(await page.getAttribute("canvas", "data-posed"), "Arm");
  const body = (await picture(page)).at(await project(page, -0.4, 0.6, 0.2));
  assert.ok(body[2] > 150 && body[0] < 90, `the new body is rgb(${body.join(" ")})`);
});

browse("in a burst of builds the last one is shown and not all are fetched", one(FIGURE), async (page, host) => {
  await shown(page, 1);
  host.hold();
  const colours = ["#111111", "#222222", "#333333", "#444444", "#555555", "#0000ff"];
  for (const colour of colours) host.built("figure.svg", build(FIGURE, (text) => text.replace("#ff0000", colour)));
  await host.request("/builds/2.glb");
  // All messages have arrived when this one has.
  host.say({ type: "light", drawing: "figure.svg", part: "Arm" });
  await page.waitForSelector("canvas[data-lit=Arm]");
  host.release();
  await shown(page, 7);
  // Models are loaded one after the other: whatever else was to be fetched is fetched before the next.
  host.built("figure.svg", build(FIGURE));
  await shown(page, 8);
  assert.deepEqual(host.asked.filter((path) => path.endsWith(".glb")), ["/builds/1.glb", "/builds/2.glb", "/builds/7.glb", "/builds/8.glb"]);
});

browse("removed models leave nothing on the graphics card", one(FIGURE), async (page, host) => {
  await page.addInitScript(() => {
    const alive = { Buffer: 0, Texture: 0, VertexArray: 0 };
    Object.assign(globalThis, { alive });
    const context = WebGL2RenderingContext.prototype as unknown as Record<string, (...args: unknown[]) => unknown>;
    for (const kind of Object.keys(alive) as (keyof typeof alive)[]) {
      const [create, remove] = [context[`create${kind}`]!, context[`delete${kind}`]!];
      context[`create${kind}`] = function (...args) {
        alive[kind]++;
        return create.apply(this, args);
      };
      context[`delete${kind}`] = function (...args) {
        if (args[0]) alive[kind]--;
        return remove.apply(this, args);
      };
    }
  });
  await page.reload();
  await shown(page, 1);
  const alive = () => page.evaluate(() => ({ ...(globalThis as unknown as { alive: Record<string, number> }).alive }));
  const swap = async (from: number, to: number) => {
    for (let n = from; n <= to; n++) {
      host.built("figure.svg", build(n % 2 ? example("looks") : FIGURE));
      await shown(page, n);
    }
  };
  await swap(2, 3);
  const before = await alive();
  assert.ok(before["Buffer"]! > 20 && before["Texture"]! > 3, JSON.stringify(before));
  await swap(4, 9);
  assert.deepEqual(await alive(), before);
});

browse("embedded pictures are shown under the content security policy", one(example("looks")), async (page) => {
  await shown(page);
  await front(page);
  await picture(page, "looks");
  // The gull is a picture on a card; without it the card would have a single colour.
  const card = await project(page, 1.04, 1.456, 0.01);
  const seen = await picture(page);
  const colours = new Set<string>();
  for (let dx = -40; dx <= 40; dx += 4) for (let dy = -20; dy <= 20; dy += 4) colours.add(seen.at({ x: card.x + dx, y: card.y + dy }).join(" "));
  assert.ok(colours.size > 12, `${colours.size} colours`);
});

browse("the pointer highlights parts; a click picks one and notifies the host", one(FIGURE), async (page, host) => {
  await shown(page);
  await front(page);
  const arm = await at(page, 220, 120, 0.08);
  await page.mouse.move(arm.x, arm.y);
  await page.waitForSelector(".tree-item.hovered[data-part=Arm]");
  assert.equal(await page.getAttribute("canvas", "data-hovered"), "Arm");
  await page.mouse.click(arm.x, arm.y);
  await page.waitForSelector("[data-part=Arm][aria-selected=true]");
  await page.waitForFunction(() => document.querySelector(".inspector code")?.textContent === "Arm@Body$Shape default -8 8 Bend 0");
  assert.deepEqual(host.heard.filter(({ type }) => type === "pick"), [{ type: "pick", drawing: "figure.svg", part: "Arm" }]);
  const facts = await page.locator(".inspector").innerText();
  for (const fact of [/nearest/, /Line\s+6, column/, /Parent\s+Body/, /#arm/, /Shape\s+default -8 8\s+its string/, /Color\s+0 0.627 0\s+built in/]) assert.match(facts, fact);
  // A drag is not a click.
  const body = await at(page, 140, 150, 0.2);
  await page.mouse.move(body.x, body.y);
  await page.mouse.down();
  await page.mouse.move(body.x + 60, body.y + 10, { steps: 4 });
  await page.mouse.up();
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Arm");
  await page.mouse.click(30 + (await page.locator("canvas").boundingBox())!.x, 200);
  assert.equal(await page.getAttribute("canvas", "data-selected"), "");
});

browse("a selected part is outlined, even behind another one", one(FIGURE), async (page) => {
  await shown(page);
  await page.locator("[data-part=Arm]").click();
  await page.mouse.move(5, 5);
  await page.keyboard.press("Shift+3");
  await still(page);
  // From the model's right the body hides the arm; only its outline is visible.
  const seen = await picture(page, "outline");
  const { x, y } = await at(page, 200, 120, 0);
  let blue = 0;
  for (let dx = -80; dx <= 80; dx++) {
    const [r, , b] = seen.at({ x: x + dx, y });
    if (b > 110 && r < 150) blue++;
  }
  assert.ok(blue >= 4 && blue <= 16, `${blue} pixels of the outline in a line across it`);
  assertLike(seen.at({ x, y }), RED, "within the outline", 110);
});

browse("the editor's cursor highlights a part", one(example("clockwork-dragon")), async (page, host) => {
  await shown(page);
  const last = await page.evaluate(() => {
    const items = [...document.querySelectorAll<HTMLElement>(".tree-item.main")];
    return items.at(-1)!.dataset["part"]!;
  });
  host.say({ type: "light", drawing: "clockwork-dragon.svg", part: last });
  await page.waitForSelector(`.tree-item.lit[data-part="${last}"]`);
  assert.equal((await page.getAttribute("canvas", "data-lit"))?.split(" ")[0], last);
  assert.ok(await page.locator(".tree-item.lit").evaluate((item) => {
    const list = item.closest(".tree")!.getBoundingClientRect();
    const own = item.getBoundingClientRect();
    return own.top >= list.top - 1 && own.bottom <= list.bottom + 1;
  }), "the part is scrolled into sight");
  await picture(page, "dragon");
  host.say({ type: "light", drawing: "clockwork-dragon.svg", part: null });
  await page.waitForFunction(() => document.querySelector(".tree-item.lit") === null);
});

browse("a limb is turned about its joint with a readout of the angle, and Escape resets it", one(FIGURE), async (page) => {
  await shown(page);
  await front(page);
  await page.keyboard.press("5");
  await page.keyboard.press("p");
  await still(page);
  const view = await camera(page);
  const hand = await at(page, 240, 120, 0.08);
  const above = await at(page, 170, 50, 0.08);
  assertLike((await picture(page)).at(hand), GREEN, "the hand");
  await page.mouse.move(hand.x, hand.y);
  await page.mouse.down();
  for (const angle of [15, 30, 45, 60, 75, 90]) {
    const turn = (angle * Math.PI) / 180;
    const to = await project(page, -0.1 + 0.7 * Math.cos(turn), 0.8 + 0.7 * Math.sin(turn), 0.08);
    await page.mouse.move(to.x, to.y);
  }
  await still(page);
  assert.match((await page.locator(".pose-readout").innerText()).trim(), /^Arm \+(89|90|91)°$/);
  await page.mouse.up();
  await page.mouse.move(5, 5);
  await still(page);
  assert.equal(await camera(page), view, "the view does not turn with the limb");
  const seen = await picture(page, "posed");
  assertLike(seen.at({ x: above.x, y: above.y + 4 }), GREEN, "the hand, now above the shoulder");
  assert.ok(!isLike(seen.at(hand), GREEN), "the hand has left its place");
  assertLike(seen.at(await at(page, 140, 180, 0.2)), RED, "the body stays");
  await page.keyboard.press("Escape");
  await still(page);
  assertLike((await picture(page)).at(hand), GREEN, "the hand, put back");
  assert.equal(await page.getAttribute("canvas", "data-posed"), "");
});

browse("child parts follow a limb, and Shift turns it about its own axis", one(FIGURE), async (page) => {
  await shown(page);
  await front(page);
  await page.locator("[data-part=Body]").click();
  await page.locator("canvas").focus();
  await page.keyboard.press("p");
  const hand = await at(page, 240, 120, 0.08);
  for (let n = 0; n < 6; n++) await page.keyboard.press(",");
  await still(page);
  assert.ok(!isLike((await picture(page)).at(hand), GREEN), "the arm went with the body");
  await page.keyboard.press("Escape");
  // The arm is 20 high and 16 thick: turned by 90° about its own axis, it covers less.
  const edge = await at(page, 220, 111, 0.08);
  await still(page);
  assertLike((await picture(page)).at(edge), GREEN, "the arm's upper edge");
  await page.locator("[data-part=Arm]").click();
  await page.locator("canvas").focus();
  for (let n = 0; n < 18; n++) await page.keyboard.press("Shift+Period");
  await page.locator("canvas").focus();
  await page.keyboard.press("Tab");
  await page.mouse.move(5, 5);
  await still(page);
  assert.match((await page.locator(".pose-readout").innerText()).trim(), /^Arm \+90°$/);
  await page.evaluate(() => (document.activeElement as HTMLElement).blur());
  const twisted = (await picture(page, "twisted")).at(edge);
  assert.ok(!isLike(twisted, GREEN, 40), `the upper edge went away: rgb(${twisted.join(" ")})`);
});

browse("clips play, can be scrubbed, and continue in the next model", (host) => {
  const { model, ...rest } = build(FIGURE);
  host.add("figure.svg");
  host.built("figure.svg", { ...rest, model: animate(model!, "Arm", "wave", SPIN) });
}, async (page, host) => {
  await shown(page);
  await front(page);
  const clips = page.locator(".clips");
  assert.equal(await clips.getAttribute("data-playing"), "false", "who wants little movement starts it by hand");
  assert.equal(await page.locator(".ticks").getAttribute("data-keys"), "4");
  assert.equal(await page.locator(".clips .readout").innerText(), "drawing 1 of 4 · 0.00 s");
  const hand = await at(page, 240, 120, 0.08);
  assertLike((await picture(page)).at(hand), GREEN, "the hand in the first drawing");
  await page.keyboard.press("k");
  await still(page);
  assert.equal(await page.locator(".clips .readout").innerText(), "drawing 2 of 4 · 0.25 s");
  assert.ok(!isLike((await picture(page, "clip")).at(hand), GREEN), "the hand is elsewhere in the second drawing");
  const drawn = await frames(page);
  await page.locator(".clips select").last().selectOption("0.5");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => document.querySelector(".clips .readout")?.textContent?.startsWith("drawing 4 of 4"));
  await page.keyboard.press("Space");
  await still(page);
  const pictures = (await frames(page)) - drawn;
  assert.ok(pictures >= 2 && pictures <= 6, `held drawings are drawn once each, not in ${pictures} pictures`);
  await page.locator(".slider").fill("0.6");
  assert.equal(await page.locator(".clips .readout").innerText(), "drawing 3 of 4 · 0.60 s");
  const { model, ...rest } = build(FIGURE, (text) => text.replace("#ff0000", "#0000ff"));
  host.built("figure.svg", { ...rest, model: animate(model!, "Arm", "wave", SPIN) });
  await shown(page, 2);
  assert.equal(await page.locator(".clips .readout").innerText(), "drawing 3 of 4 · 0.60 s");
  host.built("figure.svg", build(FIGURE));
  await shown(page, 3);
  await clips.waitFor({ state: "hidden" });
});

browse("screenshots and the model are saved under the drawing's name", one(FIGURE), async (page) => {
  await shown(page);
  const take = async (press: () => Promise<void>) => {
    const [download] = await Promise.all([page.waitForEvent("download"), press()]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  };
  const model = await take(() => page.keyboard.press("d"));
  assert.equal(model.name, "figure.glb");
  assert.deepEqual(model.bytes, build(FIGURE).model);
  const opaque = await take(() => page.keyboard.press("s"));
  assert.equal(opaque.name, "figure.png");
  const clear = await take(async () => {
    await page.getByRole("button", { name: "Export" }).click();
    await page.getByRole("menuitem", { name: "Transparent picture" }).click();
  });
  const pixels = (bytes: Buffer) => {
    const { data } = PNG.sync.read(bytes);
    let clear = 0;
    let red = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] === 0) clear++;
      else if (data[i]! > 180 && data[i + 1]! < 60 && data[i + 2]! < 60) red++;
    }
    return { corner: [...data.subarray(0, 4)], clear: clear / (data.length / 4), red: red / (data.length / 4) };
  };
  const [first, second] = [pixels(opaque.bytes), pixels(clear.bytes)];
  assert.deepEqual(first.corner, [...PAPER, 255]);
  assert.equal(first.clear, 0);
  assert.deepEqual(second.corner, [0, 0, 0, 0]);
  assert.ok(second.clear > 0.5 && second.clear < 0.95);
  for (const { red } of [first, second]) assert.ok(red > 0.02, `${red} of the picture is red`);
});

const exported = { ".obj": Buffer.from("v 0 0 0\n"), ".svg": Buffer.from("<svg/>") };

browse("OBJ and the puppet sheet are in the Export menu where the host makes them", one(FIGURE), async (page, host) => {
  await shown(page);
  const open = () => page.getByRole("button", { name: "Export" }).click();
  const entries = () => page.getByRole("menuitem").locator("visible=true").allInnerTexts();
  const take = async (name: string) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("menuitem", { name }).click()]);
    return [download.suggestedFilename(), readFileSync(await download.path(), "utf8")];
  };
  await open();
  const without = await entries();
  assert.ok(without.length >= 4 && !without.some((text) => /OBJ|Puppet/.test(text)), without.join(", "));
  // Keys reach what is shown, and nothing else.
  await page.keyboard.press("End");
  assert.match(await page.locator(":focus").innerText(), /Moving picture/);
  await page.keyboard.press("Escape");
  host.built("figure.svg", { ...build(FIGURE), exports: exported });
  await shown(page, 2);
  await open();
  assert.equal((await entries()).length, without.length + 2);
  assert.deepEqual(await take("3D model (OBJ)"), ["figure.obj", "v 0 0 0\n"]);
  await open();
  assert.deepEqual(await take("Puppet sheet (SVG)"), ["figure-puppet.svg", "<svg/>"]);
});
