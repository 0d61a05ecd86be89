// Counts the documented public items of the library, methods included: `node public_items.mjs DOC-FOLDER MOST`
// Exit status 1 if there are more than MOST: what a program that embeds okoshi does not need is hidden, or not public.

import { readFileSync } from "node:fs";
import { join } from "node:path";

const [folder, most] = process.argv.slice(2);
if (most === undefined) {
  console.error("usage: node public_items.mjs DOC-FOLDER MOST");
  process.exit(2);
}

// The list of all items, without the pages of hidden ones.
const listed = readFileSync(join(folder, "all.html"), "utf8");
const pages = new Set([...listed.matchAll(/<li><a href="([^"#]+\.html)">/g)].map(([, page]) => page));
const counts = new Map();
const add = (kind, count) => counts.set(kind, (counts.get(kind) ?? 0) + count);
for (const page of pages) {
  const [kind] = page.split("/").at(-1).split(".");
  add(kind, 1);
  // Methods of the type itself: those of traits that it implements come after the next heading.
  const [own] = readFileSync(join(folder, page), "utf8").split(/id="(?:trait|synthetic|blanket)-implementations"/);
  add("method", (own.match(/<section id="(method|tymethod)\./g) ?? []).length);
}
const all = [...counts.values()].reduce((sum, count) => sum + count, 0);
console.log(`${all} public items: ${[...counts].map(([kind, count]) => `${count} ${kind}`).join(", ")}`);
if (all > Number(most)) {
  console.log(`more than ${most}: hide what embedding okoshi does not need, or make it private to the crate`);
  process.exit(1);
}
if (all === 0) {
  console.log("no documentation was found");
  process.exit(1);
}
