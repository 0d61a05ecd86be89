// The licences of the packages that are bundled into the page and into the extension.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";

/** What may be bundled. */
const PERMISSIVE = new Set(["0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "BlueOak-1.0.0", "ISC", "MIT"]);

/** The licences of the packages among `inputs`, which are paths from a folder. */
export function licences(folder, inputs) {
  const packages = inputs.flatMap((input) => /^(?:.*\/)?node_modules\/(?:@[^/]+\/)?[^/]+/.exec(input) ?? []);
  let text = "";
  for (const own of [...new Set(packages)].sort()) {
    const { name, version, license } = JSON.parse(readFileSync(join(folder, own, "package.json"), "utf8"));
    if (!PERMISSIVE.has(license)) throw new Error(`${name} ${version} is bundled, and its licence is ${license}`);
    const file = readdirSync(join(folder, own)).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name} ${version} is bundled, and has no file with its licence`);
    const licence = readFileSync(join(folder, own, file), "utf8").replace(/\r\n/g, "\n").trim();
    text += `\n==== ${name} ${version} (${license})\n\n${licence}\n`;
  }
  return text;
}
