// Clips: the timing of drawings, the movement chart, and the comparison of full and limited clips.

import assert from "node:assert/strict";
import type { Page } from "playwright-core";
import { camera, overlaps, picture, project, resize, seekTo, shown, still, type Colour } from "./browser";
import { aside, EXPOSURE, FACTS, FRAMES, FPS, FULL, kick, LEG, OMITTED, raised, SECONDS, SSD } from "./kick";
import type { MockHost } from "./mock";
import { assertLike, browse, build, FIGURE, isLike } from "./setup";
import { animate } from "./animate";
import { SPIN } from "./spin";

const DRAWINGS = EXPOSURE.length;
const kicking = (made = kick()) => (host: MockHost): void => {
  host.add("kick.svg");
  host.built("kick.svg", made);
};
const readout = (page: Page) => page.locator(".clips .readout").innerText();
const marks = (page: Page, name: string) => page.locator(`.chart .chart-${name}`).getAttribute("data-marks").then(Number);
/** The x coordinate of a time on the axis that slider and chart share. */
const onAxis = async (page: Page, seconds: number): Promise<number> => {
  const { x, width } = (await page.locator(".timeline").boundingBox())!;
  return x + 8 + ((width - 16) * seconds) / Number(await page.locator(".slider").getAttribute("max"));
};
/** The middle of a source frame in the chart, counted from 0. */
const inChart = async (page: Page, source: number): Promise<{ x: number; y: number }> => {
  const box = (await page.locator(".chart .chart-picture").boundingBox())!;
  return { x: await onAxis(page, (source + 0.5) / FPS), y: box.y + 60 };
};
const playhead = (page: Page) => page.locator(".chart .chart-head").getAttribute("transform").then((words) => Number(/translate\(([\d.]+)/.exec(words ?? "")?.[1]));
const front = async (page: Page) => {
  await page.keyboard.press("1");
  await page.keyboard.press("5");
  await still(page);
};
/** The colour at the middle of the raised leg in a source frame, at an offset to the right. */
const leg = async (page: Page, source: number, offset = 0): Promise<Colour> => {
  const angle = raised(source);
  const hip = 0.1 + (0.6 * source) / (FRAMES - 1);
  return (await picture(page)).at(await project(page, offset + hip + 0.6 * Math.sin(angle), 0.8 - 0.6 * Math.cos(angle), 0.08));
};
/** The frame, from 0, where a drawing begins. */
const begins = (drawing: number): number => EXPOSURE.slice(0, drawing).reduce((sum, [, frames]) => sum + frames, 0);

browse("a limited clip counts drawings and frames over its full duration, with its last drawing held", kicking(), async (page) => {
  await shown(page);
  assert.equal(await page.locator(".clip-choice").locator("option").allInnerTexts().then((all) => all.join("|")), `kick · 2.5 s · ${DRAWINGS} drawings|slowly · 2.5 s`);
  assert.equal(await readout(page), `drawing 1 of ${DRAWINGS} · frame 1 of 60 · 0.00 s`);
  assert.equal(await page.locator(".ticks").getAttribute("data-keys"), String(DRAWINGS));
  assert.equal(await page.locator(".slider").getAttribute("max"), String(Math.fround(SECONDS)));
  const [, stands] = EXPOSURE.at(-1)!;
  assert.ok(stands > 1, "the last drawing is held");
  const path = (await page.locator(".ticks .held").getAttribute("d"))!;
  const boxes = path.split("Z").slice(0, -1).map((box) => box.match(/[\d.]+/g)!.map(Number));
  assert.equal(boxes.length, DRAWINGS);
  boxes.forEach(([left], at) => assert.ok(Math.abs(left! - (begins(at) * 1000) / FRAMES) < 0.02, `box ${at + 1} begins at ${left}`));
  assert.ok(Math.abs(boxes.at(-1)![2]! - 998) < 0.02, "the last box ends where the clip does");
  await seekTo(page, SECONDS);
  assert.equal(await readout(page), `drawing ${DRAWINGS} of ${DRAWINGS} · frame 60 of 60 · 2.50 s`);
  await page.locator("canvas").focus();
  await page.keyboard.press("k");
  assert.match(await readout(page), /^drawing 1 of .* frame 1 of /);
  for (let drawing = 2; drawing <= 7; drawing++) {
    await page.keyboard.press("k");
    assert.match(await readout(page), new RegExp(`^drawing ${drawing} of .* frame ${begins(drawing - 1) + 1} of `));
  }
  await page.keyboard.press("j");
  assert.match(await readout(page), /^drawing 6 of /);
  // From within a drawing back to its beginning.
  const held = EXPOSURE.findIndex(([, frames]) => frames === 3);
  await seekTo(page, (begins(held) + 2.5) / FPS);
  await page.locator("canvas").focus();
  await page.keyboard.press("j");
  assert.match(await readout(page), new RegExp(`^drawing ${held + 1} of .* frame ${begins(held) + 1} of `));
  // The last drawing is held for its full time before the clip starts over.
  await seekTo(page, (begins(DRAWINGS - 1) + 0.2) / FPS);
  await page.locator("canvas").focus();
  await page.keyboard.press("Space");
  await page.waitForFunction(() => Number(/([\d.]+) s$/.exec(document.querySelector(".readout")!.textContent!)![1]) < 2);
  await page.keyboard.press("Space");
});

browse("a clip that does not repeat stops at its true end", kicking(), async (page) => {
  await shown(page);
  await page.getByRole("button", { name: "Loop" }).click();
  await seekTo(page, (begins(DRAWINGS - 1) + 0.5) / FPS);
  await page.locator("canvas").focus();
  await page.keyboard.press("Space");
  await page.waitForSelector(".clips[data-playing=false]");
  assert.equal(await readout(page), `drawing ${DRAWINGS} of ${DRAWINGS} · frame 60 of 60 · 2.50 s`);
});

browse("the chart shows frames, omitted frames and drawings; its playhead moves, and a click seeks", kicking(), async (page) => {
  await shown(page);
  await front(page);
  const chart = page.locator(".chart");
  assert.equal(await chart.isVisible(), false);
  await page.keyboard.press("c");
  await chart.waitFor();
  assert.equal(await page.getByRole("button", { name: "Chart" }).getAttribute("aria-pressed"), "true");
  assert.equal(await marks(page, "curve"), FRAMES);
  assert.equal(await marks(page, "gone"), OMITTED.length);
  const held = EXPOSURE.filter(([, frames]) => frames > 1).length;
  assert.deepEqual([await marks(page, "held"), await marks(page, "single")], [held, DRAWINGS - held]);
  assert.equal(await page.locator(".chart .chart-summary").innerText(), `60 frames, ${DRAWINGS} drawings, 4 in-betweens omitted, ${FACTS.held.length} held`);
  const said = (await page.locator(".chart .chart-picture").getAttribute("aria-label"))!;
  const most = SSD.indexOf(Math.max(...SSD));
  assert.match(said, new RegExp(`^How much the joints of kick move .* 4 in-betweens omitted.* The fastest is frame ${most + 1}, with an SSD of [\\d.]+\\.$`));
  assert.equal(await page.locator(".chart .chart-picture").getAttribute("role"), "img");

  const start = await playhead(page);
  await page.keyboard.press("k");
  assert.ok((await playhead(page)) > start, "the playhead moves");
  // A click goes to the frame there; the drawing that is shown then may stand for a frame of the source before or after it.
  const after = OMITTED.at(-1)! + 1;
  const drawing = EXPOSURE.findLastIndex((_, at) => begins(at) <= after);
  const place = await inChart(page, after);
  await page.mouse.move(place.x, place.y);
  assert.match(await page.locator(".chart .chart-tip").innerText(), new RegExp(`^frame ${after + 1} · SSD [\\d.]+ · drawing ${drawing + 1}`));
  await page.mouse.click(place.x, place.y);
  await still(page);
  assert.match(await readout(page), new RegExp(`^drawing ${drawing + 1} of .* frame ${after + 1} of`));
  assert.equal(await page.locator(".chart .chart-picture").getAttribute("data-source"), String(EXPOSURE[drawing]![0] + 1));
  assertLike(await leg(page, EXPOSURE[drawing]![0]), LEG, "the leg in the drawing that was clicked");
  // A drag seeks continuously; omitted frames of the source are marked.
  const gone = await inChart(page, OMITTED[2]!);
  await page.mouse.move(place.x, place.y);
  await page.mouse.down();
  await page.mouse.move(gone.x, gone.y, { steps: 3 });
  assert.match(await page.locator(".chart .chart-tip").innerText(), /^frame 30 · SSD [\d.]+ · omitted · drawing \d+/);
  assert.match(await readout(page), /frame 30 of 60/);
  await page.mouse.up();
  await page.mouse.move(5, 5);
  await page.locator(".chart .chart-tip").waitFor({ state: "hidden" });

  await page.locator(".clip-choice").selectOption({ index: 1 });
  assert.equal(await page.locator(".chart .chart-summary").innerText(), "60 frames, as in the motion file");
  assert.deepEqual([await marks(page, "curve"), await marks(page, "gone"), await marks(page, "held"), await marks(page, "single")], [FRAMES, 0, 0, 0]);
  assert.equal(await readout(page), "frame 1 of 60 · 0.00 s");
  await page.reload();
  await shown(page);
  await chart.waitFor();
  await page.keyboard.press("c");
  await chart.waitFor({ state: "hidden" });
});

browse("a frame has the same place on the slider, among the keys and in the chart", kicking(), async (page) => {
  await shown(page);
  await page.keyboard.press("c");
  for (const width of [1400, 844, 520, 390]) {
    await resize(page, width, width === 844 ? 390 : 800);
    const left = (await page.locator(".chart .chart-picture").boundingBox())!.x;
    for (const frame of [0, 17, 59]) {
      await seekTo(page, (frame + 0.02) / FPS);
      await still(page);
      const wanted = await onAxis(page, frame / FPS);
      assert.ok(Math.abs(left + (await playhead(page)) - wanted) < 1, `the playhead at ${width} pixels`);
      const place = await inChart(page, frame);
      await page.mouse.click(place.x, (await page.locator(".chart .chart-picture").boundingBox())!.y + 25);
      await still(page);
      assert.match(await readout(page), new RegExp(`frame ${frame + 1} of`));
    }
  }
  const boxes = (await page.locator(".ticks").boundingBox())!;
  assert.ok(Math.abs(boxes.x - (await onAxis(page, 0))) < 1 && Math.abs(boxes.x + boxes.width - (await onAxis(page, FRAMES / FPS))) < 1, "the keys");
});

browse("an onion skin shows the drawings before and after, while the clip is paused", kicking(), async (page) => {
  await shown(page);
  await front(page);
  const skins = () => page.getAttribute("canvas", "data-onion-skin").then(Number);
  const at = EXPOSURE.findIndex(([source]) => source === OMITTED.at(-1)! + 2);
  const seek = async (drawing: number): Promise<void> => {
    await seekTo(page, (begins(drawing) + 0.02) / FPS);
    await still(page);
  };
  await seek(at);
  const before = await leg(page, EXPOSURE[at - 1]![0]);
  await page.locator("canvas").focus();
  await page.keyboard.press("n");
  await still(page);
  assert.equal(await skins(), 2);
  await picture(page, "onion-skin");
  const [red, , blue] = await leg(page, EXPOSURE[at - 1]![0]);
  assert.ok(before[2] - blue > 15 && red - blue > 15, `the drawing before is orange: ${red} ${blue}, without it ${before.join(" ")}`);
  await page.locator("[data-part=Leg]").click();
  await page.keyboard.press("h");
  await still(page);
  assert.ok(Math.abs((await leg(page, EXPOSURE[at - 1]![0]))[2] - before[2]) < 8, "hidden parts have none");
  await page.keyboard.press("h");
  await seek(0);
  assert.equal(await skins(), 1, "nothing is before the first");
  await page.locator("canvas").focus();
  await page.keyboard.press(" ");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["onionSkin"] === "0");
  await page.keyboard.press(" ");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["onionSkin"] !== "0");
});

