// Tests the panel that shows the model beside the text. The panel stays open from step to step.

import assert from "node:assert/strict";
import { existsSync, readFileSync, rmSync } from "node:fs";
import { place } from "./steps.mjs";

/** Colours of the figure's parts, by comparing red, green and blue, which lights and shadows do not change. */
const RED = { name: "red", is: (r, g, b) => r > 90 && r > 1.6 * g && r > 1.6 * b };
const TEAL = { name: "teal", is: (r, g, b) => g > 50 && g > 1.5 * r && b > 1.4 * r && b < 1.15 * g };
const BLUE = { name: "blue", is: (r, g, b) => b > 60 && b > 1.4 * r && b > 1.15 * g };

/** How long the editor takes to store its open tabs, in milliseconds. */
const STORING = 8000;

/** The panel in the second column. */
export class Panel {
  constructor(editor, page) {
    this.editor = editor;
    this.page = page;
  }

  get frame() {
    return this.page.frameLocator("iframe.webview").frameLocator("iframe#active-frame");
  }

  get canvas() {
    return this.frame.locator(".viewport canvas");
  }

  /** The state that the page stores at its canvas: the build shown, and what is highlighted and selected. */
  async says(name) {
    return this.canvas.getAttribute(`data-${name}`, { timeout: 1000 }).catch(() => null);
  }

  /** Waits until a model is shown. */
  async shows() {
    await this.editor.until("a model in the panel", async () => (await this.says("revision")) !== null);
  }

  /** A screenshot of the model: width, height, and RGBA pixels. */
  async picture() {
    // Of the screen, not of the canvas, so that overlays count.
    const taken = await this.canvas.screenshot();
    const seen = await this.page.evaluate(async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (one) => one.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      return { width: image.width, height: image.height, data: [...context.getImageData(0, 0, image.width, image.height).data] };
    }, taken.toString("base64"));
    return seen;
  }

  /** The number of pixels of a colour, and their centre. */
  async find({ is }) {
    const { width, data } = await this.picture();
    let [count, x, y] = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      if (!is(data[at], data[at + 1], data[at + 2])) continue;
      count += 1;
      x += (at / 4) % width;
      y += Math.floor(at / 4 / width);
    }
    return { count, x: x / count, y: y / count };
  }
}

/** The number of pixels in which two pictures clearly differ. */
function changes(before, after) {
  assert.deepEqual([before.width, before.height], [after.width, after.height]);
  let count = 0;
  for (let at = 0; at < before.data.length; at += 4) {
    const differs = (channel) => Math.abs(before.data[at + channel] - after.data[at + channel]) > 12;
    if (differs(0) || differs(1) || differs(2)) count += 1;
  }
  return count;
}

