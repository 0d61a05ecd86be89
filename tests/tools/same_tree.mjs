// Compares the trees of built models in Blender with `okoshi inspect --json` of their drawings:
// `node same_tree.mjs TREES.json`, where the inspection of a/b.glb is a/b.json.
//
// Every main part must be a node with the parent that inspect gives it, and every node must be a main part, a copy of
// one (`Name.back`), a bone inside such a part, or part of a terrain or a billboard, whose inner nodes inspect does not
// list. What hangs on a part that bends may hang on a bone of it.

import { readFileSync } from "node:fs";

const ROOT = "Root";

// Blender truncates names to 63 bytes.
const inBlender = (name) => {
  const bytes = Buffer.from(name);
  if (bytes.length <= 63) return name;
  let end = 63;
  while ((bytes[end] & 0xc0) === 0x80) end -= 1;
  return bytes.subarray(0, end).toString();
};

const withoutBack = (name) => name.replace(/(\.back)+$/, "");

function differences(nodes, inspection) {
  const found = [];
  const owners = new Map(nodes.filter((node) => node.bone_of !== null).map((node) => [node.name, node.bone_of]));
  // The nodes but for bones inside parts, each with what it hangs on.
  const parents = new Map(
    nodes.filter(({ name }) => !owners.has(name)).map(({ name, parent }) => [name, owners.get(parent) ?? parent]),
  );
  for (const { name, parent, bone_of: owner } of nodes) {
    if (owner !== null && parent !== owner && owners.get(parent) !== owner) {
      found.push(`bone ${name} of ${owner} hangs on ${parent}`);
    }
  }
  const expected = new Map(
    inspection.parts
      .filter(({ kind }) => kind === "main")
      .map(({ name, parent }) => [inBlender(name), inBlender(parent ?? ROOT)]),
  );
  const others = [...(inspection.terrain ?? []), ...(inspection.billboards ?? [])].map(({ name }) => inBlender(name));

  if (parents.get(ROOT) !== null) found.push(`no node ${ROOT} at the top`);
  for (const [name, parent] of expected) {
    if (!parents.has(name)) found.push(`part ${name} is no node`);
    else if (parents.get(name) !== parent) found.push(`node ${name} hangs on ${parents.get(name)}, not on ${parent}`);
  }
  const belongs = (name) => {
    for (let at = name; at; at = parents.get(at)) if (others.includes(at)) return true;
    return false;
  };
  for (const [name, parent] of parents) {
    if (name === ROOT || expected.has(name) || belongs(name)) continue;
    const original = withoutBack(name);
    if (original === name || !expected.has(original)) found.push(`node ${name} is no part`);
    else if (withoutBack(parent ?? "") !== expected.get(original)) found.push(`copy ${name} hangs on ${parent}`);
  }
  return found;
}

let bad = 0;
const trees = JSON.parse(readFileSync(process.argv[2], "utf8"));
for (const { file, nodes } of trees) {
  const inspection = JSON.parse(readFileSync(file.replace(/\.[^.]*$/, ".json"), "utf8"));
  const found = differences(nodes, inspection);
  const triangles = nodes.reduce((sum, node) => sum + node.triangles, 0);
  console.log(`${found.length === 0 ? "ok " : "BAD"} ${file}: ${nodes.length} nodes, ${triangles} triangles`);
  for (const difference of found.slice(0, 20)) console.log(`    ${difference}`);
  if (found.length > 20) console.log(`    and ${found.length - 20} more`);
  if (found.length > 0) bad += 1;
}
console.log(`${trees.length} models, ${bad} differ`);
process.exit(bad === 0 ? 0 : 1);
