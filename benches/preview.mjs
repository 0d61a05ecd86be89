// Measures the time from a save to the new frame in the browser, step by step.
//
//   cargo build --release && npm ci --prefix editors/web && node benches/preview.mjs [PARTS…]
//
// Each drawing is saved 40 times like Inkscape does it: truncated, then written in pieces. The steps: until the watcher notices
// (event), until the file has settled, until the model is built, until the page is notified (push), until it has fetched and drawn the
// model (frame). Chromium renders in software here; a graphics card is faster.

import { spawn } from "node:child_process";
import { closeSync, mkdtempSync, openSync, rmSync, writeFileSync, writeSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const root = new URL("..", import.meta.url).pathname;
const { chromium } = createRequire(join(root, "editors/web/package.json"))("playwright-core");
const okoshi = process.env.OKOSHI ?? join(root, "target/release/okoshi");
const SAVES = 40;
/** Kinds of solids, used in turn. */
const KINDS = ["default -9 9", "roundv", "default -5 5", "round", "conev -8 8 0.5", "flat"];

/** A figure of `parts` parts; the width of the first one changes. */
function drawing(parts, width) {
  const side = Math.ceil(Math.sqrt(parts));
  const shapes = [];
  for (let index = 0; index < parts; index++) {
    const [x, y] = [40 * (index % side), 40 * Math.floor(index / side)];
    const wide = index === 0 ? width : 24;
    const shape = index % 2 === 0
      ? `<rect x="${x}" y="${y}" width="${wide}" height="20" fill="#c83737"/>`
      : `<ellipse cx="${x + 15}" cy="${y + 12}" rx="14" ry="9" fill="#2a7fff"/>`;
    shapes.push(shape, `<text x="${x + 12}" y="${y + 10}" font-size="3">P${index}${index > 0 ? "@P0" : ""}$Shape ${KINDS[index % KINDS.length]}</text>`);
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${40 * side}" height="${40 * side}">\n${shapes.join("\n")}\n</svg>\n`;
}

function save(path, text) {
  const file = openSync(path, "w");
  for (let at = 0; at < text.length; at += 4096) writeSync(file, text.slice(at, at + 4096));
  closeSync(file);
}

// The system clock, which the program and the page use too.
const now = () => Date.now();
const median = (numbers) => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

async function measure(parts) {
  const folder = mkdtempSync(join(tmpdir(), "okoshi-bench-"));
  const path = join(folder, "a.svg");
  save(path, drawing(parts, 24));
  const server = spawn(okoshi, ["preview", path, "--port", "4199", "-q"], { stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((found) => server.stdout.once("data", (line) => found(String(line).trim())));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run"],
  });
  const page = await browser.newPage({ viewport: { width: 640, height: 480 } });
  await page.addInitScript(() => {
    const clock = () => Date.now();
    window.builds = {};
    const Socket = window.WebSocket;
    window.WebSocket = class extends Socket {
      constructor(...rest) {
        super(...rest);
        this.addEventListener("message", ({ data }) => {
          const received = clock();
          const message = JSON.parse(data);
          if (message.type === "build") window.builds[message.build.revision] = { received, ...message.build.steps };
        });
      }
    };
  });
  await page.goto(url);
  await page.waitForSelector("canvas[data-revision='1']");
  await pause(1000);
  await page.evaluate(() => {
    const canvas = document.querySelector("canvas");
    const clock = () => Date.now();
    let [shown, frames] = [1, Number(canvas.dataset.frames)];
    new MutationObserver(() => {
      const [revision, drawn] = [Number(canvas.dataset.revision), Number(canvas.dataset.frames)];
      const times = window.builds[revision];
      if (revision !== shown && drawn > frames) {
        // Reading a pixel waits until the frame is rendered.
        const context = canvas.getContext("webgl2");
        context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
        times.drawn = clock();
        shown = revision;
      }
      frames = revision === shown ? drawn : frames;
    }).observe(canvas, { attributes: true });
  });
  const steps = [];
  for (let revision = 2; revision < SAVES + 2; revision++) {
    const text = drawing(parts, 24 + revision / 10);
    const saved = now();
    save(path, text);
    const times = await (await page.waitForFunction((revision) => window.builds[revision]?.drawn && window.builds[revision], revision)).jsonValue();
    steps.push({
      event: times.noticed - saved,
      settle: times.begun - times.noticed,
      build: times.built - times.begun,
      push: times.received - times.built,
      frame: times.drawn - times.received,
      "in all": times.drawn - saved,
      "without build": times.drawn - saved - (times.built - times.begun),
    });
    // Until the shadow has been drawn too.
    await pause(800);
  }
  await browser.close();
  server.kill();
  rmSync(folder, { recursive: true });
  const row = Object.keys(steps[0]).map((name) => [name, median(steps.map((times) => times[name]))]);
  console.log(`${parts} parts, medians of ${SAVES} saves:`, row.map(([name, time]) => `${name} ${time.toFixed(1)} ms`).join(", "));
}

for (const parts of process.argv.length > 2 ? process.argv.slice(2).map(Number) : [100, 1000]) await measure(parts);