export async function previews({ editor, page, panel, step, again, at, saved, figure, read, open, shot, manual, reload, configure, program, WRONG }) {
  const inText = () => page.evaluate(() => document.activeElement?.closest(".editor-instance .monaco-editor") !== null);
  /** Moves the cursor away from all parts, so that none is highlighted. */
  const rest = async () => {
    await editor.caret({ line: 1, column: 1 });
    await editor.until("no part to be lit", async () => (await panel.says("lit")) === "");
  };
  /** A screenshot without movement or highlights. */
  const still = async () => {
    await page.mouse.move(5, 5);
    let picture;
    await editor.steady("the picture", async () => {
      const next = await panel.picture();
      if (picture === undefined || picture.width !== next.width || picture.height !== next.height || changes(picture, next) > 0) picture = next;
      return picture;
    });
    return picture;
  };
  /** Starts with the fixed drawing and its panel beside it: as the previous step left them, or in a new window. */
  const begin = async () => {
    const text = (await editor.lines()).join("\n");
    if ((await panel.says("revision")) !== null && text.includes("Head@Body$Shape round") && text.includes("#d9534f<") && text.includes("Arm@Body$")) {
      await editor.press("Control+1");
      if (await inText()) return rest();
    }
    await again();
    await at(WRONG, 14);
    await editor.type("e");
    await editor.press("Control+k");
    await editor.press("v");
    await panel.shows();
    await rest();
  };

  /** Saves the fixed drawing. */
  const keep = async () => {
    await saved("the drawing to be saved", (text) => text.includes("Head@Body$Shape round"));
    await page.locator(".tab.dirty").waitFor({ state: "detached" });
  };

  /** Changes the body's colour in the text, and waits until the model shows it. */
  const makeTeal = async () => {
    await at("Color #d9534f", 7);
    await editor.press("Shift+ArrowRight");
    await editor.press("Shift+ArrowRight");
    await editor.type("19");
    await rest();
    await editor.until("a teal body", async () => (await panel.find(TEAL)).count > 300);
  };
  await step("the lens opens a panel beside the text, which shows the model", async () => {
    await again();
    await at(WRONG, 14);
    await editor.type("e");
    await (await editor.see(".codelens-decoration a", "Preview in 3D")).click();
    await panel.shows();
    const [text, beside] = [await page.locator(".editor-instance .monaco-editor").boundingBox(), await panel.canvas.boundingBox()];
    assert.ok(beside.x >= text.x + text.width, `text at ${text.x}, panel at ${beside.x}`);
    assert.ok(await inText(), "the text keeps the keyboard");
    await rest();
    await still();
    for (const colour of [RED, BLUE]) {
      const { count } = await panel.find(colour);
      assert.ok(count > 300, `${count} ${colour.name} pixels`);
    }
    await shot("preview");
  });
  await step("the button and the key show the panel that is there", async () => {
    await editor.press("Control+1");
    await (await editor.see(".editor-actions .action-label[aria-label^='Preview in 3D']")).click();
    await editor.press("Control+1");
    await editor.press("Control+k");
    await editor.press("v");
    await editor.stays("one panel", async () => (await page.locator(".tab", { hasText: "Preview figure.svg" }).count()) === 1);
  });
  await step("a key in the text changes the picture", async () => {
    await begin();
    await still();
    const before = await panel.find(RED);
    await makeTeal();
    const after = await panel.find(RED);
    assert.ok(after.count < before.count / 5, `${before.count} red pixels before, ${after.count} after`);
    await shot("preview-key");
    await editor.press("Control+z");
    await rest();
    await editor.until("a red body", async () => (await panel.find(RED)).count > before.count / 2);
  });
  await step("the cursor in a string lights its part up", async () => {
    await begin();
    const before = await still();
    await at("Arm@Body", 2);
    await editor.until("the arm to be lit", async () => (await panel.says("lit")) === "Arm");
    const lit = changes(before, await still());
    assert.ok(lit > 150, `${lit} pixels changed`);
    assert.equal(changes(await still(), await still()), 0);
    await shot("preview-lit");
    await rest();
    assert.equal(changes(before, await still()), 0);
  });
  await step("a click on a part selects its string, and the panel keeps its place and the keyboard", async () => {
    await begin();
    await still();
    const { x, y } = await panel.find(BLUE);
    await panel.canvas.click({ position: { x, y } });
    await editor.until("the leg to be selected", async () => (await panel.says("selected")) === "Leg");
    await editor.see(".editor-instance .selected-text");
    assert.ok(!(await inText()), "the panel keeps the keyboard");
    assert.ok(await panel.canvas.isVisible());
    await editor.until("the leg to be lit", async () => (await panel.says("lit")) === "Leg");
    await shot("preview-pick");
    await editor.press("Control+1");
    const string = "Leg@Body$Shape   roundv   -7 7";
    const { line, column } = place(figure.replace(WRONG, "Head@Body$Shape round"), string);
    const said = await (await editor.see(".statusbar-item", "selected)")).textContent();
    const [, ...numbers] = /Ln (\d+), Col (\d+) \((\d+) selected\)/.exec(said).map(Number);
    // Its name, or the whole string.
    assert.deepEqual([numbers[0], numbers[1] - numbers[2]], [line, column], said);
  });
  await step("an error is shown over the last good model, and leads to its place", async () => {
    await begin();
    await at("Arm@Body", 8);
    await editor.type("x");
    const finding = panel.frame.locator(".finding-main, .findings-head").first();
    await finding.waitFor();
    await rest();
    await still();
    assert.ok((await panel.find(RED)).count > 300);
    if ((await panel.frame.locator(".finding-main").count()) === 0) await finding.click();
    await shot("preview-error");
    await panel.frame.locator(".finding-main").first().click();
    const { line } = place(figure, "Arm@Body");
    await editor.see(".statusbar-item", `Ln ${line}, Col`);
    assert.ok(await inText(), "the text has the keyboard");
    await editor.press("End");
    await editor.press("Control+z");
  });
  await step("a text that is closed is followed on", async () => {
    await begin();
    await keep();
    await editor.press("Control+1");
    await editor.press("Control+w");
    await page.locator(".editor-instance .monaco-editor").waitFor({ state: "detached" });
    await panel.shows();
    await editor.stays("the model in the panel", async () => (await panel.says("revision")) !== null);
    await still();
    const { x, y } = await panel.find(BLUE);
    // The text appears in its own column, not over the panel.
    await panel.canvas.click({ position: { x, y } });
    await editor.see(".editor-instance .selected-text");
    assert.ok(await panel.canvas.isVisible());
  });
  await step("the panel is back in a window that was loaded anew", async () => {
    await editor.until("the panel", async () => {
      await begin();
      await keep();
      // The editor stores its open tabs every five seconds, which nothing shows.
      await page.waitForTimeout(STORING);
      await reload();
      const back = page.locator("iframe.webview").first().waitFor({ timeout: 10_000 });
      return back.then(() => true, () => false);
    });
    await panel.shows();
    await still();
    assert.ok((await panel.find(RED)).count > 300);
  });
  await step("while the server is away the panel keeps its model and says so, and the next server is asked anew", async () => {
    await begin();
    // The first start takes longer.
    const wrapped = program("okoshi-slow", 'if [ "$1" = lsp ]; then [ -e "$0.again" ] && sleep 6; touch "$0.again"; fi\nexec OKOSHI "$@"');
    rmSync(`${wrapped}.again`, { force: true });
    configure({}, wrapped);
    const started = () => existsSync(`${wrapped}.again`) && Number(readFileSync(`${wrapped}.pid`, "utf8"));
    await editor.until("the slow server", started);
    const link = () => panel.frame.locator(".bar").getAttribute("data-link");
    await editor.until("its news", async () => (await editor.steady("the link", link, 10)) === "open");
    process.kill(started(), "SIGKILL");
    await editor.until("the panel to say so", async () => (await link()) !== "open");
    assert.match(await panel.frame.locator(".bar-link").textContent(), /Starting okoshi|not running/);
    await shot("preview-away");
    assert.ok((await panel.find(RED)).count > 300);
    await editor.until("the next server's news", async () => (await link()) === "open");
    assert.deepEqual(await editor.messages(), []);
    await makeTeal();
    await editor.press("Control+z");
    configure({});
  });
  await step("the page follows the editor's theme", async () => {
    await begin();
    const background = () => panel.frame.locator("body").evaluate((body) => getComputedStyle(body).backgroundColor);
    const light = await background();
    const seen = new Set([light]);
    let last = light;
    for (const theme of ["Default Dark Modern", "Default High Contrast", "Default High Contrast Light"]) {
      configure({ "workbench.colorTheme": theme });
      await editor.until(`the colours of ${theme}`, async () => (await background()) !== last);
      last = await editor.steady("the background", background);
      await shot(`preview-${theme.toLowerCase().replaceAll(" ", "-")}`);
      seen.add(last);
    }
    configure({});
    await editor.until("the light theme again", async () => (await background()) === light);
    // White in both light themes.
    assert.equal(seen.size, 3, [...seen].join("; "));
  });
  await step("a starter drawing shows its model, the picture of the manual", async () => {
    await editor.press("Control+s");
    await open("girl.svg");
    await editor.see(".codelens-decoration a", "Preview in 3D");
    await editor.press("Control+b");
    await editor.press("Control+k");
    await editor.press("v");
    await panel.shows();
    await at("Rarm@Dress", 2, read("girl.svg"));
    await editor.until("the arm to be lit", async () => (await panel.says("lit")) === "Rarm");
    await still();
    await manual("vscode-preview");
    await editor.press("Control+1");
    await editor.press("Control+b");
  });
  await step("fault, hover, outline, problems and model stand side by side", async () => {
    await page.setViewportSize({ width: 1500, height: 900 });
    await begin();
    // After undo the error is back; the model is the last good one.
    await editor.press("Control+1");
    await at(WRONG, 15);
    await editor.press("Backspace");
    await editor.see(".squiggly-error");
    await editor.command("Explorer: Focus on Outline View");
    await editor.see(".outline-tree .monaco-list-row", "Leg");
    await editor.command("Problems: Focus on Problems View");
    await editor.see(".markers-panel .monaco-list-row", "E101");
    await editor.press("Control+1");
    await editor.until("the text to have the keyboard", inText);
    await at("Arm@Body", 1);
    await editor.press("Control+k");
    await editor.press("Control+i");
    await editor.see(".monaco-hover-content li", "Shape roundv");
    const hover = page.locator(".monaco-hover:visible").first();
    await editor.until("the hover to be fully visible", () => hover.evaluate((shown) => getComputedStyle(shown).opacity === "1"));
    await manual("vscode");
    await page.setViewportSize({ width: 1280, height: 800 });
  });
}
