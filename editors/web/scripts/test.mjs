// All tests: `npm test`. Checks types, bundles the page, and tests it: its modules alone, and the page in Chromium with a host of the
// tests' own. OKOSHI is the program that builds models (default: the repository's own build), CHROMIUM the browser; without one of
// them the browser tests are skipped with a message. With BROWSER=firefox they run in Firefox, which FIREFOX names and which needs a
// screen (`BROWSER=firefox xvfb-run -a npm test -- app.`). PATIENCE is the limit of every wait of the browser tests in seconds, for slow
// machines. With OKOSHI_HOST=worker the tests of editing have the module in OKOSHI_MODULE for a host instead of the program. OKOSHI_OUT is
// the folder for what the tests make (default: test/out), which lets several runs go on at the same time: `--bundle` only installs, checks
// and bundles, which is done one at a time, and `--run` only tests what was bundled. Takes Node 20.14 or newer.

import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { install } from "./install.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const repository = join(here, "..", "..");
const target = process.env.CARGO_TARGET_DIR ?? join(repository, "target");
const programs = [process.env.OKOSHI && resolve(process.env.OKOSHI), join(target, "debug", "okoshi"), join(target, "release", "okoshi")];
const okoshi = programs.find((path) => path && existsSync(path));
process.chdir(here);
const onlyBundles = process.argv.includes("--bundle");
const onlyRuns = process.argv.includes("--run");
const wanted = process.argv.slice(2).filter((one) => !one.startsWith("--"));
const OUT = process.env.OKOSHI_OUT ?? join("test", "out");
// Inside the package, so that imports in tests are resolved from there.
const bundles = join(OUT, "js");
const folder = join(OUT, "static");
// A page of its own, which no other run bundles anew while a test reads it.
const page = join(OUT, "dist");

if (!onlyRuns) await bundleAll();
if (!onlyBundles) process.exit(run());

async function bundleAll() {
  install();
  const check = spawnSync("npx", ["--no-install", "tsc", "--noEmit"], { stdio: "inherit", shell: process.platform === "win32" });
  if (check.status !== 0) process.exit(check.status ?? 1);
  const { bundle } = await import("./build.mjs");
  await bundle(resolve(page));

  const { build } = await import("esbuild");
  // Pictures of the manual that an earlier run made say nothing about this one.
  for (const earlier of [join(OUT, "manual"), bundles, folder]) rmSync(earlier, { recursive: true, force: true });
  const names = readdirSync("test").filter((name) => name.endsWith(".test.ts") && (wanted.length === 0 || wanted.some((one) => name.includes(one))));
  await build({
    entryPoints: names.map((name) => join("test", name)),
    outdir: bundles,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node20",
    packages: "external",
    logLevel: "warning",
  });
  // The folder of the program in the browser, in which the module has drawn pictures, takes long to make.
  const module = process.env.OKOSHI_MODULE;
  const needs = process.env.OKOSHI_HOST === "worker" || names.some((name) => readFileSync(join("test", name), "utf8").includes("inBrowser("));
  if (module && existsSync(module) && needs) {
    const { app } = await import("./app.mjs");
    await app(folder, resolve(module));
  }
}

/** Runs what was bundled; returns the exit status. */
function run() {
  const files = readdirSync(bundles).sort().map((name) => join(bundles, name));
  const env = { ...process.env, ...(okoshi ? { OKOSHI: okoshi } : {}), ...(existsSync(folder) ? { OKOSHI_APP: resolve(folder) } : {}) };
  // Files end when their tests have, whatever those left open; one that still does not end is ended after an hour.
  const ending = ["--test-force-exit", `--test-timeout=${60 * 60 * 1000}`];
  return spawnSync(process.execPath, ["--test", ...ending, "--test-reporter=spec", ...files], { stdio: "inherit", env }).status ?? 1;
}
