// Prints the licences of the Rust packages in the module: `node crates.mjs MANIFEST`. Cargo has their sources when the module is built.

import { spawnSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join, resolve } from "node:path";

const [manifest] = process.argv.slice(2);
if (!manifest) {
  console.error("usage: node crates.mjs MANIFEST");
  process.exit(2);
}
const options = ["metadata", "--format-version", "1", "--locked", "--filter-platform", "wasm32-unknown-unknown", "--manifest-path", resolve(manifest)];
const { status, stdout } = spawnSync("cargo", options, { encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "inherit"] });
if (status !== 0) process.exit(status ?? 1);
const { packages, resolve: resolved } = JSON.parse(stdout);
const nodes = new Map(resolved.nodes.map((node) => [node.id, node]));

// What is only needed to build is not in the module.
const used = new Set();
const visit = (id) => {
  if (used.has(id)) return;
  used.add(id);
  for (const { pkg, dep_kinds } of nodes.get(id).deps) if (dep_kinds.some(({ kind }) => kind === null)) visit(pkg);
};
visit(resolved.root);

/** The texts of licences, with the packages that have them: many have the same. */
const texts = new Map();
for (const { id, name, version, license, source, manifest_path } of packages) {
  // The program's own licences are beside this file.
  if (!used.has(id) || source === null) continue;
  const folder = dirname(manifest_path);
  const files = readdirSync(folder).filter((file) => /^(licen[cs]e|copying|notice|unlicense)/i.test(file)).sort();
  for (const text of files.length > 0 ? files.map((file) => readFileSync(join(folder, file), "utf8").replace(/\r\n/g, "\n").trim()) : [`Licence: ${license}`]) {
    texts.set(text, [...(texts.get(text) ?? []), `${name} ${version} (${license})`]);
  }
}
console.log("The module contains these packages.");
for (const [text, names] of texts) console.log(`\n==== ${names.join(", ")}\n\n${text}`);
