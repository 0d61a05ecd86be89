// The module and the program make the same bytes of every drawing of the examples and cases.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, relative, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";

const okoshi = process.env["OKOSHI"] ?? "";
const module = process.env["OKOSHI_MODULE"] ?? "";
const skip = !okoshi ? "there is no okoshi program; OKOSHI names one" : module === "" || !existsSync(module) ? "there is no module; OKOSHI_MODULE names the folder that editors/web/wasm/build.sh made" : false;

interface Studio {
  put(path: string, bytes: Uint8Array, at: number): void;
  messages(): string[];
  bytes(model: string): Uint8Array;
  free(): void;
}

interface Module {
  initSync(options: { module: WebAssembly.Module }): void;
  Studio: new () => Studio;
}

async function load(): Promise<Module> {
  const made = (await import(pathToFileURL(resolve(module, "okoshi_web.js")).href)) as Module;
  made.initSync({ module: new WebAssembly.Module(readFileSync(join(module, "okoshi_web_bg.wasm"))) });
  return made;
}

function files(folder: string): string[] {
  return readdirSync(folder)
    .sort()
    .map((name) => join(folder, name))
    .flatMap((path) => (statSync(path).isDirectory() ? files(path) : [path]));
}

const isDrawing = (path: string): boolean => path.endsWith(".svg");

/** The model that the module makes of a drawing, with the files of its folder. */
function inModule(made: Module, root: string, drawing: string, linked: readonly string[]): Buffer | undefined {
  const studio = new made.Studio();
  try {
    for (const path of [...linked, drawing]) studio.put(relative(root, path), readFileSync(path), 0);
    for (const text of studio.messages()) {
      const message = JSON.parse(text) as { type: string; build?: { model?: string | null } };
      if (message.type === "build" && message.build?.model) return Buffer.from(studio.bytes(message.build.model));
    }
    return undefined;
  } finally {
    studio.free();
  }
}

for (const [name, folders, least] of [
  ["examples", [join("..", "..", "examples")], 60],
  ["cases", readdirSync(join("..", "..", "tests", "cases")).map((name) => join("..", "..", "tests", "cases", name)), 60],
] as const) {
  test(`program and module make the same bytes of ${name}`, { skip }, async (t) => {
    const made = await load();
    const folder = mkdtempSync(join(tmpdir(), "okoshi-bytes-"));
    t.after(() => rmSync(folder, { recursive: true }));
    const model = join(folder, "model.glb");
    const differ: string[] = [];
    let compared = 0;
    for (const root of folders.filter((path) => statSync(path).isDirectory())) {
      const all = files(root);
      const linked = all.filter((path) => !isDrawing(path));
      for (const drawing of all.filter(isDrawing)) {
        rmSync(model, { force: true });
        // What has errors is not built.
        if (spawnSync(okoshi, ["build", "-q", drawing, "-o", model]).status !== 0) continue;
        compared += 1;
        const own = inModule(made, root, drawing, linked);
        if (!own?.equals(readFileSync(model))) differ.push(relative(join("..", ".."), drawing));
      }
    }
    assert.deepEqual(differ, []);
    assert.ok(compared >= least, `only ${compared} drawings were compared`);
  });
}
