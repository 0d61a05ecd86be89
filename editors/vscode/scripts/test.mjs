// All tests of the extension that need no editor: `npm test`. Installs, checks types, packages, and checks the result.
// OKOSHI names a binary that compiles the snippets, OKOSHI_MODULE the folder of a built module for the package for the web; without them the
// tests that need these are skipped. Only the tests of some files are run if their names, without `.test.ts`, are given.

import { spawnSync } from "node:child_process";
import { chmodSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { pack, packWeb, prepare } from "./package.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const named = ["OKOSHI", "OKOSHI_MODULE"].filter((name) => process.env[name]);
const paths = Object.fromEntries(named.map((name) => [name, resolve(process.env[name])]));
const only = process.argv.slice(2);
process.chdir(here);
prepare();
pack("okoshi.vsix");
if (paths.OKOSHI_MODULE) await packWeb(join(here, "okoshi-web.vsix"), paths.OKOSHI_MODULE);
// A package with a program: a small one that says its name.
const room = mkdtempSync(join(tmpdir(), "okoshi-vsix-"));
const program = join(room, "okoshi");
writeFileSync(program, "#!/bin/sh\necho okoshi 1.2.3\n");
// As programs are that were unpacked without their rights.
chmodSync(program, 0o644);
pack("okoshi-with-program.vsix", program);
rmSync(room, { recursive: true });

const { build } = await import("esbuild");
const out = join("dist", "test");
await build({
  entryPoints: readdirSync("test").filter((name) => name.endsWith(".test.ts") && (only.length === 0 || only.includes(name.replace(".test.ts", "")))).map((name) => join("test", name)),
  outdir: out,
  outExtension: { ".js": ".cjs" },
  bundle: true,
  platform: "node",
  format: "cjs",
  target: "node20",
  logLevel: "warning",
});
const files = readdirSync(out).sort().map((name) => join(out, name));
const { status } = spawnSync(process.execPath, ["--test", "--test-reporter=spec", ...files], { stdio: "inherit", env: { ...process.env, ...paths } });
rmSync(out, { recursive: true, force: true });
process.exit(status ?? 1);