browse("full and limited clips play side by side", kicking(), async (page, host) => {
  await shown(page);
  await front(page);
  const before = await camera(page);
  assert.ok(!host.asked.includes("/builds/1.originals.glb"), "it is not fetched before it is asked for");
  await page.keyboard.press("o");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  await still(page);
  const offset = Number(await page.getAttribute("canvas", "data-beside"));
  assert.ok(offset > 1.2 && offset < 3, `${offset} m apart`);
  assert.notEqual(await camera(page), before, "both are in the picture");
  assert.deepEqual(await page.locator(".caption").allInnerTexts(), ["limited", "full"]);
  const [own, other] = await Promise.all([0, 1].map(async (at) => (await page.locator(".caption").nth(at).boundingBox())!));
  assert.ok(own!.x + own!.width < other!.x, "labels stand over their own");

  // Within a held drawing the limited clip does not move, and the full one does.
  const held = EXPOSURE.findIndex(([source, frames]) => frames === 3 && source > 36);
  const [source] = EXPOSURE[held]!;
  const frame = begins(held) + 2;
  await seekTo(page, (frame + 0.02) / FPS);
  await still(page);
  await picture(page, "beside");
  assertLike(await leg(page, source), LEG, "the limited leg");
  assertLike(await leg(page, frame, offset), LEG, "the full leg");
  // The difference is largest among the omitted in-betweens.
  await seekTo(page, (OMITTED[1]! + 0.02) / FPS);
  await still(page);
  assertLike(await leg(page, OMITTED[1]!, offset), LEG, "the full leg between");
  assert.ok(!isLike(await leg(page, OMITTED[1]!), LEG), "the limited leg is elsewhere");

  // Both can be picked.
  const head = await project(page, offset + (0.6 * OMITTED[1]!) / (FRAMES - 1), 1.55, 0.13);
  await page.mouse.move(head.x, head.y);
  await page.waitForSelector(".tree-item.hovered[data-part=Head]");
  await page.mouse.click(head.x, head.y);
  assert.equal(await page.getAttribute("canvas", "data-selected"), "Head");
  await picture(page, "beside-selected");
  await page.mouse.move(5, 5);

  // Another clip is compared too; both sides of one that is not limited are the same.
  await page.locator(".clip-choice").selectOption({ index: 1 });
  assert.deepEqual(await page.locator(".caption").allInnerTexts(), ["full", "full"]);
  await seekTo(page, (OMITTED[1]! + 0.02) / FPS);
  await still(page);
  for (const to of [0, offset]) assertLike(await leg(page, OMITTED[1]!, to), LEG, `the leg ${to} m to the right`);
  await page.locator(".clip-choice").selectOption({ index: 0 });
  await seekTo(page, (OMITTED[1]! + 0.02) / FPS);
  await page.locator("canvas").focus();

  // A new build changes both, and its full clips are fetched.
  host.built("kick.svg", kick(undefined, (colour) => (colour === LEG ? [0, 0, 220] : colour)));
  await shown(page, 2);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  assertLike(await leg(page, OMITTED[1]!, offset), [0, 0, 220], "the full leg of the new model");
  assert.ok(host.asked.includes("/builds/2.originals.glb"));
  for (const key of ["z", "z", "z", "z"]) await page.keyboard.press(key);

  await page.keyboard.press("o");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"] === "");
  await still(page);
  assert.equal(await camera(page), before, "the camera is where it was");
  assert.equal(await page.locator(".caption").first().isVisible(), false);
  assert.ok(!isLike(await leg(page, OMITTED[1]!, offset), [0, 0, 220]));
  // The second time nothing is fetched again.
  await page.keyboard.press("o");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  assert.equal(host.asked.filter((path) => path.endsWith("originals.glb")).length, 2);
  // The comparison ends with a build in which nothing is limited.
  host.built("kick.svg", { ...kick([FULL]), originals: null });
  await shown(page, 3);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"] === "");
  await page.getByRole("button", { name: "side by side" }).waitFor({ state: "hidden" });
});

