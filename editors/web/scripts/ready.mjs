// What a page shows before the module has come: made by the module itself, when the folder is made.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const repository = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");
/** What can be tried beside the drawings that the module has to start from. */
const EXAMPLES = [
  { name: "lamp", about: "A lamp that jumps, by poses in layers", drawing: "examples/motion/lamp.svg" },
  { name: "palms", about: "An island in freehand outlines, seen from above", drawing: "examples/terrain/freehand.svg" },
];

/** Makes drawings, pictures and the model in a folder, with other drawings by their names; returns what the page has to know (src/app/ready.ts). */
export async function ready(module, room, others) {
  const { initSync, Studio } = await import(pathToFileURL(resolve(module, "okoshi_web.js")).href);
  initSync({ module: new WebAssembly.Module(readFileSync(join(module, "okoshi_web_bg.wasm"))) });
  const messages = (studio) => studio.messages().map((message) => JSON.parse(message));
  const offering = new Studio();
  offering.offer();
  const { key, starters } = messages(offering).find(({ type }) => type === "starters");

  mkdirSync(join(room, "begin"));
  const write = (name, content) => {
    writeFileSync(join(room, "begin", name), content);
    return `begin/${name}`;
  };
  const drawings = {};
  const add = (name, text) => {
    if (!/^[a-z0-9-]+$/.test(name)) throw new Error(`${name} is no name for a drawing of a link`);
    if (drawings[name] !== undefined) throw new Error(`there are two drawings called ${name}`);
    drawings[name] = write(`${name}.svg`, text);
  };
  /** Builds a drawing; returns what the module says of it. */
  const built = (name, text) => {
    const studio = new Studio();
    studio.put(`${name}.svg`, new TextEncoder().encode(text), 0);
    const { build } = messages(studio).find(({ type }) => type === "build");
    const links = studio.links(`${name}.svg`);
    if (links.length > 0) throw new Error(`${name} links to ${links[0]}, and is opened by itself`);
    return { build, bytes: (address) => studio.bytes(address) };
  };

  const listed = [];
  let model;
  for (const { name, about, picture } of starters) {
    const studio = new Studio();
    // It begins what it has offered.
    studio.offer();
    studio.receive(JSON.stringify({ type: "begin", key, starter: name }), 0);
    add(name, studio.text(`${name}.svg`));
    listed.push({ name, about, picture: picture && write(`${name}.png`, offering.bytes(picture)) });
    model ??= write(`${name}.glb`, studio.bytes(messages(studio).find(({ type }) => type === "build").build.model));
  }
  const examples = EXAMPLES.map(({ name, about, drawing }) => {
    const text = readFileSync(join(repository, drawing), "utf8");
    add(name, text);
    const { build, bytes } = built(name, text);
    return { name, about, picture: write(`${name}.png`, bytes(build.picture)) };
  });
  for (const [name, path] of Object.entries(others)) {
    const text = readFileSync(path, "utf8");
    if (drawings[name] !== undefined && readFileSync(join(room, drawings[name]), "utf8") === text) continue;
    built(name, text);
    add(name, text);
  }
  // A page without shapes comes last.
  const isEmpty = ({ picture }) => picture === null;
  return { starters: [...listed.filter((one) => !isEmpty(one)), ...examples, ...listed.filter(isEmpty)], drawings, model, lessons: true };
}
