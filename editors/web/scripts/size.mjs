// Prints how large a module is, as it is and as static hosts send it, and fails if that is over a budget in MB: `node size.mjs MODULE.wasm BUDGET`.

import { readFileSync } from "node:fs";
import { brotliCompressSync, constants } from "node:zlib";

const [module, budget] = process.argv.slice(2);
if (!module || !(Number(budget) > 0)) {
  console.error("usage: node size.mjs MODULE.wasm BUDGET");
  process.exit(2);
}
const bytes = readFileSync(module);
// The best that Brotli does, as hosts do with files that they compress once.
const params = { [constants.BROTLI_PARAM_QUALITY]: constants.BROTLI_MAX_QUALITY, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length };
const packed = brotliCompressSync(bytes, { params }).length;
const inMegabytes = (length) => (length / 1e6).toFixed(2);
console.log(`${module}: ${inMegabytes(bytes.length)} MB, ${inMegabytes(packed)} MB with Brotli`);
if (packed > budget * 1e6) {
  console.error(`error: the module is too large: ${inMegabytes(packed)} MB with Brotli, and at most ${budget} MB are allowed. docs/speed.md says what was tried.`);
  process.exit(1);
}