browse("unreadable original clips are reported, and the model stays", (host) => {
  kicking()(host);
  host.broken.add("/builds/1.originals.glb");
}, async (page, host) => {
  await shown(page);
  await page.keyboard.press("o");
  await page.getByText("The original clips could not be shown:").waitFor();
  assert.equal(await page.getAttribute("canvas", "data-beside"), "");
  host.broken.clear();
  await page.keyboard.press("o");
  await page.getByText("The original clips could not be shown").waitFor({ state: "hidden" });
  await page.keyboard.press("o");
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
});

browse("in VS Code original clips are requested like models", () => {}, async (page) => {
  const { model, originals, build: facts } = kick();
  await page.addInitScript(() => {
    const sent: unknown[] = [];
    Object.assign(globalThis, { acquireVsCodeApi: () => ({ postMessage: (message: unknown) => sent.push(structuredClone(message)), setState: () => {} }), sentByThePage: sent });
  });
  await page.reload();
  const asks = (address: string) => page.waitForFunction((wanted) => (globalThis as unknown as { sentByThePage: { type: string; address?: string }[] }).sentByThePage.some(({ type, address }) => type === "model" && address === wanted), address);
  const post = (message: unknown) => page.evaluate((okoshi) => postMessage({ okoshi }, "*"), message);
  await post({ type: "drawings", drawings: [{ id: "a", name: "a.svg", folder: "" }] });
  await post({ type: "build", drawing: "a", build: { ...facts, revision: 4, model: "builds/4.glb", originals: "builds/4.originals.glb", picture: null } });
  await asks("builds/4.glb");
  await post({ type: "modelBytes", address: "builds/4.glb", bytes: model!.toString("base64") });
  await shown(page, 4);
  await page.keyboard.press("o");
  await asks("builds/4.originals.glb");
  await post({ type: "modelBytes", address: "builds/4.originals.glb", bytes: originals!.toString("base64") });
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
});

