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

const withModule = { skip: process.env["OKOSHI_MODULE"] ? false : "OKOSHI_MODULE names no folder of a module" };
/** Bytes. */
const LARGEST_WEB = 5_000_000;

test("without a module it does not say that it works in browsers", async () => {
  const packaged = JSON.parse((await entries).get("extension/package.json")?.toString("utf8") ?? "{}") as object;
  assert.ok(!("browser" in packaged) && "main" in packaged);
  assert.ok(![...(await entries).keys()].some((name) => name.includes("dist/web") || name.endsWith(".wasm")));
});

test("a package for the web brings the module, and nothing that needs a program", withModule, async () => {
  const files = await read("okoshi-web.vsix");
  const own = [...files.keys()].filter((name) => name.startsWith("extension/dist/"));
  assert.deepEqual(own.filter((name) => !/\/(page|syntaxes)\//.test(name)).sort(), [
    "extension/dist/NOTICES.txt",
    ...["module-licences.txt"].map((name) => `extension/dist/${name}`).filter((name) => files.has(name)),
    "extension/dist/web/extension.js",
    "extension/dist/web/okoshi_web_bg.wasm",
    "extension/dist/web/server.js",
  ]);
  for (const name of (await entries).keys()) {
    if (/^extension\/(dist\/(page|syntaxes)|walkthrough|snippets|icon)/.test(name)) assert.ok(files.get(name)?.equals((await entries).get(name) ?? Buffer.alloc(0)), name);
  }
  assert.match(files.get("extension.vsixmanifest")?.toString("utf8") ?? "", /TargetPlatform="web"/);
  const text = files.get("extension/package.json")?.toString("utf8") ?? "{}";
  const web = JSON.parse(text) as typeof manifest & { readonly browser: string };
  assert.equal(web.browser, "./dist/web/extension.js");
  for (const name of ["main", "extensionKind", "devDependencies"]) assert.ok(!Object.hasOwn(web, name), name);
  assert.equal(web.version, manifest.version);
  assert.equal(web.capabilities.virtualWorkspaces, true);
  assert.deepEqual(Object.keys(web.contributes.configuration.properties), ["okoshi.analyse", "okoshi.trace.server"]);
  assert.deepEqual(web.contributes.commands.map(({ command }) => command), ["okoshi.preview", "okoshi.restart", "okoshi.showOutput", "okoshi.openWalkthrough"]);
  assert.deepEqual(web.contributes.walkthroughs[0]?.steps.map(({ id }) => id), ["string", "check", "preview"]);
  for (const name of ["okoshi.path", "okoshi.build", "okoshi.newDrawing"]) assert.ok(!text.includes(name), name);
  const { size } = statSync("okoshi-web.vsix");
  assert.ok(size < LARGEST_WEB, `${size} bytes`);
});

test("what runs in browsers needs nothing but the editor", withModule, async () => {
  const files = await read("okoshi-web.vsix");
  const needed = (name: string) => [...(files.get(`extension/dist/web/${name}`)?.toString("utf8") ?? "").matchAll(/\b(?:require|import)\("([^"]+)"\)/g)].map((match) => match[1]);
  assert.deepEqual([...new Set(needed("extension.js"))], ["vscode"]);
  assert.deepEqual(needed("server.js"), []);
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
