// The browser, and queries of the page for tests. It is Chromium, or with `BROWSER=firefox` Firefox as its users have it.

import { accessSync, constants, copyFileSync, mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { chromium, firefox, type Browser, type BrowserContext, type BrowserContextOptions, type Locator, type Page } from "playwright-core";
import { PNG } from "pngjs";
import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { LAUNCH_LIMIT, PATIENCE, type Close } from "./closing";

const executable = (path: string): boolean => {
  try {
    accessSync(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
};

const first = (...paths: readonly (string | undefined)[]): string | undefined => paths.find((path) => path !== undefined && executable(path));
export const isFirefox = process.env["BROWSER"] === "firefox";
const PROGRAM = isFirefox ? first(process.env["FIREFOX"], "/usr/bin/firefox-esr", "/usr/bin/firefox") : first(process.env["CHROMIUM"], "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome");
/** Why there is no browser; `false` if there is one. */
export const noBrowser = PROGRAM !== undefined ? false : isFirefox ? "there is no Firefox; FIREFOX names one" : "there is no Chromium; CHROMIUM names one";
export const OUT = process.env["OKOSHI_OUT"] ?? join("test", "out");
/** What the browser's user wants of motion. */
export type Motion = NonNullable<BrowserContextOptions["reducedMotion"]>;
/** The page that was bundled for the tests. */
export const DIST = join(OUT, "dist");

/** Starts the browser, with more arguments for Chromium. Firefox's driver cannot ask for less motion page by page. */
export async function launch(more: readonly string[] = [], motion: Motion = "reduce"): Promise<Browser> {
  mkdirSync(OUT, { recursive: true });
  if (PROGRAM === undefined) throw new Error(String(noBrowser));
  const options = { executablePath: PROGRAM, timeout: LAUNCH_LIMIT };
  if (isFirefox) {
    // Without a window it has no WebGL, which may be software. The list of downloads would take the focus.
    return firefox.launch({ ...options, channel: "moz-firefox", headless: false, firefoxUserPrefs: { "webgl.force-enabled": true, "ui.prefersReducedMotion": motion === "reduce" ? 1 : 0, "browser.download.alwaysOpenPanel": false } });
  }
  // WebGL is drawn by the processor here; the page around it is then put together faster without its detour.
  return chromium.launch({ ...options, args: ["--no-sandbox", "--disable-gpu-compositing", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", ...more] });
}

/** How a page is opened. */
export interface PageOptions extends BrowserContextOptions {
  /** Smooths edges once the picture is still, which takes a third of the processor's time of a test: by default edges stay as they are first drawn. */
  readonly smoothEdges?: boolean;
}

/** Opens a page, and registers its closing; errors, including violations of its policy, fail the test through `wrong`. */
export async function open(browser: Browser, address: string, onClose: (close: Close) => void, { smoothEdges = false, ...options }: PageOptions = {}, prepare: (context: BrowserContext) => Promise<void> = async () => {}): Promise<{ page: Page; wrong: string[] }> {
  const context = await browser.newContext({ viewport: { width: 1200, height: 800 }, reducedMotion: "reduce", ...options });
  onClose(() => context.close());
  context.setDefaultTimeout(PATIENCE);
  // The page does not smooth edges where it cannot learn when a picture is drawn.
  if (!smoothEdges) await context.addInitScript(() => (WebGL2RenderingContext.prototype.fenceSync = () => null));
  await prepare(context);
  const page = await context.newPage();
  const wrong: string[] = [];
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("console", (message) => {
    if (message.type() !== "error" && message.type() !== "warning") return;
    // Performance warnings of the software renderer, and the browser's messages about a host that is away.
    if (/GPU stall|KHR_parallel_shader_compile|WebGL warning|GL Driver Message|WebSocket connection to|net::ERR_CONNECTION/.test(message.text())) return;
    wrong.push(message.text());
  });
  await page.goto(address);
  return { page, wrong };
}

/** Waits until the model of this build, or of any, is shown. */
export async function shown(page: Page, revision?: number): Promise<void> {
  await page.waitForSelector(revision === undefined ? ".studio canvas[data-revision]" : `.studio canvas[data-revision="${revision}"]`, { state: "attached" });
  await still(page);
}

/** Waits until no more frames are drawn. */
export async function still(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const canvas = document.querySelector("canvas")!;
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    for (let last = ""; last !== (canvas.dataset["frames"] ?? "-") || canvas.dataset["shadows"] === "late"; ) {
      last = canvas.dataset["frames"] ?? "-";
      for (let n = 0; n < 6; n++) await frame();
    }
  });
}

/** Waits until the browser has made some frames: what the page does before a frame, or when sizes change, is done then. */
export async function pass(page: Page, frames = 2): Promise<void> {
  await page.evaluate(async (frames) => {
    for (let n = 0; n < frames; n++) await new Promise((resolve) => requestAnimationFrame(resolve));
  }, frames);
}

/** Counts the rows of the list of parts that are made from now on; what it returns tells their number. */
export async function countRows(page: Page): Promise<() => Promise<number>> {
  const counter = await page.evaluateHandle(() => {
    const counter = { rows: 0 };
    const count = ({ addedNodes }: MutationRecord): void => {
      for (const node of addedNodes) if (node instanceof Element && node.matches(".tree-item")) counter.rows++;
    };
    new MutationObserver((records) => records.forEach(count)).observe(document.querySelector(".tree")!, { childList: true, subtree: true });
    return counter;
  });
  return async () => {
    await pass(page);
    return counter.evaluate(({ rows }) => rows);
  };
}

/** Replaces the text of a field by keys. What Firefox is given otherwise it does not take for a change by a person. */
export async function type(field: Locator, text: string): Promise<void> {
  await field.press("Control+a");
  if (text === "") await field.press("Delete");
  else await field.pressSequentially(text);
}

/** Clicks twice. Firefox's driver makes no double click of two clicks. */
export async function doubleClick(page: Page, { x, y }: { x: number; y: number }): Promise<void> {
  await page.mouse.dblclick(x, y);
  if (isFirefox) await page.evaluate(([x, y]) => document.elementFromPoint(x!, y!)!.dispatchEvent(new MouseEvent("dblclick", { bubbles: true, clientX: x!, clientY: y! })), [x, y]);
}

/** Where the middle of an element is in the window. */
export async function middle(element: Locator): Promise<{ x: number; y: number }> {
  for (;;) {
    await element.waitFor({ state: "attached" });
    const box = await element.boundingBox();
    if (box) return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
    // A row of a list that was made anew before it was measured.
  }
}

/** Moves the slider of the time, whose steps are milliseconds. */
export const seekTo = (page: Page, seconds: number): Promise<void> => page.locator(".slider").fill(String(Math.round(seconds * 1e3) / 1e3));

/** Resizes the window, and waits until the page is laid out for it. */
export async function resize(page: Page, width: number, height: number): Promise<void> {
  await page.setViewportSize({ width, height });
  await page.waitForFunction((width) => document.documentElement.clientWidth === width, width);
  await pass(page);
}

/** The state of the camera, as the page reports it. */
export const camera = async (page: Page): Promise<string> => (await page.getAttribute("canvas", "data-view")) ?? "";

/** The position in the window of a point of the model. */
export async function project(page: Page, x: number, y: number, z: number): Promise<{ x: number; y: number }> {
  const words = (await camera(page)).split(" ");
  const [tx, ty, tz, px, py, pz, height] = words.map(Number) as [number, number, number, number, number, number, number];
  const box = (await page.locator("canvas").boundingBox())!;
  const aspect = box.width / box.height;
  const half = height / 2;
  const eye = words.at(-1) === "parallel" ? new OrthographicCamera(-half * aspect, half * aspect, half, -half, -1000, 1000) : new PerspectiveCamera((Math.atan(half / Math.hypot(px - tx, py - ty, pz - tz)) * 360) / Math.PI, aspect);
  eye.position.set(px, py, pz);
  eye.lookAt(tx, ty, tz);
  eye.updateMatrixWorld();
  const at = new Vector3(x, y, z).project(eye);
  return { x: box.x + ((at.x + 1) / 2) * box.width, y: box.y + ((1 - at.y) / 2) * box.height };
}

export type Colour = readonly [number, number, number];

/** A screenshot of the window. */
export async function picture(page: Page, name?: string): Promise<{ at(place: { x: number; y: number }): Colour; width: number; height: number; data: Buffer }> {
  const png = PNG.sync.read(await page.screenshot(name ? { path: join(OUT, `${name}.png`) } : {}));
  const scale = png.width / page.viewportSize()!.width;
  return {
    width: png.width,
    height: png.height,
    data: png.data,
    at: ({ x, y }) => {
      const start = (Math.round(y * scale) * png.width + Math.round(x * scale)) * 4;
      return [png.data[start]!, png.data[start + 1]!, png.data[start + 2]!];
    },
  };
}

/** Takes a picture of the manual, which `tests/all.sh` compares with the one in `docs`; `OKOSHI_REWRITE=pictures` replaces that. */
export async function manual(shown: Page | Locator, path: string): Promise<void> {
  const file = join(OUT, "manual", path);
  const page = "page" in shown ? shown.page() : shown;
  // How long a build takes on this machine says nothing.
  await page.locator(".bar-time").evaluateAll((times) => times.forEach((time) => ((time as HTMLElement).style.display = "none")));
  await shown.screenshot({ path: file });
  if (process.env["OKOSHI_REWRITE"]?.split(",").includes("pictures")) {
    const kept = join("..", "..", "docs", path);
    mkdirSync(dirname(kept), { recursive: true });
    copyFileSync(file, kept);
  }
}

/** The elements that overlap or extend beyond the window. */
export const overlaps = (page: Page) =>
  page.evaluate(() => {
    const seen = [...document.querySelectorAll<HTMLElement>(".bar > *, .toolbar button, .findings, .side, .bendbar > *, .clips > :not(.transport, .clip-looks, .clip-names), .clip-names > *, .transport > *, .clip-looks > *, .chart, .performance, .posebar")].filter((one) => one.offsetParent !== null && one.getBoundingClientRect().width > 0);
    const wrong: string[] = [];
    const say = (one: Element) => one.getAttribute("aria-label") ?? one.textContent?.trim().slice(0, 20) ?? one.className;
    seen.forEach((a, at) => {
      const own = a.getBoundingClientRect();
      if (own.left < -0.5 || own.right > innerWidth + 0.5 || own.top < -0.5 || own.bottom > innerHeight + 0.5) wrong.push(`${say(a)} reaches out of the window`);
      for (const b of seen.slice(at + 1)) {
        const other = b.getBoundingClientRect();
        if (own.left < other.right - 0.5 && other.left < own.right - 0.5 && own.top < other.bottom - 0.5 && other.top < own.bottom - 0.5) wrong.push(`${say(a)} and ${say(b)}`);
      }
    });
    return wrong;
  });