browse("the inspector shows which joint drives a part, and why", kicking(), async (page) => {
  await shown(page);
  await page.locator("[data-part=Leg]").click();
  assert.match(await page.locator(".inspector").innerText(), /Driven by\s+RightUpLeg — drawn left, so right; lowest point near the ground/);
  await page.locator("[data-part=Head]").click();
  assert.match(await page.locator(".inspector").innerText(), /Driven by\s+no joint: it follows its parent/);
});

browse("the view goes along with a figure that travels, and stays where it is afterwards", kicking(), async (page) => {
  await shown(page);
  await page.keyboard.press(" ");
  const button = page.getByRole("button", { name: "Follow the figure" });
  const numbers = async () => (await camera(page)).split(" ").slice(0, 6).map(Number);
  const seek = async (time: number) => {
    await seekTo(page, time);
    await still(page);
    return numbers();
  };
  const begin = await seek(0);
  assert.deepEqual(await seek(SECONDS), begin, "without the switch the view stays");
  await seek(0);
  await page.locator("canvas").focus();
  await page.keyboard.press("v");
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  const end = await seek(SECONDS);
  end.forEach((number, at) => assert.ok(Math.abs(number - begin[at]! - (at % 3 === 0 ? aside(EXPOSURE.at(-1)![0]) : 0)) < 1e-3, `${begin} ${end}`));
  const back = await seek(0);
  back.forEach((number, at) => assert.ok(Math.abs(number - begin[at]!) < 1e-3, `${begin} ${back}`));
  await button.click();
  assert.equal(await button.getAttribute("aria-pressed"), "false");
  assert.deepEqual(await seek(SECONDS), await seek(0));
});

