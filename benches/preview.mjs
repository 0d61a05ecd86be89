// Measures the preview page: how long it takes to open, from a save to the new picture, to turn the view, and from a press to what it
// changes (press.mjs).
//
//   cargo build --release && npm ci --prefix editors/web && node benches/preview.mjs [PARTS…]
//
// Opening: until the list of parts is on the screen, and until the model is.
// A save: one part of a drawing changes, or all do, written like Inkscape does it, truncated and then in pieces. The steps: until the watcher notices
// (event), until the file has settled, until the model is built, until the page is notified (push), until it has fetched and drawn the
// model (frame). Bytes: those of the message, and of the model or what changed in it.
// Turning: one frame of the same model from another direction, and its draw calls.
// The list: folding and opening its root, which shows all rows anew, as a save does; and a click on a row, until the picture shows it.
// The main thread's time is the time of the processor by its own clock. Chromium renders in software here; a graphics card is faster.

import { spawn } from "node:child_process";
import { closeSync, mkdtempSync, openSync, rmSync, writeFileSync, writeSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { presses } from "./press.mjs";

const root = new URL("..", import.meta.url).pathname;
const { chromium } = createRequire(join(root, "editors/web/package.json"))("playwright-core");
const okoshi = process.env.OKOSHI ?? join(root, "target/release/okoshi");
const TURNS = 30;
/** Of how many parts a drawing is at most in which presses are measured: rendered in software, hundreds of pictures of larger ones take very long. */
const MOST_PRESSED = 2000;
/** How often the list is folded and opened. */
const FOLDS = 25;
/** Kinds of solids, used in turn. */
const KINDS = ["default -9 9", "roundv", "default -5 5", "round", "conev -8 8 0.5", "flat"];
/** The part whose width changes, in the middle of its row. */
const EDITED = 2;

/** How often a drawing of so many parts is saved with a change of one part, and with changes of all. */
const savesOf = (parts) => (parts > 2000 ? [5, 5] : [20, 5]);

/** A figure of `parts` parts, of which one is `width` wide, or all are. */
function drawing(parts, width, all = false) {
  const side = Math.ceil(Math.sqrt(parts));
  const shapes = [];
  for (let index = 0; index < parts; index++) {
    const [x, y] = [40 * (index % side), 40 * Math.floor(index / side)];
    const wide = all || index === EDITED ? width : 24;
    const shape = index % 2 === 0
      ? `<rect id="e${index}" x="${x}" y="${y}" width="${wide}" height="20" fill="#c83737"/>`
      : `<ellipse id="e${index}" cx="${x + 15}" cy="${y + 12}" rx="${all ? width - 10 : 14}" ry="9" fill="#2a7fff"/>`;
    shapes.push(shape, `<text x="${x + 12}" y="${y + 10}" font-size="3">P${index}${index > 0 ? "@P0" : ""}$Shape ${KINDS[index % KINDS.length]}</text>`);
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${40 * side}" height="${40 * side}">\n${shapes.join("\n")}\n</svg>\n`;
}

function save(path, text) {
  const file = openSync(path, "w");
  for (let at = 0; at < text.length; at += 4096) writeSync(file, text.slice(at, at + 4096));
  closeSync(file);
}

const median = (numbers) => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

/** Runs in the page before its own script: notes when it shows what, what it receives, and its draw calls. */
function observe() {
  // The system clock, which the program uses too.
  const clock = () => Date.now();
  const seen = (window.seen = { builds: {}, list: 0, model: 0, draws: 0 });
  const Socket = window.WebSocket;
  window.WebSocket = class extends Socket {
    constructor(...rest) {
      super(...rest);
      this.addEventListener("message", ({ data }) => {
        const received = clock();
        const message = JSON.parse(data);
        if (message.type === "build") seen.builds[message.build.revision] = { received, bytes: data.length, ...message.build.steps };
      });
    }
  };
  const { prototype } = WebGL2RenderingContext;
  for (const name of ["drawElements", "drawArrays"]) {
    const draw = prototype[name];
    prototype[name] = function (...rest) {
      seen.draws++;
      return draw.apply(this, rest);
    };
  }
  const get = prototype.getExtension;
  prototype.getExtension = function (name) {
    const extension = get.call(this, name);
    if (name !== "WEBGL_multi_draw" || !extension || extension.multiDrawElementsWEBGL.counts) return extension;
    const draw = extension.multiDrawElementsWEBGL;
    extension.multiDrawElementsWEBGL = function (...rest) {
      seen.draws++;
      return draw.apply(this, rest);
    };
    extension.multiDrawElementsWEBGL.counts = true;
    return extension;
  };
  let [revision, frames] = [0, 0];
  new MutationObserver(() => {
    if (seen.list === 0 && document.querySelector("[data-part]")) {
      seen.list = Math.round(performance.now());
      requestAnimationFrame(() => setTimeout(() => (seen.list = Math.round(performance.now()))));
    }
    const canvas = document.querySelector("canvas");
    if (!canvas?.dataset.revision) return;
    const [shown, drawn] = [Number(canvas.dataset.revision), Number(canvas.dataset.frames)];
    if (shown !== revision && drawn > frames) {
      const context = canvas.getContext("webgl2");
      const fence = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
      context.flush();
      // Asks whether the frame is rendered: waiting for it would count as the main thread's time.
      const ask = () => {
        if (context.getSyncParameter(fence, context.SYNC_STATUS) !== context.SIGNALED) return setTimeout(ask, 2);
        seen.builds[shown].drawn = clock();
        seen.model ||= Math.round(performance.now());
      };
      ask();
      revision = shown;
    }
    frames = drawn;
  }).observe(document, { subtree: true, childList: true, attributes: true });
}

/** Runs in the page: folds and opens the root of the list. Returns the times of the openings with their layout, in milliseconds. */
function fold(count) {
  const list = document.querySelector(".tree");
  const times = [];
  for (let number = 0; number < count; number++) {
    for (const key of ["ArrowLeft", "ArrowRight"]) {
      const begun = performance.now();
      list.querySelector("[tabindex='0']").dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
      void list.offsetHeight;
      if (key === "ArrowRight") times.push(performance.now() - begun);
    }
  }
  return times;
}

/** Measures the main thread's time of an action, in milliseconds. */
async function mainThread(cdp, action) {
  const time = async () => {
    const { metrics } = await cdp.send("Performance.getMetrics");
    return 1000 * metrics.find(({ name }) => name === "ThreadTime").value;
  };
  const before = await time();
  await action();
  return (await time()) - before;
}

const print = (what, numbers) => console.log(`  ${what}:`, Object.entries(numbers).map(([name, [number, unit]]) => `${name} ${number.toFixed(unit === "ms" ? 1 : 0)} ${unit}`.trimEnd()).join(", "));

async function measure(parts) {
  const folder = mkdtempSync(join(tmpdir(), "okoshi-bench-"));
  const path = join(folder, "a.svg");
  save(path, drawing(parts, 24));
  const server = spawn(okoshi, ["preview", path, "--port", "0", "-q"], { stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((found) => server.stdout.once("data", (line) => found(String(line).trim())));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing", "--disable-quic", "--no-first-run"],
  });
  console.log(`${parts} parts`);
  // The first visit waits for the first build; the second is measured.
  for (const visit of ["first", "second"]) {
    const page = await browser.newPage({ viewport: { width: 640, height: 480 } });
    page.setDefaultTimeout(300_000);
    await page.addInitScript(observe);
    const cdp = await page.context().newCDPSession(page);
    await cdp.send("Performance.enable");
    const opening = await mainThread(cdp, async () => {
      await page.goto(url);
      await page.waitForFunction(() => window.seen.model > 0);
    });
    if (visit === "second") await measurePage(page, cdp, { parts, path, opening });
    await page.close();
  }
  if (parts <= MOST_PRESSED) {
    const page = await browser.newPage({ viewport: { width: 1000, height: 600 } });
    page.setDefaultTimeout(60_000);
    await page.goto(url);
    await page.waitForSelector("canvas[data-frames]");
    await presses(page, print);
  }
  await browser.close();
  server.kill();
  rmSync(folder, { recursive: true });
}

/** Saves texts one after the other, the first of which is a given revision. */
async function measureSaves(page, cdp, path, what, texts, first) {
  const steps = [];
  for (const [number, text] of texts.entries()) {
    const revision = first + number;
    await page.evaluate(() => performance.clearResourceTimings());
    let saved = 0;
    const time = await mainThread(cdp, async () => {
      saved = Date.now();
      save(path, text);
      await page.waitForFunction((revision) => window.seen.builds[revision]?.drawn, revision);
      // Until the shadow has been drawn too.
      await pause(500);
    });
    const times = await page.evaluate((revision) => window.seen.builds[revision], revision);
    const bytes = await page.evaluate(() => performance.getEntriesByType("resource").reduce((sum, { decodedBodySize }) => sum + decodedBodySize, 0));
    steps.push({
      event: [times.noticed - saved, "ms"],
      settle: [times.begun - times.noticed, "ms"],
      build: [times.built - times.begun, "ms"],
      push: [times.received - times.built, "ms"],
      frame: [times.drawn - times.received, "ms"],
      "in all": [times.drawn - saved, "ms"],
      "main thread": [time, "ms"],
      message: [times.bytes, "bytes"],
      model: [bytes, "bytes"],
    });
  }
  const middle = Object.entries(steps[0]).map(([name, [, unit]]) => [name, [median(steps.map((step) => step[name][0])), unit]]);
  print(`${what}, medians of ${steps.length}`, Object.fromEntries(middle));
}

async function measurePage(page, cdp, { parts, path, opening }) {
  const { list, model } = await page.evaluate(() => window.seen);
  print("opening", { list: [list, "ms"], model: [model, "ms"], "main thread": [opening, "ms"] });
  await pause(1000);
  const [some, full] = savesOf(parts);
  const widths = (count, first) => Array.from({ length: count }, (_, number) => first + number / 10);
  await measureSaves(page, cdp, path, "a save", widths(some, 24.1).map((width) => drawing(parts, width)), 2);
  await measureSaves(page, cdp, path, "a save that changes all", widths(full, 22).map((width) => drawing(parts, width, true)), 2 + some);
  await page.focus("canvas");
  await page.evaluate(() => (window.seen.draws = 0));
  const frames = () => page.getAttribute("canvas", "data-frames").then(Number);
  const before = await frames();
  const turning = await mainThread(cdp, async () => {
    for (let turn = 0; turn < TURNS; turn++) {
      await page.keyboard.press("ArrowLeft");
      await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
    }
  });
  const count = (await frames()) - before;
  await page.keyboard.press("t");
  const times = await page.evaluate(fold, FOLDS);
  const click = await mainThread(cdp, async () => {
    await page.locator(".tree-item").nth(2).click();
    await page.waitForFunction(() => document.querySelector("canvas").dataset.selected !== "");
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  });
  print("the list", { "opening, least": [Math.min(...times), "ms"], median: [median(times), "ms"], "a click, main thread": [click, "ms"] });
  print("turning, a frame", { "main thread": [turning / count, "ms"], "draw calls": [(await page.evaluate(() => window.seen.draws)) / count, ""] });
}

for (const parts of process.argv.length > 2 ? process.argv.slice(2).map(Number) : [100, 1000, 10_000]) await measure(parts);
