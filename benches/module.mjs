// Measures the module for browsers in Node: how long the first build of a drawing takes, and a keystroke in one of its strings.
//
//   node benches/module.mjs MODULE [DRAWING…]
//
// MODULE is the folder that editors/web/wasm/build.sh made. Each keystroke changes the last digit of the last string that has one, and asks for what
// changed in the model; the median of all is printed, in milliseconds of CPU.

import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const root = new URL("..", import.meta.url).pathname;
const [folder, ...named] = process.argv.slice(2);
if (!folder) {
  console.error("usage: node benches/module.mjs MODULE [DRAWING…]");
  process.exit(2);
}
const STROKES = 40;
const drawings = named.length > 0 ? named : ["human", "clockwork-dragon", "girl", "island"].map((name) => join(root, `examples/${name}.svg`));
const made = await import(pathToFileURL(resolve(folder, "okoshi_web.js")).href);
made.initSync({ module: new WebAssembly.Module(readFileSync(join(folder, "okoshi_web_bg.wasm"))) });

const cpu = () => {
  const { user, system } = process.cpuUsage();
  return (user + system) / 1000;
};
const median = (numbers) => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
/** The address of the newest model. */
const newest = (studio) => studio.messages().map((message) => JSON.parse(message)).flatMap(({ build }) => build?.model ?? []).at(-1);

for (const path of drawings) {
  const text = readFileSync(path, "utf8");
  const put = (studio, text) => studio.put("drawing.svg", new TextEncoder().encode(text), 0);
  const at = [...text.matchAll(/[0-9](?=[^<>0-9]*<\/t)/g)].at(-1)?.index;
  if (at === undefined) throw new Error(`${path} has no string with a number`);
  const studio = new made.Studio();
  const began = cpu();
  put(studio, text);
  let model = newest(studio);
  studio.bytes(model);
  const first = cpu() - began;
  const strokes = [];
  for (let stroke = 0; stroke < STROKES; stroke++) {
    const typed = `${text.slice(0, at)}${7 + (stroke % 2)}${text.slice(at + 1)}`;
    const began = cpu();
    put(studio, typed);
    const next = newest(studio);
    if (next) studio.bytes(`${next}?since=${model}`);
    model = next ?? model;
    strokes.push(cpu() - began);
  }
  studio.free();
  console.log(`${path}: built in ${first.toFixed(0)} ms, a keystroke ${median(strokes).toFixed(1)} ms`);
}
