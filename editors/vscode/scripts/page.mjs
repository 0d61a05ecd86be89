// The page of the preview, which `okoshi preview` serves too: bundled by its own scripts in ../web if it is missing or older than its
// sources.

import { existsSync, readdirSync, statSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const web = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "web");

/** Bundles the page if necessary. Returns the folder of page.html, page.js and page.css. */
export async function page() {
  const dist = join(web, "dist");
  const age = (file) => statSync(file).mtimeMs;
  const sources = ["src", "scripts"].flatMap((folder) =>
    readdirSync(join(web, folder), { recursive: true, withFileTypes: true })
      .filter((entry) => entry.isFile())
      .map((entry) => join(entry.parentPath, entry.name)),
  );
  const newest = Math.max(...[...sources, join(web, "package-lock.json")].map(age));
  const there = ["page.html", "page.js", "page.css"].map((name) => join(dist, name));
  // The bundled script is newer than all of its sources; the page and its style may be copies with old times.
  if (there.every(existsSync) && age(join(dist, "page.js")) >= newest) return dist;
  const { install } = await import("../../web/scripts/install.mjs");
  install();
  const { bundle } = await import("../../web/scripts/build.mjs");
  await bundle();
  return dist;
}
