// okoshi in the browser, without a server: files, changes, reloads, no network, and faults.

import assert from "node:assert/strict";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import type { BrowserContext, Page } from "playwright-core";
import { App, byOkoshi, inBrowser, STAGE } from "./app";
import { found } from "./axe";
import { overlaps, picture, shown, still, type } from "./browser";
import { drag, FIRST_FIGURE } from "./drawn";
import { FIGURE, source } from "./setup";
import { SIZES } from "./sizes";

const TEXT = source(FIGURE);
const MOTIONS = join("..", "..", "examples", "motion");
const PHOTOGRAPHS = join("..", "..", "examples", "photographs");

inBrowser("a first visit offers starters; one begins, and is there again after a reload until it is closed", async ({ page }) => {
  await page.getByText("Drop an SVG here, or change this one.").waitFor();
  await page.locator("[data-starter] img").first().waitFor();
  await picture(page, "app-starters");
  assert.equal(await page.getByRole("button", { name: "Save" }).isVisible(), false);
  await page.locator("[data-starter=robot]").click();
  await shown(page);
  assert.equal(await page.title(), "robot.svg · okoshi");
  await picture(page, "app-robot");
  await page.reload();
  await shown(page);
  assert.equal(await page.title(), "robot.svg · okoshi");
  await page.getByRole("button", { name: "Close" }).click();
  // Firefox reports what is still on its way to a page that is left.
  const stage = page.locator(STAGE);
  await stage.waitFor();
  await page.locator("[data-starter=robot]").waitFor();
  await page.reload();
  await stage.waitFor();
  await page.locator("[data-starter=robot]").waitFor();
  assert.equal(await page.title(), "okoshi");
});

inBrowser("a drawing is opened, changed, undone, changed again and saved; a reload keeps the changes", async (app) => {
  const { page } = app;
  await app.choose(FIGURE);
  await shown(page);
  const save = page.getByRole("button", { name: "Save" });
  assert.equal(await save.getAttribute("data-changed"), "false");
  await page.getByRole("button", { name: "Edit" }).click();
  await app.select("Arm");
  const number = page.getByLabel("Shape: z1, as a number", { exact: true });
  await type(number, "30");
  await number.press("Enter");
  await page.getByText("Changed", { exact: true }).waitFor();
  assert.equal(await save.getAttribute("data-changed"), "true");
  await page.getByRole("button", { name: "Undo: " }).click();
  await page.getByRole("button", { name: "Redo: " }).and(page.locator(":enabled")).waitFor();
  assert.equal((await app.saved(() => page.keyboard.press("Control+s"))).text, TEXT);
  await page.getByRole("button", { name: "Redo: " }).click();
  await page.getByRole("button", { name: "Undo: " }).and(page.locator(":enabled")).waitFor();
  // What is typed and not yet sent is saved, too.
  await type(page.getByLabel("Name", { exact: true }), "Wing");
  const { name, text } = await app.saved(() => page.keyboard.press("Control+s"));
  const changed = TEXT.replace("-8 8", "-8 30").replaceAll("Arm@", "Wing@");
  assert.deepEqual([name, text], ["figure.svg", changed]);
  await page.waitForFunction(() => document.querySelector<HTMLElement>("[data-changed]")!.dataset["changed"] === "false");

  await page.reload();
  await app.part("Wing");
  assert.equal((await app.saved(() => page.getByRole("button", { name: "Save" }).click())).text, changed);
});

inBrowser("a drop brings a drawing with what it links to; what is no drawing is said to be none, and another one of the same name takes nothing away", async (app) => {
  const { page } = app;
  await app.drop({ name: "kick.bvh", text: source(join(MOTIONS, "kick.bvh")) });
  await app.says("kick.bvh: kept for drawings that link to it. Open the drawing, too");
  await app.drop({ name: "notes.txt", text: "notes" }, { name: "art.pdf", text: "%PDF" });
  await app.says("notes.txt is no drawing: okoshi reads SVG, and the motions, pictures and maps that a drawing links to. art.pdf is no drawing: open it in Inkscape and save it as SVG.");
  await app.drop({ name: "kick.svg", text: source(join(MOTIONS, "kick.svg")) });
  await page.locator(".clips", { hasText: "kick" }).waitFor();
  assert.equal(await page.locator(".notice").count(), 0);

  // Another drawing is shown as soon as it is dropped, and both are listed.
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.part("Arm");
  assert.equal(await page.title(), "figure.svg · okoshi");
  await app.rename("Arm", "Wing");
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.part("Arm");
  assert.equal(await page.title(), "figure-2.svg · okoshi");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("3 drawings").waitFor();
  await page.locator(".card", { hasText: "figure.svg" }).click();
  await app.part("Wing");

  // What was changed is not closed without being asked.
  await page.getByRole("button", { name: "Close" }).click();
  await page.getByRole("button", { name: "Keep it open" }).click();
  await app.part("Wing");
  await page.getByRole("button", { name: "Close" }).click();
  await page.getByRole("button", { name: "Close without saving" }).click();
  await page.getByText("2 drawings").waitFor();
});

