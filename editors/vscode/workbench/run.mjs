// Tests the extension in a real workbench: npm run workbench
//
// Packages the extension, installs it into code-server, opens drawings in Chromium and works like a user, checking what is visible
// after each step. Screenshots of all steps go to target/workbench/shots; OKOSHI_REWRITE=pictures also replaces those of docs/editors.
// With OKOSHI_MODULE, the folder of a built module, it also tests the package for VS Code for the Web.
// OKOSHI (default: target/debug/okoshi), NODE24, CODE_SERVER and CHROMIUM name the tools; those not named are installed into
// target/workbench, which takes minutes and 700 MB the first time. Building code-server's native modules needs libkrb5-dev.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { pack, packWeb, prepare } from "../scripts/package.mjs";
import { Editor } from "./editor.mjs";
import { withServer } from "./steps.mjs";
import { codeServer, run, tools } from "./tools.mjs";
import { inBrowser } from "./web.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const extension = join(here, "..");
const repository = join(extension, "..", "..");
const target = resolve(repository, process.env.CARGO_TARGET_DIR ?? "target");
const room = join(target, "workbench");
const okoshi = resolve(process.env.OKOSHI ?? join(target, "debug", "okoshi"));
const project = join(room, "project");
const data = join(room, "data");
const shots = join(room, "shots");

if (!existsSync(okoshi)) throw new Error(`There is no ${okoshi}: build it, or name another by OKOSHI=`);
for (const folder of [project, data, shots, join(room, "extensions")]) rmSync(folder, { recursive: true, force: true });
for (const folder of [project, join(data, "User"), join(data, "Machine"), shots]) mkdirSync(folder, { recursive: true });
for (const name of ["figure.svg", "hints.svg"]) copyFileSync(join(here, name), join(project, name));
execFileSync(okoshi, ["new", "-q", "girl", "--template", "girl"], { cwd: project });
copyFileSync(join(extension, "test", "plain.svg"), join(project, "plain.svg"));
copyFileSync(join(repository, "examples", "human.svg"), join(project, "human.svg"));

const SETTINGS = {
  // They would contain local paths.
  "breadcrumbs.enabled": false,
  "chat.disableAIFeatures": true,
  "editor.fontSize": 13,
  "editor.minimap.enabled": false,
  "editor.semanticHighlighting.enabled": false,
  "files.autoSave": "off",
  "git.enabled": false,
  // A notification of what else runs on the machine would cover the workbench.
  "remote.autoForwardPorts": false,
  "telemetry.telemetryLevel": "off",
  "window.restoreWindows": "none",
  // Newer editors open SVG files as pictures.
  "workbench.editorAssociations": { "*.svg": "default" },
  "workbench.colorTheme": "Default Light Modern",
  "workbench.secondarySideBar.defaultVisibility": "hidden",
  "workbench.startupEditor": "none",
  "workbench.tips.enabled": false,
};
/** Writes settings by rename: the editor could read a partly written file. */
const write = (file, values) => {
  writeFileSync(`${file}.new`, JSON.stringify(values, null, 2));
  renameSync(`${file}.new`, file);
};
const settings = (path, more = {}) => {
  // In a remote window machine settings apply at once, user settings only in the next window.
  write(join(data, "Machine", "settings.json"), { "okoshi.path": path, ...more });
};

write(join(data, "User", "settings.json"), SETTINGS);
prepare();
pack(join(room, "okoshi.vsix"), okoshi);
const module = process.env.OKOSHI_MODULE;
if (module) await packWeb(join(room, "okoshi-web.vsix"), resolve(module));
run(join(extension, "node_modules", ".bin", "vsce"), ["package", "--no-dependencies", "--allow-missing-repository", "--skip-license", "-o", join(room, "neighbour.vsix")], { cwd: join(here, "neighbour") });
const found = await tools(room);
settings("okoshi-that-is-not-there");
const server = await codeServer(found, { packages: ["okoshi", "neighbour"].map((name) => join(room, `${name}.vsix`)), data, extensions: join(room, "extensions"), env: { HOME: room } });
const browser = await found.chromium.launch({
  executablePath: found.browser,
  // WebGL in software, which works on every machine.
  args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});

let failed = 0;
let number = 0;
const wanted = process.env.ONLY?.split(",");
/** In the names of the steps with the package for the web. */
const IN_BROWSER = "in the browser";

// Clips do not play by themselves then, so that the model comes to rest.
const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, deviceScaleFactor: 1, reducedMotion: "reduce" });
// The whole text of a drawing is read by copying it.
await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
const editor = new Editor(page);
const shot = (name) => page.screenshot({ path: join(shots, `${name}.png`) });
/** A screenshot that is a picture of the manual, which `OKOSHI_REWRITE=pictures` replaces. */
const manual = async (name) => {
  await shot(name);
  if (process.env.OKOSHI_REWRITE?.split(",").includes("pictures")) copyFileSync(join(shots, `${name}.png`), join(repository, "docs", "editors", `${name}.png`));
};

