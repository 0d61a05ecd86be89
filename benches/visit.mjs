// Measures a first visit of okoshi in the browser: nothing is in any cache, and a plain server on this machine has the folder.
//
//   bash editors/web/app.sh FOLDER && node benches/visit.mjs FOLDER [VISITS]
//
// Until the drawing and the picture of its model are there (picture), until the model is drawn (model), until the module is there (module), and until a press on
// `Change this one`, made as soon as the button is there, shows the drawing's own model (begun). Medians in milliseconds, and the CPU time of all of the browser's
// processes up to then. Chromium renders in software here; a graphics card is faster.

import { createReadStream, existsSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join } from "node:path";

const root = new URL("..", import.meta.url).pathname;
const { chromium } = createRequire(join(root, "editors/web/package.json"))("playwright-core");
const [folder, visits = "5"] = process.argv.slice(2);
if (!folder) {
  console.error("usage: node benches/visit.mjs FOLDER [VISITS]");
  process.exit(2);
}
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".png": "image/png" };
const server = createServer(({ url }, response) => {
  const path = new URL(url, "http://localhost").pathname;
  const file = join(folder, path.endsWith("/") ? `${path}index.html` : path);
  if (!existsSync(file) || !statSync(file).isFile()) return response.writeHead(404).end();
  response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" });
  createReadStream(file).pipe(response);
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const address = `http://127.0.0.1:${server.address().port}/`;

/** Runs in the page before its own script: notes when what is there, and presses the button. */
function observe() {
  const times = (globalThis.times = {});
  const note = (name, when) => {
    if (when && !(name in times)) times[name] = performance.now();
  };
  const look = () => {
    const pictures = [".welcome-drawing", ".welcome-still"].map((name) => document.querySelector(name));
    note("picture", pictures.every((one) => one?.complete && one.naturalWidth > 0));
    note("model", document.querySelector(".welcome-stage canvas[data-revision]"));
    const link = document.querySelector(".bar-link");
    note("module", link && link.hidden);
    const change = document.querySelector(".welcome-change");
    if (!("pressed" in times) && change?.offsetParent && globalThis.presses) {
      note("pressed", true);
      change.click();
    }
    note("begun", document.querySelector(".studio canvas[data-revision]"));
    requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

/** Opens the page in a browser of its own, until it has what is waited for. */
async function visit(presses) {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  try {
    const context = await browser.newContext({ viewport: { width: 1200, height: 800 } });
    await context.addInitScript(`globalThis.presses = ${presses}; (${observe})()`);
    const page = await context.newPage();
    await page.goto("about:blank");
    const session = await browser.newBrowserCDPSession();
    const cpu = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
    const before = await cpu();
    await page.goto(address, { waitUntil: "commit" });
    const wanted = presses ? ["begun"] : ["picture", "model", "module"];
    await page.waitForFunction((wanted) => wanted.every((name) => name in globalThis.times), wanted, { timeout: 120_000, polling: 50 });
    const spent = (await cpu()) - before;
    return { ...(await page.evaluate(() => globalThis.times)), [presses ? "CPU of begun" : "CPU"]: spent * 1000 };
  } finally {
    await browser.close();
  }
}

const median = (numbers) => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
for (const presses of [false, true]) {
  const all = [];
  for (let number = 0; number < Number(visits); number++) all.push(await visit(presses));
  for (const name of Object.keys(all[0])) console.log(`${presses ? "pressed at once: " : ""}${name}: ${median(all.map((one) => one[name])).toFixed(0)} ms`);
}
server.close();