inBrowser("an empty page becomes a figure that walks, drawn by hand, and is kept and saved as plain SVG", async (app) => {
  const { page } = app;
  await page.locator("[data-starter=empty]").click();
  await page.getByRole("button", { name: "Draw something" }).click();
  await page.locator(".draw-tools").waitFor();
  for (const [at, points] of FIRST_FIGURE.entries()) {
    await drag(page, points, [210, 297]);
    await page.locator(".bar-facts", { hasText: new RegExp(`^${at + 1} part`) }).waitFor();
  }
  await page.waitForFunction(() => document.querySelector(".paper-drafts")!.childElementCount === 0);
  await page.getByRole("button", { name: "Name the parts for me" }).click();
  for (const part of ["Body", "Head", "Larm", "Rarm", "Lleg", "Rleg"]) await app.part(part);
  await app.select("Body");
  await page.getByLabel("Motion: clip", { exact: true }).selectOption("=walk");
  await page.waitForFunction(() => /^walk/.test(document.querySelector(".clip-choice option")?.textContent ?? ""));
  await still(page);
  const before = await picture(page, "app-drawn");
  await page.locator("canvas").focus();
  await page.keyboard.press("k");
  await still(page);
  const after = await picture(page, "app-drawn-walks");
  assert.notDeepEqual(before.data, after.data, "it moves");
  const saved = await app.saved(() => page.getByRole("button", { name: "Save" }).click());
  assert.equal(saved.text.match(/<path\b[^>]* d="M [^"]* Z" \/?>/g)?.length, 6);
  await page.reload();
  await app.part("Larm");
});

inBrowser("a photograph of a drawing becomes a figure; a text that is called a picture does not", async (app) => {
  const { page } = app;
  await app.drop({ name: "notes.png", text: "notes" });
  await app.says("notes.png: kept for drawings that link to it. Is it a drawing itself, or a photograph of one?");
  await page.getByRole("button", { name: "Make a drawing of it" }).click();
  await app.says("notes.png cannot be read:");
  await app.choose(join(PHOTOGRAPHS, "boy.jpg"));
  await page.getByRole("button", { name: "Make a drawing of it" }).click();
  await app.part("U-1");
  assert.equal(await page.title(), "boy.svg · okoshi");
  assert.equal(await page.locator(".notice").count(), 0);
  await page.getByRole("button", { name: "Edit" }).click();
  await page.getByRole("button", { name: "Name the parts for me" }).click();
  for (const name of ["Head", "Hair", "Body", "Larm", "Rleg"]) await app.part(name);
  const saved = await app.saved(() => page.getByRole("button", { name: "Save" }).click());
  assert.equal(saved.name, "boy.svg");
  assert.match(saved.text, /inkscape:label="Head"/);
});

inBrowser("a drawing with a mistake says where it is, and the next text of the file shows its model", async (app) => {
  await app.drop({ name: "figure.svg", text: TEXT.replace("Arm@Body", "Arm@Bdoy") });
  await app.page.waitForSelector(".findings[data-open=true]");
  assert.match(await app.page.locator(".finding").first().innerText(), /there is no part named Bdoy/);
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.page.locator(".findings").waitFor({ state: "hidden" });
  await app.drop({ name: "figure.svg", text: "This is no SVG." });
  await app.page.waitForSelector(".findings[data-open=true]");
  assert.match(await app.page.locator(".finding").first().innerText(), /Problem/);
});

inBrowser("a drawing that is no text is refused in words, and what was shown of it before stays", async (app) => {
  const { page } = app;
  const foreign = { name: "figure.svg", mimeType: "image/svg+xml", buffer: Buffer.from("<svg>\xe9</svg>", "latin1") };
  await app.choose(foreign);
  await app.says("figure.svg cannot be shown: the drawing is not text in UTF-8: save it as plain SVG.");
  await page.getByRole("button", { name: "Close the file" }).click();
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.part("Arm");
  await app.choose(foreign);
  await app.says("figure.svg cannot be shown");
  await app.part("Arm");
  assert.equal(await page.title(), "figure.svg · okoshi");
});

/** A file that is not text. */
const file = (name: string, buffer: Buffer): { name: string; mimeType: string; buffer: Buffer } => ({ name, mimeType: "application/octet-stream", buffer });

inBrowser("a compressed drawing is unpacked, changed, and saved as plain SVG", async (app) => {
  const { page } = app;
  await app.choose(file("figure.svgz", gzipSync(TEXT)));
  await app.says("figure.svgz was compressed, and is open as plain SVG: Save writes figure.svg.");
  await shown(page);
  await picture(page, "app-compressed");
  assert.equal(await page.title(), "figure.svg · okoshi");
  await app.rename("Arm", "Wing");
  const saved = await app.saved(() => page.getByRole("button", { name: "Save" }).click());
  assert.deepEqual([saved.name, saved.text], ["figure.svg", TEXT.replaceAll("Arm@", "Wing@")]);
  await page.reload();
  await app.part("Wing");
  assert.equal(await page.title(), "figure.svg · okoshi");

  // A plain drawing of the same name keeps it.
  await app.choose(file("hat.svgz", gzipSync(TEXT)), file("hat.svg", Buffer.from(TEXT.replaceAll("Arm@", "Hat@"))));
  await app.says("hat.svgz was compressed, and is open as plain SVG: Save writes hat-2.svg.");
  await app.part("Hat");
  // The first bytes tell, not the name.
  await app.choose(file("a.svgz", gzipSync(TEXT)), file("b.svg", gzipSync(TEXT)), file("c.svgz", Buffer.from(TEXT)));
  await app.says("a.svgz, b.svg were compressed, and are open as plain SVG.");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("6 drawings").waitFor();
  for (const name of ["figure.svg", "hat.svg", "hat-2.svg", "a.svg", "b.svg", "c.svg"]) await page.locator(".card", { hasText: name }).waitFor();
});

inBrowser("a compressed drawing that is damaged, or unpacks to far too much, is said to; what was opened with it opens", async (app) => {
  const { page } = app;
  const whole = gzipSync(TEXT);
  const bomb = gzipSync(Buffer.alloc(65 << 20, " "));
  assert.ok(bomb.length < 100_000);
  await app.choose(file("cut.svgz", whole.subarray(0, whole.length - 20)), file("bomb.svgz", bomb), file("figure.svg", Buffer.from(TEXT)));
  await app.says("cut.svgz is compressed, but damaged: save it again, or as plain SVG. bomb.svgz is larger than 64 MiB when it is unpacked: save it as plain SVG.");
  await app.part("Arm");
  await app.choose(file("more.svgz", Buffer.concat([whole, Buffer.from("more")])));
  await app.says("more.svgz is compressed, but damaged");
  await page.reload();
  await app.part("Arm");
  assert.equal(await page.title(), "figure.svg · okoshi");
});

inBrowser("a second tab says that it keeps nothing, and takes nothing from the first", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: TEXT });
  await app.part("Arm");
  const other = await page.context().newPage();
  await other.goto(page.url());
  await other.getByText("Your drawings are open in another tab. What you do in this one is not kept until that one is closed.").waitFor();
  await other.locator("[data-starter=robot]").click();
  await shown(other);
  await other.getByRole("button", { name: "Edit" }).click();
  await other.locator("[data-part=Bulb]").click();
  const name = other.getByLabel("Name", { exact: true });
  await type(name, "Lamp");
  await name.press("Enter");
  await other.locator('[data-changed="true"]').waitFor();
  assert.ok(await other.locator(".notice").isVisible());
  // What would be lost is asked about.
  const [question] = await Promise.all([other.waitForEvent("dialog"), other.close({ runBeforeUnload: true })]);
  assert.equal(question.type(), "beforeunload");
  await question.accept();
  await page.reload();
  await app.part("Arm");
  assert.equal(await page.title(), "figure.svg · okoshi");
});