browse("the drawings of one of several figures are counted; without facts keys are counted", (host) => {
  const other = { ...FACTS, figure: "Twin", limited: true, exposure: [[0, 30], [30, 30]], drawings: 2, omitted: [], held: FACTS.held };
  kicking(kick([FACTS, other]))(host);
}, async (page, host) => {
  await shown(page);
  assert.equal(await page.locator(".clip-choice").locator("option").first().innerText(), "kick · 2.5 s · 2 figures");
  assert.match(await readout(page), new RegExp(`^drawing 1 of ${DRAWINGS} `));
  await page.locator(".figure-choice").selectOption("Twin");
  assert.equal(await readout(page), "drawing 1 of 2 · frame 1 of 60 · 0.00 s");
  await page.locator("canvas").focus();
  await page.keyboard.press("k");
  assert.equal(await readout(page), "drawing 2 of 2 · frame 31 of 60 · 1.25 s");
  const { model, ...rest } = build(FIGURE);
  host.built("kick.svg", { ...rest, model: animate(model!, "Arm", "wave", SPIN) });
  await shown(page, 2);
  assert.equal(await page.locator(".clip-choice").locator("option").first().innerText(), "wave · 1.0 s · 4 drawings");
  for (const name of ["Chart", "Full and limited side by side"]) assert.equal(await page.getByRole("button", { name }).isVisible(), false);
  await page.keyboard.press("c");
  assert.equal(await page.locator(".chart").isVisible(), false);
  host.built("kick.svg", build(FIGURE));
  await shown(page, 3);
  await page.locator(".clips").waitFor({ state: "hidden" });
});

