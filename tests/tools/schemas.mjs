// Checks JSON against a schema, and that it has one type for each key: `node schemas.mjs SCHEMA FILE…`
// Exit status 1 if a file does not follow the schema, or if a key of the schema is in none of the files.

import { readFileSync } from "node:fs";
import Ajv from "ajv/dist/2020.js";

const [schemaFile, ...files] = process.argv.slice(2);
if (files.length === 0) {
  console.error("usage: node schemas.mjs SCHEMA FILE…");
  process.exit(2);
}

const json = (file) => JSON.parse(readFileSync(file, "utf8"));
const schema = json(schemaFile);
const validate = new Ajv({ allErrors: true, allowUnionTypes: true, strictRequired: false }).compile(schema);

const typeOf = (value) => (Array.isArray(value) ? "array" : typeof value);

/** The types of each key over all files, `null` aside. Keys of dictionaries are not part of the language. */
const types = new Map();
function note(value, schema) {
  if (schema.$ref) return note(value, resolve(schema.$ref));
  if (schema.anyOf) return schema.anyOf.filter((one) => one.type !== "null").forEach((one) => value === null || note(value, one));
  if (Array.isArray(value)) return value.forEach((item) => note(item, schema.items ?? {}));
  if (value === null || typeof value !== "object") return;
  for (const [key, inner] of Object.entries(value)) {
    if (schema.properties?.[key] && inner !== null) types.set(key, (types.get(key) ?? new Set()).add(typeOf(inner)));
    note(inner, schema.properties?.[key] ?? schema.additionalProperties ?? {});
  }
}
const resolve = (pointer) => pointer.slice(2).split("/").reduce((inner, key) => inner[key], schema);

function keysOf(schema, into = new Set()) {
  for (const [key, inner] of Object.entries(schema.properties ?? {})) keysOf(inner, into.add(key));
  for (const inner of [schema.items, schema.additionalProperties, ...(schema.anyOf ?? []), ...Object.values(schema.$defs ?? {})]) {
    if (typeof inner === "object") keysOf(inner, into);
  }
  return into;
}

let bad = 0;
for (const file of files) {
  const value = json(file);
  if (!validate(value)) {
    bad += 1;
    for (const { instancePath, message, params } of validate.errors.slice(0, 10)) console.log(`${file}${instancePath}: ${message} ${JSON.stringify(params)}`);
  }
  note(value, schema);
}
for (const [key, found] of types) {
  if (found.size > 1) {
    console.log(`\`${key}\` has the types ${[...found].join(", ")}`);
    bad += 1;
  }
}
for (const key of keysOf(schema)) {
  if (!types.has(key)) {
    console.log(`no file has \`${key}\`: add a drawing that does`);
    bad += 1;
  }
}
console.log(`${files.length} files against ${schema.title}: ${bad} bad`);
process.exit(bad === 0 ? 0 : 1);