inBrowser("a second tab goes on with the drawings of the first when that is closed, and loses neither's", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: TEXT }, { name: "only-there.svg", text: TEXT });
  await app.part("Arm");
  await app.rename("Arm", "Wing");
  const context = page.context();
  const other = new App(await context.newPage(), () => app.leave());
  await other.page.goto(page.url());
  await other.says("Your drawings are open in another tab.");
  await other.drop({ name: "figure.svg", text: TEXT.replaceAll("Arm@", "Fin@") });
  await other.part("Fin");
  await page.close();
  await other.page.locator(".notice").waitFor({ state: "detached" });
  await other.page.getByRole("link", { name: "Drawings" }).click();
  await other.page.getByText("3 drawings").waitFor();
  await other.page.reload();
  await other.page.getByText("3 drawings").waitFor();
  for (const [name, part] of [["figure.svg", "Fin"], ["figure-2.svg", "Wing"], ["only-there.svg", "Arm"]]) {
    await other.page.locator(".card", { has: other.page.getByText(name!, { exact: true }) }).click();
    await other.part(part!);
    await other.page.getByRole("link", { name: "Drawings" }).click();
  }
});

inBrowser("without a network the program opens as it was left", async (app) => {
  const { page } = app;
  await app.drop({ name: "figure.svg", text: TEXT });
  await shown(page);
  await page.evaluate(() => navigator.serviceWorker.ready.then(() => {}));
  await app.leave();
  await page.reload();
  await shown(page);
  assert.equal(await page.title(), "figure.svg · okoshi");
  await page.goto(`${page.url().split("#")[0]}index.html`);
  await shown(page);
});

