// Runs the Khronos validator over glTF files: `node validate.mjs [-v] FILE…`
// Prints one line per file, followed by errors and warnings; with -v also infos and hints. Exit status 1 on any error or warning.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const validator = createRequire(import.meta.url)("gltf-validator");
const SEVERITIES = ["error", "warning", "info", "hint"];

const verbose = process.argv.includes("-v");
const files = process.argv.slice(2).filter((argument) => argument !== "-v");
if (files.length === 0) {
  console.error("usage: node validate.mjs [-v] FILE…");
  process.exit(2);
}

let bad = 0;
for (const file of files) {
  try {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { uri: file, maxIssues: 0 });
    const { numErrors, numWarnings, numInfos, messages } = report.issues;
    const { info } = report;
    console.log(
      `${numErrors + numWarnings === 0 ? "ok " : "BAD"} ${file}: ${numErrors} errors, ${numWarnings} warnings, ` +
        `${numInfos} infos; ${info?.totalTriangleCount ?? 0} triangles, ${info?.materialCount ?? 0} materials`,
    );
    const shown = messages.filter(({ severity }) => verbose || severity < 2);
    for (const { severity, code, message, pointer = "" } of shown.slice(0, 20)) {
      console.log(`    ${SEVERITIES[severity]} ${code} ${pointer}: ${message}`);
    }
    if (shown.length > 20) console.log(`    and ${shown.length - 20} more`);
    if (numErrors + numWarnings > 0) bad += 1;
  } catch (error) {
    // The validator throws if the file is not glTF at all.
    console.log(`BAD ${file}: ${error.message ?? error}`);
    bad += 1;
  }
}
console.log(`${files.length} files, ${bad} bad`);
process.exit(bad === 0 ? 0 : 1);
