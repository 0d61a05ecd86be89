// The tools of the workbench tests: code-server, a matching Node.js, playwright-core and Chromium.

import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { delimiter, join } from "node:path";
import { pathToFileURL } from "node:url";
import { PATIENCE } from "./editor.mjs";

const CODE_SERVER = "code-server@4.139.1";
const NODE = "node@24";
const PLAYWRIGHT = "playwright-core@1";

export function run(command, args, options = {}) {
  const { status, error, stdout, stderr } = spawnSync(command, args, { encoding: "utf8", ...options });
  if (error) throw error;
  if (status !== 0) throw new Error(`${command} ${args.join(" ")} ended with ${status}\n${stdout ?? ""}${stderr ?? ""}`);
  return stdout;
}

/** Installs a package into a folder of its own in the cache, once. Returns its node_modules. */
function installed(cache, name, env = {}) {
  const folder = join(cache, name.replace(/@[^@]*$/, ""));
  const modules = join(folder, "node_modules");
  const done = join(folder, "done");
  if (!existsSync(done)) {
    console.log(`installing ${name} into ${folder}`);
    mkdirSync(folder, { recursive: true });
    run("npm", ["install", "--no-audit", "--no-fund", "--no-package-lock", "--prefix", folder, name], {
      stdio: "inherit",
      // By the agent of the npm that runs this, a package would see that one's Node.js.
      env: { ...process.env, npm_config_user_agent: undefined, ...env },
    });
    writeFileSync(done, name);
  }
  return modules;
}

/**
 * Finds or installs the tools: `NODE24` is a folder with bin/node, `CODE_SERVER` the folder of the code-server package, `CHROMIUM` a
 * browser. Those that are not set are installed into the cache by npm, except the browser.
 */
export async function tools(cache) {
  const node = process.env.NODE24 ?? join(installed(cache, NODE), "node", "node_modules", `node-${process.platform}-${process.arch}`);
  const path = `${join(node, "bin")}${delimiter}${process.env.PATH}`;
  // Its native modules are compiled, which needs the headers in the node package, and libkrb5-dev.
  const server = process.env.CODE_SERVER ?? join(installed(cache, CODE_SERVER, { PATH: path, npm_config_nodedir: node }), "code-server");
  const browser = [process.env.CHROMIUM, ...["chromium", "chromium-browser", "google-chrome"].map(inPath)].find((one) => one);
  if (!browser) throw new Error("There is no Chromium: install it, or name one by CHROMIUM=");
  const { chromium } = await import(pathToFileURL(join(installed(cache, PLAYWRIGHT), "playwright-core", "index.mjs")).href);
  return { node: join(node, "bin", "node"), server: join(server, "out", "node", "entry.js"), browser, chromium };
}

function inPath(name) {
  return process.env.PATH.split(delimiter).map((folder) => join(folder, name)).find((file) => existsSync(file));
}

function freePort() {
  return new Promise((resolve, reject) => {
    const probe = createServer();
    probe.on("error", reject);
    probe.listen(0, "127.0.0.1", () => {
      const { port } = probe.address();
      probe.close(() => resolve(port));
    });
  });
}

/** Starts a code-server with extensions on a free port. `stop` ends it. */
export async function codeServer({ node, server }, { packages, data, extensions, env }) {
  const folders = ["--user-data-dir", data, "--extensions-dir", extensions];
  run(node, [server, ...folders, ...packages.flatMap((vsix) => ["--install-extension", vsix])], { env: { ...process.env, ...env } });
  const port = await freePort();
  const options = ["--auth", "none", "--bind-addr", `127.0.0.1:${port}`, "--disable-telemetry", "--disable-update-check", "--disable-workspace-trust"];
  const child = spawn(node, [server, ...folders, ...options], { env: { ...process.env, ...env }, detached: true, stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (piece) => (said += piece));
  const stop = () => {
    try {
      // Including its children.
      process.kill(-child.pid, "SIGTERM");
    } catch {
      // It has exited already.
    }
  };
  const address = `127.0.0.1:${port}`;
  const end = Date.now() + PATIENCE;
  for (;;) {
    if (child.exitCode !== null || Date.now() > end) {
      stop();
      throw new Error(`code-server did not start:\n${said}`);
    }
    const up = await fetch(`http://${address}/healthz`).then(({ ok }) => ok, () => false);
    if (up) return { address, stop, said: () => said };
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
}