inBrowser("`okoshi app` serves the program, which draws a figure, and opens again when that has ended", async (app) => {
  const { page } = app;
  await page.locator(".welcome-stage canvas[data-revision]").waitFor();
  await picture(page, "app-served");
  await page.locator("[data-starter=robot]").click();
  await shown(page);
  assert.equal(await page.title(), "robot.svg · okoshi");
  const { data } = await picture(page, "app-served-robot");
  assert.ok(new Set(data.toString("latin1").match(/.{4}/gs)).size > 500, "it is drawn");
  await page.evaluate(() => navigator.serviceWorker.ready.then(() => {}));
  await app.leave();
  await page.reload();
  await shown(page);
  assert.equal(await page.title(), "robot.svg · okoshi");
}, { server: byOkoshi });

/** The browser's own files stand for those of the computer: a page is let at both in the same way. */
const withFiles = async (context: BrowserContext): Promise<void> => {
  await context.addInitScript(() => {
    const handle = async (create: boolean) => (await navigator.storage.getDirectory()).getFileHandle("figure.svg", { create });
    const own = globalThis as unknown as { fileText(): Promise<string>; writeFile(text: string): Promise<void>; showOpenFilePicker(): Promise<unknown>; showSaveFilePicker(): Promise<unknown> };
    own.fileText = async () => (await (await handle(false)).getFile()).text();
    own.writeFile = async (text) => {
      const file = await (await handle(true)).createWritable();
      await file.write(text);
      await file.close();
    };
    own.showOpenFilePicker = async () => [await handle(false)];
    own.showSaveFilePicker = () => handle(true);
  });
};
const fileText = (page: Page): Promise<string> => page.evaluate(() => (globalThis as unknown as { fileText(): Promise<string> }).fileText());
const writeFile = (page: Page, text: string): Promise<void> => page.evaluate((text) => (globalThis as unknown as { writeFile(text: string): Promise<void> }).writeFile(text), text);

inBrowser("where the browser lets a page at files, a drawing is saved in its file, and what another program writes is shown", async (app) => {
  const { page } = app;
  await page.locator("[data-starter]").first().waitFor();
  await writeFile(page, TEXT);
  await page.keyboard.press("Control+o");
  await app.part("Arm");
  const wing = TEXT.replaceAll("Arm@", "Wing@");
  await writeFile(page, wing);
  await app.part("Wing");

  // After a reload the file is still its file.
  await page.reload();
  await app.part("Wing");
  await page.getByRole("button", { name: "Edit" }).click();
  await app.select("Wing");
  const rename = async (to: string): Promise<void> => {
    const name = page.getByLabel("Name", { exact: true });
    await type(name, to);
    await name.press("Enter");
    await app.part(to);
  };
  await rename("Fin");
  assert.equal(await fileText(page), wing);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector<HTMLElement>("[data-changed]")!.dataset["changed"] === "false");
  assert.equal(await fileText(page), TEXT.replaceAll("Arm@", "Fin@"));

  // Two have changed it: neither loses anything.
  await rename("Oar");
  const theirs = TEXT.replaceAll("Arm@", "Theirs@");
  await writeFile(page, theirs);
  await app.says("Another program has written figure.svg");
  await page.keyboard.press("Control+s");
  await app.says("Another program has written figure.svg");
  assert.equal(await fileText(page), theirs);
  await page.getByRole("button", { name: "Keep the changes made here" }).click();
  await page.getByRole("button", { name: "Save" }).click();
  await page.waitForFunction(() => document.querySelector<HTMLElement>("[data-changed]")!.dataset["changed"] === "false");
  assert.equal(await fileText(page), TEXT.replaceAll("Arm@", "Oar@"));
  await rename("Leg");
  await writeFile(page, theirs);
  await page.getByRole("button", { name: "Show the file" }).click();
  await app.part("Theirs");
  assert.equal(await page.locator("[data-part=Leg]").count(), 0);
}, { prepare: withFiles });

