// Measures how long it takes from a press, while a drawing is edited on the preview page, until the picture shows what it changes.
// benches/preview.mjs runs it.
//
// A thickness is dragged, a kind is clicked, a colour is typed and sent by Enter: from the time that the browser gives the pointer or key
// event to the moment when the first frame with the change is rendered. Steps: until the answer of the program has arrived (answer), and
// until the page has told the graphics card all of the frame (drawn); what follows is the graphics card, which is software here. "In the
// drawing" is the time until the model of the changed file is shown. A turn of the view, by key, is what a frame takes without any change.

/** How often each is pressed. */
const PRESSES = 20;
/** How long smooth edges are waited for, in milliseconds. */
const SMOOTH = 2000;
/** How far a slider is dragged in a step, in pixels. */
const DRAG = 2;
const PART = "P2";
const KINDS = ["inflate", "default"];

/** Runs in the page: notes when the picture shows what the next press changes, by its type of event, or that it turns the view. */
function next([type, turns]) {
  const canvas = document.querySelector("canvas");
  const { tried, revision } = canvas.dataset;
  const times = (window.pressed = { at: 0, answered: 0, drawn: 0, shown: 0, built: 0 });
  addEventListener(type, ({ timeStamp }) => (times.at = timeStamp), { capture: true, once: true });
  performance.clearResourceTimings();
  let frames = canvas.dataset.frames;
  let shows = false;
  const look = new MutationObserver(() => {
    const now = canvas.dataset;
    const isBuilt = now.revision !== revision;
    shows ||= turns || isBuilt || (now.tried !== "" && now.tried !== tried);
    if (shows && now.frames !== frames) {
      const first = times.drawn === 0;
      if (first) times.drawn = performance.now();
      if (isBuilt || turns) look.disconnect();
      const resources = performance.getEntriesByType("resource").filter(({ name }) => /tries$|\.glb/.test(name));
      times.answered ||= resources.at(-1)?.responseEnd ?? 0;
      const context = canvas.getContext("webgl2");
      const fence = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
      context.flush();
      const ask = () => {
        if (context.getSyncParameter(fence, context.SYNC_STATUS) !== context.SIGNALED) return setTimeout(ask, 1);
        if (first) times.shown = performance.now();
        if (isBuilt) times.built = performance.now();
      };
      ask();
    }
    frames = now.frames;
  });
  look.observe(canvas, { attributes: true });
}

const quantile = (numbers, share) => numbers.sort((a, b) => a - b)[Math.min(Math.floor(numbers.length * share), numbers.length - 1)];

/** Presses on a page. Calls `print` with lines of numbers. */
export async function presses(page, print) {
  const label = (name) => page.getByLabel(name, { exact: true });
  const formed = () => page.locator(`.part-form[data-form-of="${PART}"]:not([inert])[aria-busy=false]`).waitFor();
  const settled = async (until) => {
    if (until !== "shown") {
      await formed();
      await page.waitForFunction(() => document.querySelector("canvas").dataset.tried === "");
    }
    // Shadows and smooth edges follow; pictures that take long are not smoothed.
    await page.waitForFunction(() => document.querySelector("canvas").dataset.smooth !== "false", null, { timeout: SMOOTH }).catch(() => {});
  };
  /** Presses often. Returns the times until the picture shows the change. */
  const measure = async (what, type, press, until) => {
    const all = [];
    for (let number = 0; number < PRESSES; number++) {
      await page.evaluate(next, [type, until === "turned"]);
      await press(number);
      await page.waitForFunction((step) => window.pressed[step] > 0, until === "built" ? until : "shown");
      all.push(await page.evaluate(() => window.pressed));
      await settled(until);
    }
    const from = (step) => all.map((times) => times[step] - times.at);
    const numbers = { median: [quantile(from("shown"), 0.5), "ms"], "95 %": [quantile(from("shown"), 0.95), "ms"] };
    if (until !== "turned") numbers.answer = [quantile(from("answered"), 0.5), "ms"];
    numbers.drawn = [quantile(from("drawn"), 0.5), "ms"];
    if (until === "built") numbers["in the drawing"] = [quantile(from("built"), 0.5), "ms"];
    print(`${what}, until it is seen`, numbers);
  };
  await page.getByRole("button", { name: "Edit" }).click();
  await page.locator(`[data-part="${PART}"]`).click();
  await settled();
  await page.locator("canvas").focus();
  await measure("a turn of the view", "keydown", () => page.keyboard.press("ArrowLeft"), "turned");
  await settled();
  const slider = label("Shape: z1");
  await slider.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await slider.boundingBox();
  // To the right of the number that the drawing says, which changes nothing.
  const from = x + 0.65 * width;
  await page.mouse.move(from, y + height / 2);
  await page.mouse.down();
  await measure("a step of a slider", "pointermove", (number) => page.mouse.move(from + DRAG * (number + 1), y + height / 2), "shown");
  await page.mouse.up();
  await page.waitForFunction(() => document.querySelector("canvas").dataset.tried === "");
  await settled();
  const kinds = page.getByRole("radiogroup", { name: "Shape: which" });
  await measure("a kind", "pointerdown", (number) => kinds.getByRole("radio", { name: KINDS[number % KINDS.length], exact: true }).click(), "built");
  await measure("a colour", "keydown", async (number) => {
    const field = label("Color: as text");
    await field.fill(`#${(0x406080 + number).toString(16)}`);
    await field.press("Enter");
  }, "built");
}
