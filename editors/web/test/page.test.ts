import assert from "node:assert/strict";
import { camera, countRows, manual, overlaps, pass, picture, resize, shown, still } from "./browser";
import type { Made } from "./drawings";
import { browse, build, example, FIGURE, one } from "./setup";
import { make } from "./drawings";

const HUMAN = example("human");
const broken = (): Made => build(HUMAN, (text) => text.replaceAll("@Ubody", "@Ubdoy"));
const phone = { viewport: { width: 380, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 } as const;

browse("problems that stay open their list over the last good model, and close them when they are fixed", one(HUMAN), async (page, host) => {
  await shown(page, 1);
  const findings = page.locator(".findings");
  assert.equal(await findings.getAttribute("data-open"), "false");
  assert.equal(await page.locator(".findings-head").innerText(), "2 hints");
  // The page's clock stands until it is asserted that the list is closed.
  await page.clock.install({ time: 0 });
  await page.clock.pauseAt(1000);
  host.built("human.svg", broken());
  await page.getByText("3 problems").waitFor();
  assert.equal(await findings.getAttribute("data-open"), "false", "it may be a word that is being typed");
  await page.clock.resume();
  await page.waitForSelector(".findings[data-open=true]");
  assert.equal(await page.locator(".stale").innerText(), "The drawing has problems: this is the last good model.");
  assert.equal(await page.getAttribute("canvas", "data-revision"), "1", "the model stays");
  const first = page.locator(".finding").first();
  assert.match(await first.innerText(), /Problem: there is no part named Ubdoy\s+line 157\s*E204/);
  assert.equal(await first.locator("mark").innerText(), "Ubdoy");
  assert.match(await first.innerText(), /did you mean Ubody\?[\s\S]*the name after @ must be the name of a part/);
  assert.match(await page.locator(".findings-head").innerText(), /3 problems\s*2 hints/);
  await picture(page, "errors");
  await first.locator("button").click();
  assert.deepEqual(await host.messages("open", 1), [{ type: "open", drawing: "human.svg", line: 157, column: 24 }]);
  assert.equal(await page.locator("[aria-selected=true]").getAttribute("data-part"), "Head");
  host.built("human.svg", build(HUMAN));
  await page.waitForSelector(".findings[data-open=false]");
  await page.locator(".stale").waitFor({ state: "hidden" });
  // If the user opens it, it stays open.
  await page.locator(".findings-head").click();
  host.built("human.svg", broken());
  await page.locator(".stale").waitFor();
  host.built("human.svg", build(HUMAN));
  await page.locator(".stale").waitFor({ state: "hidden" });
  assert.equal(await findings.getAttribute("data-open"), "true");
});

browse("problems of a moment do not open the list, and a drawing that cannot be read keeps its parts", one(HUMAN), async (page, host) => {
  await shown(page, 1);
  await page.clock.install();
  const parts = await page.locator(".tree-item").count();
  const unreadable = { model: null, picture: null, build: { milliseconds: 1, stale: true, triangles: 0, parts: [], findings: [{ severity: "error", code: "E001", message: "`</g` is not closed", label: "", help: [], line: 3, column: 1, text: "</g", from: 0, to: 3 }] } };
  host.built("human.svg", unreadable);
  await page.getByText("1 problem").waitFor();
  assert.equal(await page.locator(".tree-item").count(), parts);
  host.built("human.svg", build(HUMAN));
  await page.getByText("1 problem").waitFor({ state: "hidden" });
  await page.clock.runFor(2000);
  assert.equal(await page.locator(".findings").getAttribute("data-open"), "false");
  host.built("human.svg", unreadable);
  await page.waitForSelector(".findings[data-open=true]");
  assert.equal(await page.locator(".finding code").first().innerText(), "</g");
  assert.doesNotMatch(await page.locator("#page").innerText(), /`/);
  // Who reads the list keeps the focus, in it or where it was opened.
  await page.locator(".finding-main").focus();
  host.built("human.svg", build(HUMAN));
  await page.waitForSelector(".findings[data-open=false]");
  assert.equal(await page.evaluate(() => document.activeElement?.className), "findings-head");
  const { build: facts, ...rest } = build(HUMAN);
  host.built("human.svg", { ...rest, build: { ...facts, findings: [] } });
  await page.locator(".findings").waitFor({ state: "hidden" });
  assert.equal(await page.evaluate(() => document.activeElement?.tagName), "CANVAS");
});

browse("a drawing without a build is reported, and appears with its first one", (host) => {
  host.add("human.svg");
  host.built("human.svg", broken());
}, async (page, host) => {
  await page.getByText("There is no model yet: the drawing has problems.").waitFor();
  assert.equal(await page.getByRole("button", { name: "Export" }).isDisabled(), true);
  host.built("human.svg", build(HUMAN));
  await shown(page, 2);
  await page.locator(".notes").waitFor({ state: "hidden" });
});

browse("the header says how large the model is, if there is one", one(HUMAN), async (page, host) => {
  await shown(page);
  const size = page.locator(".bar-size");
  assert.equal(await size.innerText(), "0.902 × 1.73 × 0.2 m");
  assert.equal(await size.getAttribute("title"), "0.902 m wide, 1.73 m high, 0.2 m deep");
  const { build: facts, ...rest } = build(HUMAN);
  host.built("human.svg", { ...rest, build: { ...facts, size: null } });
  await shown(page, 2);
  assert.equal(await size.count(), 0);
});

browse("a missing file is reported, and the drawing comes back", one(HUMAN), async (page, host) => {
  await shown(page);
  host.gone("human.svg");
  await page.getByText("The drawing's file is missing at the moment. This is its last model.").waitFor();
  host.built("human.svg", build(HUMAN));
  await page.locator(".notes").waitFor({ state: "hidden" });
});

browse("several drawings are cards that follow their builds; one opens, and the browser's back button returns", (host) => {
  for (const name of ["human", "car", "dog", "lady", "looks", "robot-ja"]) {
    host.add(name, `${name}.svg`, name === "car" ? "vehicles" : "");
    host.built(name, build(example(name)));
  }
}, async (page, host) => {
  await page.waitForFunction(() => document.querySelectorAll(".card img").length === 6);
  assert.equal(await page.locator(".gallery-head").innerText().then((text) => text.trim()), "6 drawings");
  const card = page.locator("[data-drawing=human]");
  assert.match(await card.innerText(), /human\.svg[\s\S]*7 parts/);
  assert.match(await page.locator("[data-drawing=car]").innerText(), /vehicles/);
  await picture(page, "gallery");
  host.built("human", broken());
  await card.getByText("3 problems").waitFor();
  assert.match(await page.locator(".gallery-head").innerText(), /6 drawings\s+1 with problems/);
  host.add("new", "new.svg");
  await page.locator("[data-drawing=new]").getByText("building…").waitFor();
  await page.locator("[data-drawing=robot-ja]").click();
  await shown(page);
  assert.equal(new URL(page.url()).hash, "#robot-ja");
  assert.equal(await page.title(), "robot-ja.svg · okoshi");
  assert.equal(await page.locator(".tree-item").first().getAttribute("data-part"), "胴");
  assert.deepEqual((await host.messages("want", 1)).at(-1), { type: "want", drawing: "robot-ja" });
  await page.goBack();
  await card.waitFor();
  assert.equal(await page.locator("canvas").isVisible(), false);
  await page.goForward();
  await shown(page);
  await page.keyboard.press("g");
  await card.waitFor();
});

browse("a picture that does not arrive is asked for again", (host) => {
  for (const name of ["human", "car"]) {
    host.add(name, `${name}.svg`);
    host.built(name, build(example(name)));
  }
  host.broken.add("/builds/1.png");
}, async (page, host) => {
  await page.locator("[data-drawing=car] img").waitFor();
  await host.request("/builds/1.png");
  assert.equal(await page.locator("[data-drawing=human] img").count(), 0);
  host.broken.clear();
  await page.locator("[data-drawing=human] img").waitFor();
});

browse("the address names a drawing", (host) => {
  for (const name of ["human", "a drawing #1"]) {
    host.add(name, `${name}.svg`);
    host.built(name, build(HUMAN));
  }
}, async (page) => {
  await shown(page);
  assert.equal(await page.title(), "a drawing #1.svg · okoshi");
}, { hash: `#${encodeURIComponent("a drawing #1")}` });

browse("a new drawing leaves the current one open, and both can be reached", one(HUMAN), async (page, host) => {
  await shown(page, 1);
  await page.getByRole("link", { name: "Drawings" }).waitFor({ state: "hidden" });
  host.add("figure.svg");
  host.built("figure.svg", build(FIGURE));
  await page.getByRole("link", { name: "Drawings" }).waitFor();
  assert.equal(await page.getAttribute("canvas", "data-revision"), "1");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.locator("[data-drawing='figure.svg']").click();
  await shown(page, 2);
  await page.locator("[data-part=Arm]").waitFor();
});

browse("everything works by keyboard, with a visible focus", one(HUMAN), async (page, host) => {
  await shown(page);
  const reached = new Set<string>();
  for (let n = 0; n < 60; n++) {
    await page.keyboard.press("Tab");
    const where = await page.evaluate(() => {
      const at = document.activeElement!;
      if (at === document.body) return "end";
      const { outlineStyle, outlineWidth } = getComputedStyle(at);
      return `${at.getAttribute("aria-label") ?? at.getAttribute("data-part") ?? at.textContent?.trim()}|${outlineStyle !== "none" && parseFloat(outlineWidth) >= 2}`;
    });
    if (where === "end") break;
    const [name, ring] = where.split("|");
    assert.equal(ring, "true", `${name} shows that it is focused`);
    reached.add(name!);
  }
  for (const name of ["Three-quarter view", "Wireframe", "Frame the model", "Parallel", "Pose", "Export", "Help", "2 hints", "Lbody"]) assert.ok(reached.has(name), `${name} is reached: ${[...reached].join(", ")}`);
  assert.ok([...reached].some((name) => name.startsWith("Model of human.svg")), "the model is reached");

  await page.keyboard.press("t");
  const active = () => page.evaluate(() => document.activeElement?.getAttribute("data-part"));
  assert.equal(await active(), "Lbody");
  for (const [key, part] of [["ArrowDown", "U-1"], ["End", "rect184"], ["Home", "Lbody"], ["ArrowLeft", "Lbody"], ["ArrowDown", "Ubody"], ["ArrowRight", "Rarm"], ["ArrowLeft", "Ubody"]] as const) {
    await page.keyboard.press(key);
    assert.equal(await active(), part, `after ${key}`);
  }
  assert.equal(await page.locator("[data-part=Lbody]").getAttribute("aria-expanded"), "false");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Ubody");
  assert.deepEqual((await host.messages("pick", 1)).at(-1), { type: "pick", drawing: "human.svg", part: "Ubody" });

  await page.locator("canvas").focus();
  for (const key of ["1", "ArrowRight", "ArrowUp", "+", "5", "7", "3", "f", "z"]) {
    const before = `${await camera(page)} ${await page.getAttribute("canvas", "data-shading")}`;
    await page.keyboard.press(key);
    await still(page);
    assert.notEqual(`${await camera(page)} ${await page.getAttribute("canvas", "data-shading")}`, before, `${key} does something`);
  }
  await page.keyboard.press("?");
  await page.getByRole("dialog").waitFor();
  await picture(page, "help");
  await page.keyboard.press("Escape");
  await page.getByRole("dialog").waitFor({ state: "hidden" });
  await page.keyboard.press("e");
  assert.equal(await page.locator(".findings").getAttribute("data-open"), "true");
});

browse("on a phone nothing overlaps, and everything works by touch", one(HUMAN), async (page, host) => {
  await shown(page);
  assert.deepEqual(await overlaps(page), []);
  await picture(page, "phone");
  const box = (await page.locator("canvas").boundingBox())!;
  assert.ok(box.height > 200, `the model has ${box.height} pixels`);
  await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["selected"] !== "");
  assert.notEqual(await page.locator(".drawer-words").innerText(), "Parts");
  await picture(page, "phone-part");
  await page.locator(".drawer-opener").tap();
  await page.locator(".inspector").waitFor();
  await page.getByRole("button", { name: "Close the parts" }).tap();
  await page.getByRole("button", { name: "More tools" }).tap();
  for (const button of await page.locator(".toolbar button:visible, .drawer-opener").all()) {
    const { width, height } = (await button.boundingBox())!;
    assert.ok(width >= 36 && height >= 36, `${await button.innerText()} is ${width} by ${height}`);
  }
  await page.getByRole("button", { name: "Pose" }).tap();
  await page.touchscreen.tap(box.x + 20, box.y + box.height / 2);
  assert.deepEqual(await overlaps(page), []);
  host.built("human.svg", broken());
  await page.waitForSelector(".findings[data-open=true]");
  await picture(page, "phone-errors");
}, phone);

browse("nothing overlaps on a wide page either", one(HUMAN), async (page) => {
  await shown(page);
  for (const width of [1600, 1024, 900, 761, 760, 500, 320]) {
    await resize(page, width, 800);
    assert.deepEqual(await overlaps(page), [], `at ${width} pixels`);
  }
});

browse("dark mode is followed at once", one(HUMAN), async (page) => {
  await shown(page);
  const bright = async () => {
    const { data } = await picture(page, "dark");
    let sum = 0;
    for (let i = 0; i < data.length; i += 4) sum += data[i]! + data[i + 1]! + data[i + 2]!;
    return sum / (data.length / 4) / 3;
  };
  assert.ok((await bright()) < 80);
  await page.emulateMedia({ colorScheme: "light" });
  await still(page);
  assert.ok((await bright()) > 180);
  await page.emulateMedia({ colorScheme: "dark" });
  await page.locator("[data-part=Ubody]").click();
  await still(page);
  await picture(page, "dark");
  // The contrast of text that WCAG requires (4.5 to 1).
  const least = await page.evaluate(() => {
    const light = (color: string) => {
      const [r, g, b] = color.match(/[\d.]+/g)!.map((one) => (Number(one) / 255 <= 0.03928 ? Number(one) / 255 / 12.92 : ((Number(one) / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
    };
    const behind = (element: Element): string => {
      const { backgroundColor } = getComputedStyle(element);
      return /, 0\)|transparent/.test(backgroundColor) && element.parentElement ? behind(element.parentElement) : backgroundColor;
    };
    const ratios = [".bar-title", ".bar-facts", ".tree-name", ".tree-note", ".facts dt", ".facts .link", ".badge"].map((name) => {
      const element = document.querySelector(name)!;
      const [a, b] = [light(getComputedStyle(element).color), light(behind(element))];
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    });
    return Math.min(...ratios);
  });
  assert.ok(least >= 4.5, `the least contrast is ${least}`);
}, { colorScheme: "dark" });

browse("the page waits for a lost host and then shows its builds", one(HUMAN), async (page, host) => {
  await shown(page, 1);
  const view = await camera(page);
  await host.stop();
  await page.getByText("Connection lost, trying again…").waitFor();
  assert.equal(await page.getAttribute("canvas", "data-revision"), "1", "the model stays");
  // After a restart it counts from the beginning: the same address is another model.
  host.forget();
  host.add("human.svg");
  host.built("human.svg", build(FIGURE));
  const asked = host.asked.length;
  await host.start();
  await page.getByText("Connection lost, trying again…").waitFor({ state: "hidden" });
  await page.locator("[data-part=Arm]").waitFor();
  await page.waitForFunction(() => document.querySelector("canvas")?.getAttribute("aria-label")?.includes("36 triangles"));
  assert.ok(host.asked.slice(asked).includes("/builds/1.glb"));
  await still(page);
  assert.equal(await camera(page), view);
});

browse("names and strings of drawings are shown as text, never as markup", (host) => {
  const evil = `<img src=x onerror="document.title='hacked'">`;
  host.add("evil", evil, evil);
  const { build: facts, ...rest } = build(HUMAN);
  const parts = [{ name: evil, parent: null, kind: "main", element: evil, string: { line: 1, column: 1, text: evil, bound_by: evil }, attributes: { [evil]: { value: evil, from: "own" } }, joint: evil }];
  const findings = [{ severity: "error", code: evil, message: `${evil} \`${evil}\``, label: evil, help: [evil], line: 1, column: 1, text: evil, from: 0, to: 5 }];
  host.built("evil", { ...rest, build: { ...facts, parts, findings } });
  host.add("other");
}, async (page) => {
  await page.locator(".card img").waitFor();
  await page.locator(".card").first().click();
  await shown(page);
  await page.locator(".tree-item").first().click();
  await page.locator(".inspector", { hasText: "<img src=x onerror=" }).waitFor();
  await pass(page);
  assert.equal(await page.locator("img:not(.card img, .paper img)").count(), 0);
  assert.doesNotMatch(await page.title(), /^hacked/);
  assert.match(await page.locator(".inspector").innerText(), /<img src=x onerror=/);
});

browse("a drawing without parts, and one with thousands", (host) => {
  host.add("many.svg");
  const shapes = Array.from({ length: 3000 }, (_, n) => `<rect id="r${n}" x="${(n % 60) * 5}" y="${Math.floor(n / 60) * 5}" width="4" height="4" fill="#3a7"/>`).join("");
  host.built("many.svg", make(process.env["OKOSHI"] ?? "", `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 300 300">${shapes}</svg>`, FIGURE));
}, async (page, host) => {
  await shown(page);
  assert.equal(await page.locator(".tree-item").first().getAttribute("aria-setsize"), "3000");
  const rows = await countRows(page);
  const before = Number(await page.getAttribute("canvas", "data-frames"));
  await page.locator(".tree").evaluate((tree) => (tree.scrollTop = 26 * 1500));
  await page.locator(".tree-item[aria-posinset='1500']").click();
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["selected"] !== "");
  await still(page);
  const made = await rows();
  assert.ok(made > 0 && made < 100, `${made} rows were made for a click`);
  // The row is hovered and selected, and the picture follows each of them; shadows may follow a frame later.
  const drawn = Number(await page.getAttribute("canvas", "data-frames")) - before;
  assert.ok(drawn > 0 && drawn <= 4, `${drawn} frames were drawn for a click`);
  host.built("many.svg", { model: null, picture: null, build: { milliseconds: 1, stale: false, triangles: 0, findings: [], parts: [] } });
  await page.getByText("The drawing has no parts yet.").waitFor();
});

browse("in VS Code everything goes by posted messages, with the editor's colours", () => {}, async (page) => {
  const { model, build: facts } = build(FIGURE);
  await page.addInitScript(() => {
    const sent: unknown[] = [];
    const postMessage = (message: unknown) => sent.push(structuredClone(message));
    const setState = (state: unknown) => sent.push({ type: "state", state });
    Object.assign(globalThis, { acquireVsCodeApi: () => ({ postMessage, setState }), sentByThePage: sent });
  });
  await page.reload();
  const sent = () => page.evaluate(() => (globalThis as unknown as { sentByThePage: Record<string, unknown>[] }).sentByThePage);
  const post = (message: unknown) => page.evaluate((okoshi) => postMessage({ okoshi }, "*"), message);
  assert.deepEqual(await sent(), [{ type: "ready" }]);
  await page.evaluate(() => {
    document.body.classList.add("vscode-dark");
    for (const [name, value] of [["--vscode-editor-background", "#102030"], ["--vscode-sideBar-background", "#102030"], ["--vscode-foreground", "#eeeeee"]] as const) document.documentElement.style.setProperty(name, value);
  });
  await post({ type: "drawings", drawings: [{ id: "file:///a/figure.svg", name: "figure.svg", folder: "" }] });
  await post({ type: "build", drawing: "file:///a/figure.svg", build: { ...facts, revision: 4, model: "builds/4.glb", picture: null } });
  await page.waitForFunction(() => (globalThis as unknown as { sentByThePage: { type: string }[] }).sentByThePage.some(({ type }) => type === "model"));
  assert.deepEqual((await sent()).filter(({ type }) => type === "model"), [{ type: "model", address: "builds/4.glb" }]);
  await post({ type: "modelBytes", address: "builds/4.glb", bytes: model!.toString("base64") });
  await shown(page, 4);
  await picture(page, "vscode");
  // The system is light and the theme dark: colours that the theme does not define are dark too.
  const faint = await page.evaluate(() => {
    const light = (color: string) => color.match(/[\d.]+/g)!.slice(0, 3).reduce((sum, one) => sum + Number(one), 0) / 3;
    const pressed = getComputedStyle(document.querySelector(".button[aria-pressed=true]")!);
    const quiet = getComputedStyle(document.querySelector(".bar-facts")!);
    return { pressed: light(pressed.color) - light(pressed.backgroundColor), quiet: light(quiet.color) };
  });
  assert.ok(faint.pressed > 100 && faint.quiet > 130, JSON.stringify(faint));
  assert.deepEqual((await picture(page)).at({ x: 20, y: 200 }), [16, 32, 48]);
  // The editor shows what is wrong: here it is only counted.
  await page.clock.install();
  const wrong = { severity: "error", code: "E204", message: "there is no part named `X`", label: "", help: [], line: 3, column: 1, text: "X", from: 0, to: 1 };
  await post({ type: "build", drawing: "file:///a/figure.svg", build: { ...facts, findings: [wrong], stale: true, revision: 4, model: "builds/4.glb", picture: null } });
  await page.getByText("1 problem").waitFor();
  await page.clock.runFor(2000);
  assert.equal(await page.locator(".findings").getAttribute("data-open"), "false");
  assert.equal(await page.locator(".stale-short").innerText(), "last good model");
  await page.locator("[data-part=Arm]").click();
  await page.keyboard.press("d");
  await page.waitForFunction(() => (globalThis as unknown as { sentByThePage: { type: string }[] }).sentByThePage.some(({ type }) => type === "save"));
  const last = await sent();
  assert.deepEqual(last.find(({ type }) => type === "pick"), { type: "pick", drawing: "file:///a/figure.svg", part: "Arm" });
  assert.deepEqual(last.find(({ type }) => type === "save"), { type: "save", name: "figure.glb", bytes: model!.toString("base64") });
  await post({ type: "light", drawing: "file:///a/figure.svg", part: "Head" });
  await page.waitForSelector(".tree-item.lit[data-part=Head]");
  // The state that the editor passes to the extension when it restores the panel.
  assert.deepEqual(last.find(({ type }) => type === "state"), { type: "state", state: { drawing: "file:///a/figure.svg" } });
  // The language server stopped, and another one started: its builds are counted from the beginning.
  await post({ type: "link", state: "lost", note: "okoshi is not running at present." });
  await page.waitForSelector(".bar[data-link=lost] .bar-link >> text=okoshi is not running at present.");
  await post({ type: "build", drawing: "file:///a/figure.svg", build: { ...facts, revision: 1, model: "builds/4.glb", picture: null } });
  assert.equal((await sent()).filter(({ type }) => type === "model").length, 1);
  await post({ type: "link", state: "open", note: "" });
  await page.waitForFunction(() => (globalThis as unknown as { sentByThePage: { type: string }[] }).sentByThePage.filter(({ type }) => type === "model").length === 2);
  await page.waitForSelector(".bar-link", { state: "hidden" });
  await post({ type: "modelBytes", address: "builds/4.glb", bytes: model!.toString("base64") });
  await shown(page, 1);
});

browse("the picture of the manual", one(example("clockwork-dragon")), async (page) => {
  await shown(page);
  await page.locator("[data-part=Head]").click();
  await page.locator("canvas").focus();
  await page.evaluate(() => (document.activeElement as HTMLElement).blur());
  for (const key of ["ArrowLeft", "ArrowLeft", "+"]) await page.keyboard.press(key);
  await page.mouse.move(2, 2);
  assert.ok(await page.locator("[data-part=Head]").evaluate((row) => row.getBoundingClientRect().bottom <= row.closest(".tree")!.getBoundingClientRect().bottom), "the chosen row stays in sight beside its details");
  await still(page);
  await manual(page, "preview.png");
  const { width, height, data } = await picture(page);
  assert.deepEqual([width, height], [1180, 720]);
  const colours = new Set<number>();
  for (let i = 0; i < data.length; i += 4) colours.add((data[i]! << 16) | (data[i + 1]! << 8) | data[i + 2]!);
  assert.ok(colours.size > 3000, `${colours.size} colours`);
}, { viewport: { width: 1180, height: 720 }, smoothEdges: true });

browse("of a model that a newer one replaced, nothing is said until the page reads of that", one(FIGURE), async (page, host) => {
  await shown(page, 1);
  host.replaced.add("/builds/2.glb");
  const answered = page.waitForResponse((response) => response.url().includes("/builds/2.glb"));
  host.built("figure.svg", build(FIGURE, (text) => text.replace("-8 8", "-8 9")));
  await (await answered).finished();
  await pass(page);
  assert.equal(await page.getByText("could not be shown").count(), 0);
  host.built("figure.svg", build(FIGURE, (text) => text.replace("-8 8", "-8 10")));
  await shown(page, 3);
});