inBrowser("where the browser lets a page at files, a compressed drawing takes no other's place, and is not written", async (app) => {
  const { page } = app;
  await page.locator("[data-starter]").first().waitFor();
  await writeFile(page, TEXT);
  await page.keyboard.press("Control+o");
  await app.part("Arm");
  await page.evaluate((bytes) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(bytes)], "figure.svgz"));
    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [...gzipSync(TEXT.replaceAll("Arm@", "Hat@"))]);
  await app.says("figure.svgz was compressed, and is open as plain SVG: Save writes figure-2.svg.");
  await app.part("Hat");
  await app.rename("Hat", "Cap");
  assert.equal(await fileText(page), TEXT);
  // It is in no file that may be written, so that a place is asked for.
  await page.evaluate(() => Object.assign(globalThis, { showSaveFilePicker: () => Promise.reject(new DOMException("", "AbortError")) }));
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.locator(".card", { hasText: "figure.svg" }).click();
  await app.part("Arm");
  assert.equal(await fileText(page), TEXT);
}, { prepare: withFiles });

/** Makes the module stop as it does at a fault: at files and at requests that have a word in them. */
const withFaults = async (context: BrowserContext): Promise<void> => {
  await context.route("**/okoshi_web.js", async (route) => {
    const response = await route.fetch();
    const stops = `
      const unreachable = new WebAssembly.Instance(new WebAssembly.Module(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 7, 5, 1, 1, 102, 0, 0, 10, 5, 1, 3, 0, 0, 11))).exports.f;
      for (const name of ["put", "change"]) {
        const whole = Studio.prototype[name];
        Studio.prototype[name] = function (first, ...rest) {
          const text = name === "put" ? new TextDecoder().decode(rest[0]) : first;
          while (text.includes("Endless"));
          return text.includes("Fault") ? unreachable() : whole.call(this, first, ...rest);
        };
      }`;
    await route.fulfill({ response, body: (await response.text()) + stops });
  });
};

inBrowser("a fault of okoshi is said, the worker starts again, and nothing that was drawn is lost", async (app) => {
  const { page } = app;
  await app.drop({ name: "other.svg", text: TEXT.replaceAll("Arm@", "Fin@") }, { name: "figure.svg", text: TEXT });
  await app.part("Fin");
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.locator(".card", { hasText: "figure.svg" }).click();
  await app.part("Arm");
  const rename = async (to: string): Promise<void> => {
    await page.getByRole("button", { name: "Edit" }).and(page.locator("[aria-pressed=false]")).click();
    await page.locator("[data-part]").nth(1).click();
    await page.locator(".part-form:not([inert])").waitFor();
    const name = page.getByLabel("Name", { exact: true });
    await type(name, to);
    await name.press("Enter");
  };
  await rename("Wing");
  await app.part("Wing");
  await page.getByRole("button", { name: "Stop editing" }).click();
  // A change stops it: the last text is there again.
  await rename("Fault");
  await app.says("okoshi stopped at a fault of its own. What you did last was not done; everything else is as it was.");
  await app.part("Wing");
  await shown(page);
  assert.equal((await app.saved(() => page.getByRole("button", { name: "Save" }).click())).text, TEXT.replaceAll("Arm@", "Wing@"));

  // A file stops it: the last text of it that did not is shown.
  await app.drop({ name: "figure.svg", text: TEXT.replaceAll("Arm@", "Fault@") });
  await app.says("okoshi stopped while it read figure.svg: that is a fault of okoshi. It shows figure.svg as it was before.");
  await app.part("Wing");
  // A new file stops it: it is not shown, and the others are.
  await app.drop({ name: "new.svg", text: TEXT.replaceAll("Arm@", "Fault@") });
  await app.says("okoshi stopped while it read new.svg: that is a fault of okoshi. It does not show this file; nothing in it was changed.");
  await page.getByRole("button", { name: "Close the file" }).click();
  await page.getByRole("link", { name: "Drawings" }).click();
  await page.getByText("2 drawings").waitFor();
}, { prepare: withFaults, serviceWorkers: "block", expected: /unreachable|^Error$|Service Worker registration blocked/ });

