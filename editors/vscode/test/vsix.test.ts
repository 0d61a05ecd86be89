// The content of the package: everything it needs and nothing else.

import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { builtinModules } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import { fromBuffer } from "yauzl";
import manifest from "../package.json";
import { repository } from "./paths";

/** Bytes. */
const LARGEST = 600_000;

const entries = new Promise<Map<string, Buffer>>((resolve, reject) => {
  const found = new Map<string, Buffer>();
  fromBuffer(readFileSync("okoshi.vsix"), { lazyEntries: true }, (error, archive) => {
    if (error) return reject(error);
    archive.on("error", reject);
    archive.on("end", () => resolve(found));
    archive.on("entry", (entry) => {
      archive.openReadStream(entry, (error, stream) => {
        if (error) return reject(error);
        const pieces: Buffer[] = [];
        stream.on("data", (piece: Buffer) => pieces.push(piece));
        stream.on("end", () => {
          found.set(entry.fileName, Buffer.concat(pieces));
          archive.readEntry();
        });
      });
    });
    archive.readEntry();
  });
});

test("it holds what it should", async () => {
  const pictures = ["drawing.png", "install.md", "model.png", "problems.png", "string.md"];
  assert.deepEqual([...(await entries).keys()].sort(), [
    "[Content_Types].xml",
    "extension.vsixmanifest",
    "extension/LICENSE.txt",
    "extension/dist/NOTICES.txt",
    "extension/dist/extension.js",
    "extension/dist/page/page.css",
    "extension/dist/page/page.html",
    "extension/dist/page/page.js",
    "extension/dist/syntaxes/okoshi-injection.tmLanguage.json",
    "extension/dist/syntaxes/okoshi.tmLanguage.json",
    "extension/icon.png",
    "extension/package.json",
    "extension/readme.md",
    "extension/snippets/okoshi.json",
    ...pictures.map((name) => `extension/walkthrough/${name}`),
  ]);
});

test("it is small", () => {
  const { size } = statSync("okoshi.vsix");
  assert.ok(size < LARGEST, `${size} bytes`);
});

test("all that the manifest names is in it", async () => {
  const { grammars, snippets } = manifest.contributes;
  for (const path of [manifest.main, manifest.icon, ...grammars.map((one) => one.path), ...snippets.map((one) => one.path)]) {
    assert.ok((await entries).has(join("extension", path)), path);
  }
});

test("its grammars are the generated ones", async () => {
  for (const name of ["okoshi", "okoshi-injection"]) {
    const file = `${name}.tmLanguage.json`;
    assert.ok((await entries).get(`extension/dist/syntaxes/${file}`)?.equals(readFileSync(join(repository, "grammar", file))), file);
  }
});

test("its bundle needs nothing but the editor and Node", async () => {
  const bundle = (await entries).get("extension/dist/extension.js")?.toString("utf8") ?? "";
  const needed = [...bundle.matchAll(/\brequire\("([^"]+)"\)/g)].map((match) => match[1]?.replace(/^node:/, ""));
  assert.ok(needed.includes("vscode"));
  assert.deepEqual(needed.filter((name) => name !== "vscode" && !builtinModules.includes(name ?? "")), []);
});

test("it names both licences and those of what it bundles", async () => {
  const text = async (name: string) => (await entries).get(`extension/${name}`)?.toString("utf8") ?? "";
  assert.match(await text("LICENSE.txt"), /MIT License/i);
  assert.match(await text("LICENSE.txt"), /Apache License/);
  assert.match(await text("dist/NOTICES.txt"), /vscode-languageclient \d/);
});
