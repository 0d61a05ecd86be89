// Creates okoshi.vsix, from a clean clone too: installs the locked dependencies, checks types, bundles, packages. Same sources, same
// bytes: the archive's times are fixed unless SOURCE_DATE_EPOCH is set.

import { spawnSync } from "node:child_process";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { install } from "../../web/scripts/install.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const env = { SOURCE_DATE_EPOCH: "315619200", ...process.env };

function run(command, ...args) {
  console.log(`> ${command} ${args.join(" ")}`);
  const { status, error } = spawnSync(command, args, { cwd: here, env, stdio: "inherit", shell: process.platform === "win32" });
  if (error) throw error;
  if (status !== 0) process.exit(status ?? 1);
}

export function pack(output) {
  install(here);
  run("npx", "--no-install", "tsc", "--noEmit");
  run("node", "scripts/build.mjs");
  run("npx", "--no-install", "vsce", "package", "--no-dependencies", "--allow-missing-repository", "-o", output);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) pack(process.argv[2] ?? "okoshi.vsix");