try {
  /** The address of a window with a drawing. */
  const address = (name) => {
    const uri = `vscode-remote://${server.address}${join(project, name)}`;
    const payload = encodeURIComponent(JSON.stringify([["openFile", uri]]));
    return `http://${server.address}/?folder=${encodeURIComponent(project)}&payload=${payload}`;
  };

  /** Opens a drawing in a new window, and waits until it can be edited. */
  const open = async (name) => {
    await page.goto(address(name));
    await editor.see(".editor-instance .view-line span", "svg");
    // With the keyboard: the window may still be moving under a click.
    await editor.until("the drawing to have the keyboard", async () => {
      await editor.press("Control+1");
      return page.evaluate(() => document.activeElement?.closest(".editor-instance") !== null);
    });
  };

  /** Reloads the window. An address that names a drawing would open only that. */
  const reload = async () => {
    await page.goto(`http://${server.address}/?folder=${encodeURIComponent(project)}`);
    await editor.see(".editor-instance .view-line span", "svg");
  };

  /** Runs a step, takes a screenshot, and reports the result.  */
  const step = async (name, act) => {
    if (wanted && !wanted.some((one) => name.includes(one))) return;
    number += 1;
    const began = Date.now();
    let verdict = "ok";
    try {
      await act();
    } catch (error) {
      failed += 1;
      verdict = `FAILED: ${error.message}`;
    }
    const file = `${String(number).padStart(2, "0")}-${name.replaceAll(/\W+/g, "-")}.png`;
    await page.screenshot({ path: join(shots, file) });
    console.log(`${name}: ${verdict} (${Date.now() - began} ms)`);
  };

  await open("plain.svg");
  await step("a missing program is no matter where there are no strings", async () => {
    await editor.said(0);
  });

  await open("figure.svg");
  await step("a missing program is said once", async () => {
    await editor.see(".notifications-toasts", "okoshi-that-is-not-there was not found");
    await editor.see(".notifications-toasts .monaco-button", "How to Install");
    await editor.said(1);
  });
  await step("how to install leads to the walkthrough", async () => {
    await (await editor.see(".notifications-toasts .monaco-button", "How to Install")).click();
    await editor.see(".getting-started-step", "Install okoshi");
  });
  await open("figure.svg");
  await step("the output says where it was looked for", async () => {
    // The window is up by then; a panel that is opened earlier may be closed again.
    await editor.see(".notifications-toasts", "was not found");
    const lines = page.locator(".output-view-container .view-line, .output-view .view-line", { hasText: "Looked at:" }).first();
    await editor.until("the output", async () => {
      await editor.command("Okoshi: Show Output");
      return lines.waitFor({ state: "visible", timeout: 5000 }).then(() => true, () => false);
    });
    await editor.command("View: Toggle Panel Visibility");
  });
  await step("strings are coloured, tags keep their colours", async () => {
    const string = "Arm@Body$Shape roundv";
    const keyword = await editor.until("a coloured keyword", () => editor.colour("Shape", string));
    const part = await editor.colour("Arm", string);
    const tag = await editor.colour("text x", string);
    assert.ok(part && tag, `part ${part}, tag ${tag}`);
    assert.notEqual(keyword, part);
    assert.equal(tag, await editor.colour("rect id", 'id="leg"'));
    assert.equal(await editor.colour("circle id", 'id="head"'), tag);
    assert.notEqual(await editor.colour("# Figures", "# Figures"), keyword);
  });
  /** A script that runs okoshi and writes its process id to `NAME.pid`. Returns its path. */
  const program = (name, script) => {
    const file = join(room, name);
    rmSync(`${file}.pid`, { force: true });
    writeFileSync(file, `#!/bin/sh\necho $$ > ${file}.pid\n${script.replaceAll("OKOSHI", okoshi)}\n`, { mode: 0o755 });
    return file;
  };
  const configure = (more, path = okoshi) => settings(path, { "editor.semanticHighlighting.enabled": true, ...more });
  // In the window that reported a missing program: the program that the setting names now is started there.
  const ready = async () => configure({});
  const read = (name = "figure.svg") => readFileSync(join(project, name), "utf8");
  const reset = () => copyFileSync(join(here, "figure.svg"), join(project, "figure.svg"));
  await step("keys are those of the system", async () => {
    const mac = await browser.newPage({ userAgent: "Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/140.0.0.0 Safari/537.36", viewport: { width: 1280, height: 800 } });
    try {
      await mac.goto(address("figure.svg"));
      const apple = new Editor(mac);
      // The extension has started by then.
      await apple.see(".notifications-toasts", "was not found");
      for (const [one, keys] of [[apple, ["⌘", "K", "V"]], [editor, ["Ctrl", "K", "V"]]]) {
        await one.see(".editor-instance .view-line span", "svg");
        await one.page.locator(".editor-instance .view-lines").first().click();
        await one.press("F1");
        await (await one.see(".quick-input-widget input")).fill(">Okoshi: Preview in 3D");
        const row = await one.see(".quick-input-list .monaco-list-row", "Okoshi: Preview in 3D");
        assert.deepEqual(await row.locator(".monaco-keybinding-key").allTextContents(), keys);
        await one.press("Escape");
      }
    } finally {
      await mac.close();
    }
  });
  await withServer({ editor, page, step, ready, configure, program, read, reset, open, reload, shot, manual, okoshi, project, room });
  if (module && (!wanted || wanted.some((one) => IN_BROWSER.includes(one) || one.includes(IN_BROWSER)))) {
    await inBrowser({ tools: found, vsix: join(room, "okoshi-web.vsix"), editor, page, step, shot, manual, write, SETTINGS, okoshi, room, figure: readFileSync(join(here, "figure.svg"), "utf8"), examples: join(repository, "examples") });
  } else if (!module) console.log("skipped: the package for the web, because OKOSHI_MODULE names no module");
  assert.ok(number > 0, `no step is named ${process.env.ONLY}`);
} catch (error) {
  // If the browser itself has exited, there is nothing to take a screenshot of.
  await page.screenshot({ path: join(shots, "failure.png") }).catch(() => {});
  throw error;
} finally {
  await browser.close();
  server.stop();
}
console.log(failed === 0 ? `all ${number} steps well` : `${failed} of ${number} steps failed`);
process.exit(failed === 0 ? 0 : 1);
