// All tests of the extension that need no editor: `npm test`. Installs, checks types, packages, and checks the result.
// OKOSHI names a binary that compiles the snippets; without it that test is skipped.

import { spawnSync } from "node:child_process";
import { readdirSync, rmSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { pack } from "./package.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const okoshi = process.env.OKOSHI ? { OKOSHI: resolve(process.env.OKOSHI) } : {};
process.chdir(here);
pack("okoshi.vsix");

const { build } = await import("esbuild");
const out = join("dist", "test");
await build({
  entryPoints: readdirSync("test").filter((name) => name.endsWith(".test.ts")).map((name) => join("test", name)),
  outdir: out,
  outExtension: { ".js": ".cjs" },
  bundle: true,
  platform: "node",
  format: "cjs",
  target: "node20",
  logLevel: "warning",
});
const files = readdirSync(out).sort().map((name) => join(out, name));
const { status } = spawnSync(process.execPath, ["--test", "--test-reporter=spec", ...files], { stdio: "inherit", env: { ...process.env, ...okoshi } });
rmSync(out, { recursive: true, force: true });
process.exit(status ?? 1);
