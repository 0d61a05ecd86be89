// The program in the browser without a browser: one call of the worker at a time, newer texts in place of older ones, and folders that are dropped.

import assert from "node:assert/strict";
import { test } from "node:test";
import { dropped, type Opened } from "../src/app/access";
import { kindOf } from "../src/app/kinds";
import { Calls, type Call } from "../src/host/worker/calls";
import { Answering } from "./answering";

function made(long?: number): { port: Answering; calls: Calls; events: string[] } {
  const port = new Answering();
  const events: string[] = [];
  const calls = new Calls(port, {
    ready: () => events.push("ready"),
    failed: (why) => events.push(`failed ${why}`),
    done: ({ call }) => events.push(`done ${call}`),
    stopped: (path) => events.push(`stopped ${path}`),
    slow: (path) => events.push(`slow ${path}`),
  }, long);
  return { port, calls, events };
}

const bytes = (text: string): Uint8Array<ArrayBuffer> => new TextEncoder().encode(text);
const put = (path: string, text: string): Call => ({ call: "put", path, bytes: bytes(text) });
const names = (calls: readonly Call[]): string[] => calls.map((call) => (call.call === "put" ? `${call.path} ${new TextDecoder().decode(call.bytes)}` : call.call));

test("calls wait until the module is loaded, and then for each other", async () => {
  const { port, calls, events } = made();
  const first = calls.make(put("a.svg", "1"));
  const second = calls.make({ call: "text", path: "a.svg" });
  assert.deepEqual(port.asked, []);
  port.say({ type: "ready" });
  assert.deepEqual(names(port.asked), ["a.svg 1"]);
  port.done();
  await first;
  assert.deepEqual(names(port.asked), ["a.svg 1", "text"]);
  port.done({ value: "its text" });
  assert.equal(await second, "its text");
  assert.deepEqual(events, ["ready", "done put", "done text"]);
});

test("a newer text replaces one that waits, unless something was asked in between", async () => {
  const { port, calls } = made();
  port.say({ type: "ready" });
  const all = ["1", "2", "3"].map((text) => calls.make(put("a.svg", text)));
  all.push(calls.make(put("b.svg", "1")), calls.make(put("a.svg", "4")));
  all.push(calls.make({ call: "change", json: "{}" }), calls.make(put("a.svg", "5")));
  for (let answered = 0; answered < 5; answered++) port.done();
  await Promise.all(all);
  assert.deepEqual(names(port.asked), ["a.svg 1", "a.svg 4", "b.svg 1", "change", "a.svg 5"]);
});

test("a stop names the file, and what was asked is answered with an error once the worker is ended", async () => {
  const { port, calls, events } = made();
  port.say({ type: "ready" });
  const all = [calls.make({ call: "bytes", address: "builds/1.glb" }), calls.make(put("a.svg", "1"))];
  port.say({ type: "stopped" });
  calls.end();
  for (const one of all) await assert.rejects(one, /started again/);
  assert.ok(port.ended);
  assert.deepEqual(events, ["ready", "stopped null"]);
});

test("what takes long is said with the file that is being read, and what is done is not", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const { port, calls, events } = made(1000);
  port.say({ type: "ready" });
  const first = calls.make({ call: "begin", files: [] });
  port.say({ type: "reading", path: "a.svg" });
  port.say({ type: "reading", path: "b.svg" });
  t.mock.timers.tick(999);
  assert.deepEqual(events, ["ready"]);
  t.mock.timers.tick(1);
  port.done();
  await first;
  const second = calls.make({ call: "text", path: "a.svg" });
  port.done();
  await second;
  t.mock.timers.tick(5000);
  assert.deepEqual(events, ["ready", "slow b.svg", "done begin", "done text"]);
});

test("a script that does not load is a failure, and one that ends while it reads a file a stop", () => {
  const before = made();
  before.port.fail("not found");
  assert.deepEqual(before.events, ["failed not found"]);
  const after = made();
  after.port.say({ type: "ready" });
  void after.calls.make(put("a.svg", "1"));
  after.port.say({ type: "reading", path: "a.svg" });
  after.port.fail("out of memory");
  assert.deepEqual(after.events, ["ready", "stopped a.svg"]);
});

test("files are told apart by the ends of their names", () => {
  assert.deepEqual(["a.svg", "folder/A.SVG", "a.svgz", "a.bvh", "map.tmx", "hands.json", "a.glb", "a.PNG"].map(kindOf), ["drawing", "drawing", "drawing", "linked", "linked", "linked", "linked", "linked"]);
  for (const [path, why] of [["a.psd", "save it as PNG and open that"], ["svg", "okoshi reads SVG, and the motions, pictures and maps that a drawing links to"]]) {
    assert.deepEqual(kindOf(path!), { why: `${path} is no drawing: ${why}.` });
  }
});

/** A folder as browsers show one that was dropped: names with contents, or with what is inside. */
type Tree = { readonly [name: string]: string | Tree };
const TREE: Tree = { "fox.svg": "<svg/>", "README.md": "words", ".git": { "a.svg": "hidden" }, motion: { "walk.bvh": "HIERARCHY", more: { "b.svg": "<svg/>" } } };
const FOUND = ["fox/fox.svg <svg/>", "fox/motion/more/b.svg <svg/>", "fox/motion/walk.bvh HIERARCHY"];

function handle(name: string, tree: string | Tree): object {
  if (typeof tree === "string") return { kind: "file", name, getFile: async () => new File([tree], name) };
  return {
    kind: "directory",
    name,
    async *values() {
      for (const [name, one] of Object.entries(tree)) yield handle(name, one);
    },
  };
}

function entry(name: string, tree: string | Tree): object {
  if (typeof tree === "string") return { isFile: true, name, file: (found: (file: File) => void) => found(new File([tree], name)) };
  const pieces = Object.entries(tree).map(([name, one]) => [entry(name, one)]);
  return { isFile: false, isDirectory: true, name, createReader: () => ({ readEntries: (found: (entries: object[]) => void) => found(pieces.shift() ?? []) }) };
}

const told = (opened: readonly Opened[]): string[] => opened.map(({ path, bytes }) => `${path} ${new TextDecoder().decode(bytes)}`).sort();

test("a folder that is dropped brings drawings and what they link to, by their paths", async () => {
  const byHandle = { kind: "file", webkitGetAsEntry: () => null, getAsFile: () => null, getAsFileSystemHandle: async () => handle("fox", TREE) };
  const opened = await dropped({ items: [byHandle], files: [] } as unknown as DataTransfer);
  assert.deepEqual(told(opened), FOUND);
  assert.ok(opened.every(({ handle }) => handle !== null));
  // Browsers without handles have entries.
  const byEntry = { kind: "file", webkitGetAsEntry: () => entry("fox", TREE), getAsFile: () => null };
  assert.deepEqual(told(await dropped({ items: [byEntry], files: [] } as unknown as DataTransfer)), FOUND);
});

test("a file that is too large is refused before it is read", async () => {
  const file = { name: "a.png", size: 2 ** 29, lastModified: 0 };
  const item = { kind: "file", webkitGetAsEntry: () => null, getAsFile: () => file };
  await assert.rejects(dropped({ items: [item], files: [] } as unknown as DataTransfer), /a\.png is larger than 256 MiB/);
});
