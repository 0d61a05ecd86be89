// Creates the package, from a clean clone too: installs the locked dependencies, checks types, bundles, packages. Same sources, same
// bytes: the archive's times are fixed unless SOURCE_DATE_EPOCH is set.
//
//   node scripts/package.mjs [OUTPUT [PROGRAM]]
//   node scripts/package.mjs OUTPUT --web MODULE
//
// OUTPUT is okoshi.vsix, for all systems, unless another is named. With PROGRAM the package brings that program, and is for the system and
// the processor that this runs on. With MODULE, the folder of a built module, it brings that, and is for VS Code for the Web.

import { spawnSync } from "node:child_process";
import { chmodSync, copyFileSync, mkdirSync, rmSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { install } from "../../web/scripts/install.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const env = { SOURCE_DATE_EPOCH: "315619200", ...process.env };

/** Options of every package. */
const PACKAGE = ["vsce", "package", "--no-dependencies", "--allow-missing-repository", "--allow-unused-files-pattern"];

function run(command, ...args) {
  runIn(here, command, ...args);
}

function runIn(cwd, command, ...args) {
  console.log(`> ${command} ${args.join(" ")}`);
  const { status, error } = spawnSync(command, args, { cwd, env, stdio: "inherit", shell: process.platform === "win32" });
  if (error) throw error;
  if (status !== 0) process.exit(status ?? 1);
}

/** Installs what the package is built with, checks, and bundles. */
export function prepare() {
  install(here);
  run("npx", "--no-install", "tsc", "--noEmit");
  run("npx", "--no-install", "tsc", "--noEmit", "-p", "tsconfig.web.json");
  run("node", "scripts/build.mjs");
}

/** Packages what `prepare` bundled, with a program if its path is given. */
export function pack(output, program) {
  const bin = join(here, "bin");
  rmSync(bin, { recursive: true, force: true });
  const target = program === undefined ? [] : ["--target", `${process.platform}-${process.arch}`];
  try {
    if (program !== undefined) {
      const copy = join(bin, process.platform === "win32" ? "okoshi.exe" : "okoshi");
      mkdirSync(bin);
      copyFileSync(program, copy);
      chmodSync(copy, 0o755);
    }
    // Without a program, no file is in `bin`.
    run("npx", "--no-install", ...PACKAGE, ...target, "-o", output);
  } finally {
    rmSync(bin, { recursive: true, force: true });
  }
}

/** Packages the extension for VS Code for the Web, with a module. */
export async function packWeb(output, module) {
  const folder = join(here, "web-package");
  try {
    // It imports packages that `prepare` installs.
    const { stageWeb } = await import("./web.mjs");
    await stageWeb(module, folder);
    runIn(folder, "npx", "--no-install", ...PACKAGE, "--target", "web", "-o", output);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [, , output, ...brings] = process.argv;
  const [program, module] = brings[0] === "--web" ? [undefined, brings[1]] : [brings[0], undefined];
  const file = resolve(output ?? join(here, "okoshi.vsix"));
  prepare();
  if (module !== undefined) await packWeb(file, resolve(module));
  else pack(file, program && resolve(program));
}
