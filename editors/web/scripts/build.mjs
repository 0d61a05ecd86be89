// Bundles the page into dist/: page.html, page.js and page.css, which need no other files.

import { copyFileSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const dist = join(here, "dist");

/** What may be bundled. */
const PERMISSIVE = new Set(["0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "BlueOak-1.0.0", "ISC", "MIT"]);

/** The licences of the packages among `inputs`, as one comment. */
function notices(inputs) {
  const packages = new Set();
  for (const input of inputs) {
    const found = /^(?:.*\/)?node_modules\/(?:@[^/]+\/)?[^/]+/.exec(input);
    if (found) packages.add(found[0]);
  }
  let text = "This file contains these packages.\n";
  for (const folder of [...packages].sort()) {
    const { name, version, license } = JSON.parse(readFileSync(join(here, folder, "package.json"), "utf8"));
    if (!PERMISSIVE.has(license)) throw new Error(`${name} ${version} is bundled, and its licence is ${license}`);
    const file = readdirSync(join(here, folder)).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name} ${version} is bundled, and has no file with its licence`);
    const licence = readFileSync(join(here, folder, file), "utf8").replace(/\r\n/g, "\n").trim();
    text += `\n==== ${name} ${version} (${license})\n\n${licence}\n`;
  }
  return `/*!\n${text.replaceAll("*/", "* /")}*/\n`;
}

export async function bundle() {
  mkdirSync(dist, { recursive: true });
  const { metafile } = await build({
    absWorkingDir: here,
    entryPoints: { page: "src/main.ts" },
    outdir: "dist",
    bundle: true,
    format: "iife",
    target: ["es2022", "chrome111", "firefox115", "safari16.4"],
    minify: true,
    // The full licences are added below, so the short comments are removed.
    legalComments: "none",
    charset: "utf8",
    metafile: true,
    logLevel: "warning",
  });
  const script = join(dist, "page.js");
  const inputs = Object.entries(metafile.outputs["dist/page.js"].inputs);
  const used = inputs.filter(([, { bytesInOutput }]) => bytesInOutput > 0).map(([name]) => name);
  writeFileSync(script, notices(used) + readFileSync(script, "utf8"));
  copyFileSync(join(here, "src", "page.html"), join(dist, "page.html"));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  await bundle();
  for (const name of readdirSync(dist)) {
    const file = join(dist, name);
    console.log(`dist/${name}: ${statSync(file).size} bytes, ${gzipSync(readFileSync(file)).length} gzipped`);
  }
}
