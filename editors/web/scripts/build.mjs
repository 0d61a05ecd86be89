// Bundles the page into dist/: page.html, page.js and page.css, which need no other files.

import { copyFileSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";
import { licences } from "./licences.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const dist = join(here, "dist");

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
  const notices = `This file contains these packages.\n${licences(here, used)}`.replaceAll("*/", "* /");
  writeFileSync(script, `/*!\n${notices}*/\n${readFileSync(script, "utf8")}`);
  copyFileSync(join(here, "src", "page.html"), join(dist, "page.html"));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  await bundle();
  for (const name of readdirSync(dist)) {
    const file = join(dist, name);
    console.log(`dist/${name}: ${statSync(file).size} bytes, ${gzipSync(readFileSync(file)).length} gzipped`);
  }
}
