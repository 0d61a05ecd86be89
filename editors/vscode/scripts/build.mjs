// Bundles the extension into dist/ and adds what the package takes from elsewhere in the repository: the page of the preview, the
// grammars generated from the keyword table, and the licences.

import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { licences } from "../../web/scripts/licences.mjs";
import { page } from "./page.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const repository = join(here, "..", "..");
const dist = join(here, "dist");

rmSync(dist, { recursive: true, force: true });
mkdirSync(join(dist, "syntaxes"), { recursive: true });
for (const name of ["okoshi", "okoshi-injection"]) {
  cpSync(join(repository, "grammar", `${name}.tmLanguage.json`), join(dist, "syntaxes", `${name}.tmLanguage.json`));
}
const made = await page();
mkdirSync(join(dist, "page"));
for (const name of ["page.html", "page.js", "page.css"]) cpSync(join(made, name), join(dist, "page", name));
const licence = (name) => readFileSync(join(repository, name), "utf8").trim();
writeFileSync(
  join(here, "LICENSE.txt"),
  `Licensed under either of the MIT License or the Apache License 2.0, at your choice.\n\n${licence("LICENSE-MIT")}\n\n${licence("LICENSE-APACHE")}\n`,
);

const { metafile } = await build({
  absWorkingDir: here,
  entryPoints: ["src/extension.ts"],
  outfile: "dist/extension.js",
  bundle: true,
  platform: "node",
  format: "cjs",
  target: "node20",
  external: ["vscode"],
  minify: true,
  metafile: true,
  logLevel: "warning",
});

writeFileSync(join(dist, "NOTICES.txt"), `The extension contains these packages.\n${licences(here, Object.keys(metafile.inputs))}`);