inBrowser("what is done in the moment before the page is left is kept", async (app) => {
  const { page } = app;
  const kept = async (): Promise<IDBValidKey[]> => page.evaluate(() => new Promise((resolve) => {
    const opening = indexedDB.open("okoshi");
    opening.onsuccess = () => {
      const asked = opening.result.transaction("files").objectStore("files").getAllKeys();
      asked.onsuccess = () => (opening.result.close(), resolve(asked.result));
    };
  }));
  const names = Array.from({ length: 6 }, (_, at) => `figure-${at}.svg`);
  await app.drop(...names.map((name) => ({ name, text: TEXT })));
  await app.part("Arm");
  for (const next of [...names.slice(1), ""]) {
    const close = page.getByRole("button", { name: "Close", exact: true });
    await Promise.all([page.waitForEvent("load"), close.evaluate((close: HTMLElement, next) => (close.click(), (location.hash = next), location.reload()), next)]);
    assert.deepEqual(await kept(), next ? names.slice(names.indexOf(next)) : []);
    if (next) await app.part("Arm");
  }
}, { serviceWorkers: "block", expected: /Service Worker registration blocked/ });

inBrowser("what takes too long can be stopped by a person, also when the browser kept it", async (app) => {
  const { page } = app;
  await app.drop({ name: "other.svg", text: TEXT });
  await app.part("Arm");
  await app.drop({ name: "figure.svg", text: TEXT.replaceAll("Arm@", "Endless@") });
  await app.says("okoshi is still working on figure.svg.");
  await page.reload();
  await app.says("okoshi is still working on figure.svg.");
  await page.getByRole("button", { name: "Stop", exact: true }).click();
  await app.says("You stopped okoshi while it read figure.svg. It does not show this file; nothing in it was changed.");
  await app.part("Arm");
  await page.getByRole("button", { name: "Close the file" }).click();
  await page.reload();
  await app.part("Arm");
  assert.equal(await page.locator(".notice").count(), 0);
}, { prepare: withFaults, serviceWorkers: "block", expected: /Service Worker registration blocked/ });

for (const { name, ...size } of SIZES) {
  inBrowser(`axe finds nothing in the program's own parts, and they have room: ${name}`, async (app) => {
    const { page } = app;
    const is = async (state: string): Promise<void> => {
      await picture(page, `app-${name}-${state}`);
      assert.deepEqual(await found(page), [], state);
      // The drawer of a small window lies over other things.
      if (!(await page.locator(".drawer-head").isVisible())) assert.deepEqual(await overlaps(page), [], state);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${state} is too wide`);
    };
    await page.locator("[data-starter] img").first().waitFor();
    await is("starters");
    await app.drop({ name: "a-drawing-with-a-long-name.svg", text: TEXT }, { name: "notes.txt", text: "notes" });
    await shown(page);
    await is("drawing");
    assert.ok((await page.locator(".bar-title").boundingBox())!.width > 100, "the name can be read");
    await page.getByRole("button", { name: "Close this message" }).click();
    await page.getByRole("button", { name: "Edit" }).click();
    await app.select("Arm");
    const label = page.getByLabel("Name", { exact: true });
    await type(label, "Wing");
    await label.press("Enter");
    await page.locator('[data-changed="true"]').waitFor();
    await is("changed");
    await page.getByRole("button", { name: "Close", exact: true }).click();
    await page.getByRole("button", { name: "Keep it open" }).waitFor();
    await is("asked");
    await page.keyboard.press("Escape");
    await page.getByRole("button", { name: "Close", exact: true }).click();
    await page.getByRole("button", { name: "Close without saving" }).click();
    await page.locator("[data-starter]").first().waitFor();
  }, size);
}
