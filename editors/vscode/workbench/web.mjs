// Tests the package for VS Code for the Web: the extension runs in the browser, with the program as a module and without one on the machine. The folder is
// that of a code-server, whose files are read through the editor.

import assert from "node:assert/strict";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { edited } from "./editing.mjs";
import { Panel } from "./preview.mjs";
import { place } from "./steps.mjs";
import { codeServer } from "./tools.mjs";

const WRONG = "Head@Body$Shap round";
/** A colour of the figure's body. */
const RED = { is: (r, g, b) => r > 90 && r > 1.6 * g && r > 1.6 * b };

export async function inBrowser({ tools, vsix, editor, page, step, shot, manual, write, SETTINGS, okoshi, room, figure, examples }) {
  const [project, data, extensions] = ["web-project", "web-data", "web-extensions"].map((name) => join(room, name));
  for (const folder of [project, data, extensions]) rmSync(folder, { recursive: true, force: true });
  for (const folder of [project, join(data, "User")]) mkdirSync(folder, { recursive: true });
  copyFileSync(join(examples, "human.svg"), join(project, "human.svg"));
  for (const name of ["beetle.svg", "walk.bvh"]) copyFileSync(join(examples, "motion", name), join(project, name));
  writeFileSync(join(project, "figure.svg"), figure);
  write(join(data, "User", "settings.json"), SETTINGS);
  // Without any program but Node's.
  const server = await codeServer(tools, { packages: [vsix], data, extensions, env: { HOME: room, PATH: `${dirname(tools.node)}:/usr/bin:/bin` } });
  try {
    const panel = new Panel(editor, page);
    const open = async (name) => {
      const payload = encodeURIComponent(JSON.stringify([["openFile", `vscode-remote://${server.address}${join(project, name)}`]]));
      await page.goto(`http://${server.address}/?folder=${encodeURIComponent(project)}&payload=${payload}`);
      await editor.see(".editor-instance .view-line span", "svg");
      await editor.focusText();
    };
    const at = (wanted, offset, text = figure) => editor.caret(place(text, wanted, offset));

    await step("in the browser: errors are underlined without a program", async () => {
      await open("figure.svg");
      await editor.see(".squiggly-error");
      await (await editor.see('.statusbar-item[id="status.languageStatus"]')).hover();
      await editor.see(".hover-language-status", "1 error");
      await editor.said(0);
    });
    await step("in the browser: there are no commands that need the program", async () => {
      await editor.press("F1");
      await (await editor.see(".quick-input-widget input")).fill(">Okoshi");
      await editor.see(".quick-input-list .monaco-list-row", "Okoshi: Preview in 3D");
      const listed = await editor.steady("the commands", async () => (await page.locator(".quick-input-list .monaco-list-row .monaco-highlighted-label").allTextContents()).join("; "));
      assert.doesNotMatch(listed, /Build the Model|New Drawing/);
      await editor.press("Escape");
    });
    await step("in the browser: hovers tell of parts and of the way out of an error", async () => {
      await editor.focusText();
      await at("Arm@Body", 1);
      await editor.hover("Root › Body › Arm");
      await at(WRONG, 11);
      await editor.hover("E101: unknown keyword");
      await shot("web-hover");
      await editor.press("Escape");
    });
    await step("in the browser: a fix is applied", async () => {
      await at(WRONG, 11);
      await editor.press("Control+.");
      await (await editor.see(".action-widget .monaco-list-row, .context-view .monaco-list-row", "Shape")).click();
      await editor.has(figure.replace("Shap round", "Shape round"), "the keyword to be mended");
      await editor.gone(".squiggly-error");
    });
    await step("in the browser: a completion is accepted", async () => {
      await at("Origin start", 12);
      await editor.type(" Seg");
      await editor.proposal("Segments");
      await shot("web-completion");
      await editor.press("Enter");
      await editor.until("the keyword to be written", async () => /Origin start Segments/.test(await editor.text()));
      await editor.press("Control+z");
    });
    await step("in the browser: the panel shows the model of the unsaved text", async () => {
      // The next window may restore what was typed into this one. Another file has nothing to restore.
      writeFileSync(join(project, "unsaved.svg"), figure);
      await editor.save();
      await open("unsaved.svg");
      await editor.see(".squiggly-error");
      await at(WRONG, 14);
      await editor.type("e");
      await editor.press("Control+k");
      await editor.press("v");
      await panel.shows();
      await editor.until("a red body", async () => (await panel.find(RED)).count > 300);
      await at("Arm@Body", 1);
      await editor.until("the arm to be lit", async () => (await panel.says("lit")) === "Arm");
      await at("Color #d9534f", 7);
      await editor.press("Shift+ArrowRight");
      await editor.press("Shift+ArrowRight");
      await editor.type("19");
      await editor.until("a body that is not red", async () => (await panel.find(RED)).count < 50);
      await shot("web-preview");
      assert.equal(readFileSync(join(project, "unsaved.svg"), "utf8"), figure);
      await editor.save();
    });
    await step("in the browser: files that a drawing links to are read", async () => {
      await open("beetle.svg");
      await editor.see(".codelens-decoration a", "Preview in 3D");
      await editor.press("Control+k");
      await editor.press("v");
      await panel.shows();
      await editor.until("a clip", async () => (await panel.frame.locator("select option", { hasText: "walk" }).count()) > 0 || (await panel.frame.getByText("walk", { exact: true }).count()) > 0);
      assert.equal(await page.locator(".squiggly-error").count(), 0);
      await shot("web-motion");
    });
    await step("in the browser: what is edited by mouse in the model has the bytes of okoshi edit, and undo takes it back", async () => {
      await page.setViewportSize({ width: 1700, height: 900 });
      await open("human.svg");
      await editor.see(".codelens-decoration a", "Preview in 3D");
      await editor.press("Control+b");
      await editor.press("Control+k");
      await editor.press("v");
      await panel.shows();
      const { frame } = panel;
      await frame.getByRole("button", { name: "Edit" }).click();
      await frame.locator('[data-part="Rarm"]').click();
      await frame.locator('.part-form[data-form-of="Rarm"]:not([inert])[aria-busy=false]').waitFor();
      const before = readFileSync(join(project, "human.svg"), "utf8");
      const slider = frame.getByLabel("Shape: a1", { exact: true });
      await slider.scrollIntoViewIfNeeded();
      const { x, y, width, height } = await slider.boundingBox();
      await page.mouse.move(x + width / 2, y + height / 2);
      await page.mouse.down();
      await page.mouse.move(x + width / 2 - 40, y + height / 2, { steps: 6 });
      await page.mouse.up();
      const value = `roundv -90 ${await frame.getByLabel("Shape: a1, as a number", { exact: true }).inputValue()}`;
      const expected = edited(okoshi, room, before, { change: "set", part: "Rarm", attribute: "Shape", value });
      assert.notEqual(expected, before);
      await editor.has(expected, "the thickness");
      await at("Rarm@Ubody", 1, expected);
      await editor.until("the arm to be lit", async () => (await panel.says("lit")) === "Rarm");
      await manual("vscode-web");
      assert.equal(readFileSync(join(project, "human.svg"), "utf8"), before, "nothing is saved before a person saves");
      await editor.press("Control+z");
      await editor.has(before, "the thickness undone");
      await editor.press("Control+y");
      await editor.has(expected, "the thickness made again");
      await frame.getByRole("button", { name: /^Undo/ }).first().click();
      await editor.has(before, "the thickness undone in the panel");
    });
  } finally {
    server.stop();
  }
}
