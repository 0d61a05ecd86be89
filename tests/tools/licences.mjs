// Checks that all dependencies of the program have permissive licences; needs no network:
// `cargo metadata … | node licences.mjs [PACKAGE-LOCK.json…]`

import { readFileSync } from "node:fs";

const PERMISSIVE = new Set([
  "0BSD", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "CC0-1.0",
  "CDLA-Permissive-2.0", "ISC", "MIT", "MIT-0", "NCSA", "Unicode-3.0", "Unicode-DFS-2016", "Unlicense", "Zlib",
]);

// SPDX expressions: OR binds looser than AND; `MIT/Apache-2.0` is an old way to write OR.
function permissive(expression) {
  const tokens = expression.replaceAll("/", " OR ").replace(/[()]/g, " $& ").trim().split(/\s+/);
  let at = 0;
  const either = () => {
    let good = both();
    while (tokens[at] === "OR") {
      at += 1;
      good = both() || good;
    }
    return good;
  };
  const both = () => {
    let good = one();
    while (tokens[at] === "AND") {
      at += 1;
      good = one() && good;
    }
    return good;
  };
  const one = () => {
    if (tokens[at] === "(") {
      at += 1;
      const good = either();
      at += 1;
      return good;
    }
    let licence = tokens[at++] ?? "";
    if (tokens[at] === "WITH") {
      licence += ` WITH ${tokens[at + 1]}`;
      at += 2;
    }
    return PERMISSIVE.has(licence);
  };
  return either() && at === tokens.length;
}

const { packages, resolve } = JSON.parse(readFileSync(0, "utf8"));
const used = new Set(resolve.nodes.map(({ id }) => id));
const all = packages
  .filter(({ id }) => used.has(id))
  .map(({ name, version, license }) => ({ name: `${name} ${version}`, licence: license }));
for (const lock of process.argv.slice(2)) {
  for (const [path, { version, license }] of Object.entries(JSON.parse(readFileSync(lock, "utf8")).packages)) {
    if (path !== "") all.push({ name: `${path.replace(/^.*node_modules\//, "")} ${version} (npm)`, licence: license });
  }
}
const bad = all.filter(({ licence }) => !licence || !permissive(licence));
for (const { name, licence } of bad) console.log(`BAD ${name}: ${licence ?? "no licence named"}`);
console.log(`${all.length} packages, ${bad.length} without a permissive licence`);
process.exit(bad.length === 0 ? 0 : 1);
