// The extension for VS Code for the Web: without a program, with the module that `editors/web/wasm` is built to.

import { cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { licences } from "../../web/scripts/licences.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const dist = join(here, "dist");
/** What is used of a module. */
const SCRIPT = "okoshi_web.js";
const CODE = "okoshi_web_bg.wasm";
/** The licences of the packages in the module, which `editors/web/scripts/crates.mjs` prints. */
const CRATES = "module-licences.txt";

/** Commands that run the program, and the setting that names it. */
const OF_PROGRAM = ["okoshi.build", "okoshi.newDrawing"];
const PATH = "okoshi.path";

/** The manifest of the extension for the web. */
export function webManifest(manifest) {
  const { main: _main, extensionKind: _kind, scripts: _scripts, devDependencies: _dev, contributes, capabilities, ...rest } = manifest;
  const stays = ({ command }) => !OF_PROGRAM.includes(command);
  const { [PATH]: _path, ...properties } = contributes.configuration.properties;
  const names = (step) => [...OF_PROGRAM, PATH].some((name) => JSON.stringify(step).includes(name));
  return {
    ...rest,
    browser: "./dist/web/extension.js",
    capabilities: { ...capabilities, untrustedWorkspaces: { supported: true }, virtualWorkspaces: true },
    contributes: {
      ...contributes,
      configuration: { ...contributes.configuration, properties },
      commands: contributes.commands.filter(stays),
      menus: Object.fromEntries(Object.entries(contributes.menus).map(([place, items]) => [place, items.filter(stays)])),
      keybindings: contributes.keybindings.filter(stays),
      walkthroughs: contributes.walkthroughs.map((one) => ({ ...one, steps: one.steps.filter((step) => !names(step)) })),
    },
  };
}

/** Bundles what runs in the browser into a folder, with the module. Returns what it is made of. */
export async function bundleWeb(module, out) {
  for (const name of [SCRIPT, CODE]) if (!existsSync(join(module, name))) throw new Error(`${module} has no ${name}: it is not the folder of a built module`);
  if (!/^export class Server\b/m.test(readFileSync(join(module, SCRIPT), "utf8"))) throw new Error(`the module in ${module} has no language server: build it with WASM_FEATURES=editor`);
  const options = {
    absWorkingDir: here,
    bundle: true,
    platform: "browser",
    target: "es2022",
    minify: true,
    metafile: true,
    logLevel: "warning",
    // The module is compiled by the extension, so its script needs no address of its own.
    logOverride: { "empty-import-meta": "silent" },
    alias: { okoshi_web: join(module, SCRIPT) },
  };
  const made = [
    await build({ ...options, entryPoints: ["src/web/extension.ts"], outfile: join(out, "extension.js"), format: "cjs", external: ["vscode"] }),
    await build({ ...options, entryPoints: ["src/web/worker.ts"], outfile: join(out, "server.js"), format: "iife" }),
  ];
  cpSync(join(module, CODE), join(out, CODE));
  return made.flatMap(({ metafile }) => Object.keys(metafile.inputs));
}

/** Makes the folder of the package for the web, from what `build.mjs` made for all. */
export async function stageWeb(module, folder) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(join(folder, "dist"), { recursive: true });
  const inputs = await bundleWeb(module, join(folder, "dist", "web"));
  for (const name of ["page", "syntaxes"]) cpSync(join(dist, name), join(folder, "dist", name), { recursive: true });
  for (const name of ["snippets", "walkthrough", "icon.png", "README.md", "LICENSE.txt"]) cpSync(join(here, name), join(folder, name), { recursive: true });
  writeFileSync(join(folder, "dist", "NOTICES.txt"), `The extension contains these packages.\n${licences(here, inputs)}`);
  if (existsSync(join(module, CRATES))) cpSync(join(module, CRATES), join(folder, "dist", CRATES));
  else console.warn(`${module} has no ${CRATES}: before you hand the package on, print it with editors/web/scripts/crates.mjs`);
  const manifest = webManifest(JSON.parse(readFileSync(join(here, "package.json"), "utf8")));
  writeFileSync(join(folder, "package.json"), `${JSON.stringify(manifest, null, 2)}\n`);
}
