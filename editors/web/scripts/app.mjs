// Makes the folder of files that is the whole program in a browser: `node app.mjs FOLDER MODULE`, where MODULE is the folder of the built module.

import { createHash } from "node:crypto";
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { script } from "./build.mjs";
import { lessons } from "./lessons.mjs";
import { ready } from "./ready.mjs";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const repository = join(here, "..", "..");
/** What is used of a module. */
const MODULE = ["okoshi_web.js", "okoshi_web_bg.wasm"];
const LICENCES = ["LICENSE-MIT", "LICENSE-APACHE"];
/** The licences of the packages in the module, which crates.mjs prints. */
const CRATES = "module-licences.txt";

/** Makes the folder, which is emptied of what an earlier run made; returns its files. */
export async function app(folder, module) {
  for (const name of MODULE) if (!existsSync(join(module, name))) throw new Error(`${module} has no ${name}: it is not the folder of a built module`);
  mkdirSync(folder, { recursive: true });
  // Only what is one of ours is taken away.
  const ours = /^((index|lessons)\.html|service-worker\.js|LICENSE-\w+|module-licences\.txt|v-[0-9a-f]{12})$/;
  const others = readdirSync(folder).filter((name) => !ours.test(name));
  if (others.length > 0) throw new Error(`${folder} has other files, such as ${others[0]}: name a new folder`);
  for (const name of readdirSync(folder)) rmSync(join(folder, name), { recursive: true });

  const room = join(folder, "v-000000000000");
  mkdirSync(room);
  const lesson = lessons(room);
  const made = await ready(module, room, lesson.drawings);
  await script("app", "src/app.ts", room, { define: { READY: JSON.stringify(made) } });
  await script("worker", "src/host/worker/module.ts", room, { format: "esm", external: ["./okoshi_web.js"] });
  await player(room);
  for (const name of MODULE) copyFileSync(join(module, name), join(room, name));
  // Each version has a folder of its own, so that no cache on the way mixes the files of two.
  const named = `v-${hash(room, filesIn(room))}`;
  renameSync(room, join(folder, named));
  const pages = { "index.html": readFileSync(join(here, "src", "app.html"), "utf8"), "lessons.html": lesson.page };
  for (const [name, text] of Object.entries(pages)) writeFileSync(join(folder, name), text.replaceAll("FOLDER/", `${named}/`));
  for (const name of LICENCES) copyFileSync(join(repository, name), join(folder, name));
  const hasCrates = existsSync(join(module, CRATES));
  if (hasCrates) copyFileSync(join(module, CRATES), join(folder, CRATES));
  else console.warn(`${module} has no ${CRATES}: before you hand the folder on, print it with scripts/crates.mjs`);

  const files = [...Object.keys(pages), ...LICENCES, ...(hasCrates ? [CRATES] : []), ...filesIn(join(folder, named)).map((name) => `${named}/${name}`)];
  const define = { FILES: JSON.stringify(["./", ...files]), VERSION: JSON.stringify(hash(folder, files)) };
  await script("service-worker", "src/app/service-worker.ts", folder, { define });
  return [...files, "service-worker.js"];
}

/** Makes the page that shows a model by itself, in one file. */
async function player(room) {
  await script("player", "src/player.ts", room);
  const take = (name) => {
    const text = readFileSync(join(room, name), "utf8");
    rmSync(join(room, name));
    return text;
  };
  const [code, style] = [take("player.js"), take("player.css")];
  if (/<\/s(cript|tyle)/i.test(code + style)) throw new Error("the player's script would end where it stands in its page");
  const sum = (text) => `sha256-${createHash("sha256").update(text).digest("base64")}`;
  const parts = { SCRIPT_HASH: sum(code), STYLE_HASH: sum(style), STYLE: style, SCRIPT: code };
  const page = readFileSync(join(here, "src", "player.html"), "utf8");
  writeFileSync(join(room, "player.html"), page.replace(/SCRIPT_HASH|STYLE_HASH|STYLE|SCRIPT/g, (name) => parts[name]));
}

/** All files below a folder, by their paths from there. */
function filesIn(folder) {
  const all = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((one) => one.isFile());
  return all.map(({ parentPath, name }) => relative(folder, join(parentPath, name)).replaceAll("\\", "/")).sort();
}

function hash(folder, names) {
  const sum = createHash("sha256");
  for (const name of [...names].sort()) sum.update(`${name}\0`).update(readFileSync(join(folder, name))).update("\0");
  return sum.digest("hex").slice(0, 12);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [folder, module] = process.argv.slice(2);
  if (!folder || !module) {
    console.error("usage: node app.mjs FOLDER MODULE");
    process.exit(2);
  }
  try {
    for (const name of await app(resolve(folder), resolve(module))) {
      const file = join(folder, name);
      console.log(`${name}: ${statSync(file).size} bytes, ${gzipSync(readFileSync(file)).length} gzipped`);
    }
  } catch (error) {
    console.error(`error: ${error.message}`);
    process.exit(1);
  }
}
