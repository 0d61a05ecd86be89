// Bundles the page into dist/: page.html, page.js and page.css, which need no other files.

import { copyFileSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";
import { licences } from "./licences.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const dist = join(here, "dist");

/** Bundles a script, and its style sheets if it has some, as NAME.js and NAME.css in a folder; `more` are further options of esbuild. */
export async function script(name, source, folder, more = {}) {
  const { metafile } = await build({
    absWorkingDir: here,
    entryPoints: { [name]: source },
    outdir: folder,
    bundle: true,
    format: "iife",
    target: ["es2022", "chrome111", "firefox115", "safari16.4"],
    minify: true,
    // The full licences are added below, so the short comments are removed.
    legalComments: "none",
    charset: "utf8",
    metafile: true,
    logLevel: "warning",
    ...more,
  });
  const file = join(folder, `${name}.js`);
  const inputs = Object.entries(metafile.outputs[relative(here, file).replaceAll("\\", "/")].inputs);
  const notices = licences(here, inputs.filter(([, { bytesInOutput }]) => bytesInOutput > 0).map(([name]) => name)).replaceAll("*/", "* /");
  if (notices !== "") writeFileSync(file, `/*!\nThis file contains these packages.\n${notices}*/\n${readFileSync(file, "utf8")}`);
}

/** Bundles the page into a folder. */
export async function bundle(folder = dist) {
  mkdirSync(folder, { recursive: true });
  await script("page", "src/main.ts", folder);
  copyFileSync(join(here, "src", "page.html"), join(folder, "page.html"));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  await bundle();
  // okoshi in the browser may be in a folder beside the page.
  for (const { name } of readdirSync(dist, { withFileTypes: true }).filter((one) => one.isFile())) {
    const file = join(dist, name);
    console.log(`dist/${name}: ${statSync(file).size} bytes, ${gzipSync(readFileSync(file)).length} gzipped`);
  }
}
