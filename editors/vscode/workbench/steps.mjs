// Tests the language server in the workbench. Each step starts with the drawing of figure.svg.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { edits } from "./editing.mjs";
import { neighbours } from "./neighbour.mjs";
import { Panel, previews } from "./preview.mjs";

/** Line and column, from 1, of the `at`th character of the first occurrence of a text. */
export function place(text, wanted, at = 0) {
  const offset = text.indexOf(wanted);
  assert.ok(offset >= 0, `the drawing has ${wanted}`);
  const before = text.slice(0, offset + at).split("\n");
  return { line: before.length, column: before.at(-1).length + 1 };
}

const WRONG = "Head@Body$Shap round";

export async function withServer({ editor, page, step, ready, configure, program, read, reset, open, reload, shot, manual, okoshi, project, room }) {
  const figure = read();
  const panel = new Panel(editor, page);
  const at = (wanted, offset, text = figure) => editor.caret(place(text, wanted, offset));
  /** The saved drawing, once it is as wanted. */
  const saved = (what, good) =>
    editor.until(what, async () => {
      if ((await page.locator(".tab.active.dirty").count()) > 0) await editor.press("Control+s");
      return good(read());
    });
  /** Starts over: the original drawing in a new window, with its errors found. */
  const again = async () => {
    // Saved first: the next window would restore unsaved changes.
    if ((await page.locator(".tab.dirty").count()) > 0) {
      await editor.press("Control+1");
      await editor.press("Control+s");
      await page.locator(".tab.dirty").first().waitFor({ state: "detached" });
    }
    reset();
    await open("figure.svg");
    await editor.see(".squiggly-error");
  };

  const string = "Arm@Body$Shape roundv";
  const unread = await editor.until("a kind coloured by the grammar", () => editor.colour("roundv", string));
  await ready();
  await step("the setting's program is started, errors are underlined", async () => {
    await editor.see(".squiggly-error");
  });
  await step("what stands in strings is coloured by what it means", async () => {
    let kind;
    await editor.until("a kind in another colour than the grammar's", async () => {
      kind = await editor.colour("roundv", string);
      return kind && kind !== unread;
    });
    const plain = await editor.colour("=", 'id="leg"');
    const colours = [await editor.colour("Arm", string), await editor.colour("Shape", string), kind, plain];
    assert.equal(new Set(colours).size, colours.length, `part, keyword, kind and plain text: ${colours.join("; ")}`);
    assert.equal(await editor.colour("text x", string), await editor.colour("rect id", 'id="leg"'));
  });
  await step("the status item counts", async () => {
    await (await editor.see('.statusbar-item[id="status.languageStatus"]')).hover();
    await editor.see(".hover-language-status", "1 error");
  });
  await step("a hover tells of a part", async () => {
    await at("Arm@Body", 1);
    const hover = await editor.hover("Root › Body › Arm");
    const path = await hover.textContent();
    assert.match(path, /Root › Body › Arm/);
    const listed = await hover.locator("li").allTextContents();
    for (const one of ["Shape roundv, from its own string", "Origin start, from its own string"]) {
      assert.ok(listed.includes(one), `${one}: ${listed.join("; ")}`);
    }
  });
  await step("a hover tells of a keyword", async () => {
    await at("Origin start", 2);
    const hover = await editor.hover("Origin");
    // A bold line in place of a heading.
    assert.equal(await hover.locator("strong", { hasText: /^Origin$/ }).count(), 1);
    assert.equal(await hover.locator("h1, h2, h3").count(), 0);
  });
  await step("a hover tells the way out of an error", async () => {
    await at(WRONG, 11);
    const hover = await editor.hover("E101: unknown keyword");
    assert.match(await hover.textContent(), /The marked word is not a keyword\..*Correct the keyword/s);
  });
  await step("problems are listed", async () => {
    await editor.press("Escape");
    await editor.command("Problems: Focus on Problems View");
    await editor.see(".markers-panel .monaco-list-row", "Shap");
    await editor.see(".markers-panel .monaco-list-row", "E101");
  });
  await step("the outline is the figure's hierarchy", async () => {
    await editor.command("View: Toggle Panel Visibility");
    await editor.command("Explorer: Focus on Outline View");
    for (const [name, level] of [["Body", 1], ["Arm", 2], ["Head", 2], ["Leg", 2]]) {
      const row = await editor.see(".outline-tree .monaco-list-row", name);
      assert.equal(await row.getAttribute("aria-level"), String(level), name);
    }
  });
  await step("colours have swatches", async () => {
    await editor.command("View: Focus Active Editor Group").catch(() => {});
    await editor.until("a swatch in the string", () =>
      page.evaluate(() => [...document.querySelectorAll(".view-line")].some((line) => line.textContent.includes("Color") && line.querySelector(".colorpicker-color-decoration"))),
    );
  });
  await shot("at-work");
  await step("inlay hints say what is inherited or automatic", async () => {
    await open("hints.svg");
    // Inlay hints at the expected places, and nowhere else.
    const hints = [
      ["<circle", "hand@Arm"],
      [">Body", "Segments 8 Smooth 10"],
      ["Arm@Body$Shape roundv", "Offset 4 Segments 8 Smooth 10"],
    ];
    const shown = hints.reduce((text, [behind, hint]) => text.replace(behind, () => behind + hint), read("hints.svg"));
    let seen;
    await editor
      .until("the hints", async () => (seen = (await editor.lines()).join("\n").trim()) === shown.trim())
      .catch(() => assert.equal(seen, shown.trim()));
  });
  await step("a fix is applied", async () => {
    await again();
    await at(WRONG, 11);
    await editor.press("Control+.");
    await (await editor.see(".action-widget .monaco-list-row, .context-view .monaco-list-row", "Shape")).click();
    await saved("the keyword to be mended", (text) => text.includes("Head@Body$Shape round"));
    await editor.gone(".squiggly-error");
  });
  await step("a completion is accepted", async () => {
    await again();
    await at("Origin start", 12);
    await editor.type(" Seg");
    const row = await editor.proposal("Segments");
    await shot("completion");
    await row.waitFor();
    await editor.press("Enter");
    await saved("the keyword to be written", (text) => /Origin start Segments/.test(text));
  });
  await step("kinds of shapes come with their parameters", async () => {
    await again();
    await at("Head@Body$Shap", 14);
    await editor.type("e con");
    await editor.proposal("conev");
    await editor.press("Escape");
  });
  await step("a part is renamed everywhere", async () => {
    await again();
    await at("Body$Shape default", 1);
    await editor.press("F2");
    const input = await editor.see(".rename-box input");
    await input.fill("Trunk");
    await editor.press("Enter");
    await saved("four strings to change", (text) => text.split("Trunk").length === 5 && !text.includes("Body"));
  });
  await step("a definition is gone to", async () => {
    await again();
    await at("Arm@Body", 5);
    await editor.press("F12");
    const { line } = place(figure, "Body$Shape default");
    await editor.see(".statusbar-item", `Ln ${line}, Col`);
  });
  await step("strings are formatted, and nothing else", async () => {
    await again();
    await editor.command("Format Document");
    await saved("the blanks to go", (text) => text.includes("Leg@Body$Shape roundv -7 7"));
    const rest = (text) => text.split("\n").filter((line) => !line.includes("Leg@")).join("\n");
    assert.equal(rest(read()), rest(figure));
  });
  await neighbours({ editor, page, step, again, at, saved, read, open, configure });
  await step("errors come and go while typing", async () => {
    await again();
    await at("Arm@Body", 8);
    await editor.type("x");
    await editor.until("two errors", async () => (await page.locator(".squiggly-error").count()) >= 2);
    await editor.press("Backspace");
    await editor.until("one error", async () => (await page.locator(".squiggly-error").count()) === 1);
  });
  await step("a snippet is inserted", async () => {
    await again();
    await at("<text x=\"10\"", 0);
    await editor.type("okoshi-def");
    // Emmet, which accepts any word as a tag, comes first.
    await (await editor.proposal("okoshi-defaults")).click();
    await editor.press("Escape");
    await saved("a text for all parts", (text) => text.includes(">%Shape default -20 20 Scale 1.0</text>"));
  });
  await previews({ editor, page, panel, step, again, at, saved, figure, read, open, shot, manual, reload, configure, program, WRONG });
  await edits({ editor, page, panel, step, open, read, configure, okoshi, project, room, manual });
  await step("on demand, drawings are checked when they are saved", async () => {
    await again();
    configure({ "okoshi.analyse": "onSave", "editor.renderFinalNewline": "off" });
    // Line numbers change once the settings are read, which is when the server gets them.
    const numbers = page.locator(".editor-instance .line-numbers");
    const last = String(figure.split("\n").length);
    await editor.until("the settings to be read", async () => !(await numbers.allTextContents()).includes(last));
    const errors = () => page.locator(".squiggly-error").count();
    await editor.until("what is typed to be left unchecked", async () => {
      await at("Arm@Body", 8);
      await editor.type("x");
      if (await editor.holds(async () => (await errors()) === 1)) return true;
      // The server does not have the settings yet.
      await editor.press("Backspace");
      await editor.until("one error", async () => (await errors()) === 1);
      return false;
    });
    await editor.press("Control+s");
    await editor.until("two errors", async () => (await page.locator(".squiggly-error").count()) >= 2);
    configure({});
  });
  await step("drawings without strings are left alone", async () => {
    if ((await page.locator(".tab.active.dirty").count()) > 0) await editor.save();
    await open("plain.svg");
    const marks = ".codelens-decoration a, .squiggly-error, .squiggly-warning, .squiggly-info, .squiggly-hint";
    await editor.stays("no marks", async () => (await page.locator(marks).count()) === 0);
    await editor.said(0);
  });
  await step("the server is started anew", async () => {
    reset();
    await open("figure.svg");
    await editor.see(".squiggly-error");
    await editor.command("Okoshi: Restart the Language Server");
    await editor.said(0);
    await editor.see(".squiggly-error");
  });
  await step("a server that ends is started again", async () => {
    const wrapped = program("okoshi-wrapped", 'exec OKOSHI "$@"');
    configure({}, wrapped);
    const pid = () => Number(readFileSync(`${wrapped}.pid`, "utf8"));
    const serving = () => editor.until("a server", () => {
      try {
        return readFileSync(`/proc/${pid()}/cmdline`, "utf8").includes("lsp") && pid();
      } catch {
        return false;
      }
    });
    const first = await serving();
    await editor.stays("the server", () => pid() === first);
    process.kill(first, "SIGKILL");
    await editor.until("another server", async () => (await serving()) !== first);
    await editor.see(".squiggly-error");
    assert.deepEqual(await editor.messages(), []);
  });
  await step("another program is not taken for okoshi", async () => {
    configure({}, program("not-okoshi", "echo cargo 1.90.0"));
    await editor.see(".notifications-toasts", "is not okoshi");
    await editor.stays("one message", async () => (await editor.messages()).filter((one) => one.includes("is not okoshi")).length === 1);
  });
}
