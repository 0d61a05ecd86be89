// All tests: `npm test`. Checks types, bundles the page, and tests it: its modules alone, and the page in Chromium with a host of the
// tests' own. OKOSHI is the program that builds models (default: the repository's own build), CHROMIUM the browser; without one of
// them the browser tests are skipped with a message. With BROWSER=firefox they run in Firefox, which FIREFOX names and which needs a
// screen (`BROWSER=firefox xvfb-run -a npm test -- app.`). PATIENCE is the limit of every wait of the browser tests in seconds, for slow
// machines. Takes Node 20.14 or newer.

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
install();

const check = spawnSync("npx", ["--no-install", "tsc", "--noEmit"], { stdio: "inherit", shell: process.platform === "win32" });
if (check.status !== 0) process.exit(check.status ?? 1);
const { bundle } = await import("./build.mjs");
await bundle();

const { build } = await import("esbuild");
// Pictures of the manual that an earlier run made say nothing about this one.
rmSync(join("test", "out", "manual"), { recursive: true, force: true });
// Inside the package, so that imports in tests are resolved from there.
const out = join("test", "out", "js");
rmSync(out, { recursive: true, force: true });
const wanted = process.argv.slice(2);
const names = readdirSync("test").filter((name) => name.endsWith(".test.ts") && (wanted.length === 0 || wanted.some((one) => name.includes(one))));
await build({
  entryPoints: names.map((name) => join("test", name)),
  outdir: out,
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
if (module && existsSync(module) && names.some((name) => readFileSync(join("test", name), "utf8").includes("inBrowser("))) {
  process.env.OKOSHI_APP = join(here, "test", "out", "app");
  const { app } = await import("./app.mjs");
  await app(process.env.OKOSHI_APP, resolve(module));
}
const files = readdirSync(out).sort().map((name) => join(out, name));
const env = { ...process.env, ...(okoshi ? { OKOSHI: okoshi } : {}) };
// Files end when their tests have, whatever those left open; one that still does not end is ended after an hour.
const ending = ["--test-force-exit", `--test-timeout=${60 * 60 * 1000}`];
const { status } = spawnSync(process.execPath, ["--test", ...ending, "--test-reporter=spec", ...files], { stdio: "inherit", env });
process.exit(status ?? 1);
