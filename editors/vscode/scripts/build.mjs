// Bundles the extension into dist/ and adds what the package takes from elsewhere in the repository: the page of the preview, the
// grammars generated from the keyword table, and the licences.

import { cpSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { page } from "./page.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const repository = join(here, "..", "..");
const dist = join(here, "dist");

/** What may be bundled. */
const PERMISSIVE = new Set(["0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "BlueOak-1.0.0", "ISC", "MIT"]);

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

// The licences of the bundled packages.
const packages = new Set();
for (const input of Object.keys(metafile.inputs)) {
  const found = /^(?:.*\/)?node_modules\/(?:@[^/]+\/)?[^/]+/.exec(input);
  if (found) packages.add(found[0]);
}
let notices = "The extension contains these packages.\n";
for (const folder of [...packages].sort()) {
  const { name, version, license } = JSON.parse(readFileSync(join(here, folder, "package.json"), "utf8"));
  if (!PERMISSIVE.has(license)) throw new Error(`${name} ${version} is bundled, and its licence is ${license}`);
  const file = readdirSync(join(here, folder)).find((entry) => /^licen[cs]e/i.test(entry));
  if (!file) throw new Error(`${name} ${version} is bundled, and has no file with its licence`);
  const text = readFileSync(join(here, folder, file), "utf8").replace(/\r\n/g, "\n").trim();
  notices += `\n==== ${name} ${version} (${license})\n\n${text}\n`;
}
writeFileSync(join(dist, "NOTICES.txt"), notices);
