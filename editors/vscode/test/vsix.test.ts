// The content of the package: everything it needs and nothing else.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { chmodSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { builtinModules } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fromBuffer } from "yauzl";
import manifest from "../package.json";
import { candidates, firstExecutable, parseVersion } from "../src/binary";
import { repository } from "./paths";

/** Bytes. */
const LARGEST = 600_000;

/** The files of a package; `modes` gets their rights. */
const read = (name: string, modes = new Map<string, number>()) =>
  new Promise<Map<string, Buffer>>((resolve, reject) => {
    const found = new Map<string, Buffer>();
    fromBuffer(readFileSync(name), { lazyEntries: true }, (error, archive) => {
      if (error) return reject(error);
      archive.on("error", reject);
      archive.on("end", () => resolve(found));
      archive.on("entry", (entry) => {
        modes.set(entry.fileName, (entry.externalFileAttributes >>> 16) & 0o777);
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
const entries = read("okoshi.vsix");

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

test("a package for one system brings the program, which the extension finds first", { skip: process.platform === "win32" ? "the stand-in is a shell script" : false }, async () => {
  const modes = new Map<string, number>();
  const files = await read("okoshi-with-program.vsix", modes);
  assert.deepEqual([...files.keys()].filter((name) => name.startsWith("extension/bin/")), ["extension/bin/okoshi"]);
  assert.equal(files.size, (await entries).size + 1);
  assert.match(files.get("extension.vsixmanifest")?.toString("utf8") ?? "", new RegExp(`TargetPlatform="${process.platform}-${process.arch}"`));
  assert.doesNotMatch((await entries).get("extension.vsixmanifest")?.toString("utf8") ?? "", /TargetPlatform/);

  // Unpacked with the rights in the archive, as VS Code does.
  const room = mkdtempSync(join(tmpdir(), "okoshi-vsix-"));
  try {
    for (const [name, bytes] of files) {
      const path = join(room, name);
      mkdirSync(dirname(path), { recursive: true });
      writeFileSync(path, bytes);
      chmodSync(path, modes.get(name) || 0o644);
    }
    const environment = { platform: process.platform, env: { PATH: dirname(process.execPath) }, home: room, folder: undefined, extension: join(room, "extension") };
    const runs = async (path: string) => spawnSync(path, ["--version"]).status === 0;
    const found = await firstExecutable(candidates(manifest.contributes.configuration.properties["okoshi.path"].default, environment), runs);
    assert.equal(found, join(room, "extension", "bin", "okoshi"));
    assert.equal(parseVersion(spawnSync(found, ["--version"], { encoding: "utf8" }).stdout), "1.2.3");
  } finally {
    rmSync(room, { recursive: true });
  }
});