browse("the chart of an hour keeps its peaks", (host) => {
  const frames = 86_400;
  const ssd = Array.from({ length: frames / 8 }, (_, at) => (at === 7001 ? 3 : 0.01 * (1 + Math.sin(at / 40))));
  kicking(kick([{ ...FULL, name: "kick", frames, ssd, ssd_step: 8, exposure: [] }]))(host);
}, async (page) => {
  await shown(page);
  await page.keyboard.press("c");
  const points = (await page.locator(".chart .chart-curve").getAttribute("d"))!.slice(1).split("L").map((point) => point.split(" ").map(Number));
  const box = (await page.locator(".chart .chart-picture").boundingBox())!;
  assert.ok(points.length > 200 && points.length <= box.width, `${points.length} points`);
  const top = points.reduce((a, b) => (b[1]! < a[1]! ? b : a));
  assert.ok(Math.abs(box.x + top[0]! - (await onAxis(page, (7001 * 8) / FPS))) < 2, "the peak is in its place");
  assert.match((await page.locator(".chart .chart-picture").getAttribute("aria-label"))!, /The fastest is frame 56,?009, with an SSD of 3\./);
});

browse("the chart and two figures at any width, in dark mode", kicking(), async (page) => {
  await shown(page);
  for (const key of ["c", "o"]) await page.keyboard.press(key);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  await page.locator(".slider").fill("1.4");
  for (const width of [1600, 1200, 1024, 900, 761, 760, 500, 380, 320]) {
    await resize(page, width, 800);
    assert.deepEqual(await overlaps(page), [], `at ${width} pixels`);
    const clipped = await page.locator(".clips .readout").evaluate((element) => element.scrollWidth > element.clientWidth + 1);
    assert.equal(clipped, false, `the readout is whole at ${width} pixels`);
  }
  await resize(page, 1200, 800);
  await still(page);
  await picture(page, "clips-dark");
  const [ink, paper] = await page.evaluate(() => [getComputedStyle(document.querySelector(".chart .chart-number")!).fill, getComputedStyle(document.querySelector(".motion")!).backgroundColor]);
  const light = (color: string) => color.match(/[\d.]+/g)!.slice(0, 3).reduce((sum, one) => sum + Number(one), 0) / 3;
  assert.ok(light(ink!) - light(paper!) > 90, `${ink} on ${paper}`);
}, { colorScheme: "dark" });

browse("the chart and two figures in light mode", kicking(), async (page) => {
  await shown(page);
  for (const key of ["c", "o"]) await page.keyboard.press(key);
  await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
  await page.locator(".slider").fill("1.4");
  const place = await inChart(page, 40);
  await page.mouse.move(place.x, place.y);
  await still(page);
  await picture(page, "clips-light");
});

const phone = { viewport: { width: 380, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 } as const;
for (const colorScheme of ["light", "dark"] as const) {
  browse(`on a phone, ${colorScheme}, the chart is sharp, touched, and leaves room for the model`, kicking(), async (page) => {
    await shown(page);
    await page.getByRole("button", { name: "Chart" }).tap();
    await page.getByRole("button", { name: "More about the clip" }).tap();
    await page.getByRole("button", { name: "side by side" }).tap();
    await page.keyboard.press("Escape");
    await page.waitForFunction(() => document.querySelector("canvas")!.dataset["beside"]);
    assert.deepEqual(await overlaps(page), []);
    const place = await inChart(page, 33);
    await page.touchscreen.tap(place.x, place.y);
    await still(page);
    assert.match(await readout(page), /frame 34 of 60/);
    assert.ok((await page.locator("canvas").boundingBox())!.height > 200);
    for (const button of await page.locator(".clips button:visible").all()) {
      const { width, height } = (await button.boundingBox())!;
      assert.ok(width >= 36 && height >= 36, `${await button.getAttribute("aria-label")} is ${width} by ${height}`);
    }
    await picture(page, `clips-phone-${colorScheme}`);
  }, { ...phone, colorScheme });
}
