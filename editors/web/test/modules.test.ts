import assert from "node:assert/strict";
import { test } from "node:test";
import { NumberKeyframeTrack, InterpolateDiscrete, Vector3 } from "three";
import { toBase64, toBuffer } from "../src/host/code";
import { cssColor } from "../src/panels/inspector";
import { excerpt, sorted } from "../src/panels/findings";
import { Parts } from "../src/parts";
import { read, type Finding, type Part } from "../src/protocol";
import { drawingAt, keysOf } from "../src/stage/clips";
import { Newest } from "../src/stage/loading";
import { directionOf } from "../src/stage/view";
import { State } from "../src/state";

test("messages that are not known are dropped, and what is missing in a known one is empty", () => {
  for (const none of [null, 7, "build", [], {}, { type: "ofTheFuture" }]) assert.equal(read(none), null);
  const build = read({ type: "build", drawing: "a", build: { revision: 3, parts: [{ name: "Arm", kind: "strange", attributes: { Shape: { value: "round", from: "own" } } }] } });
  assert.ok(build?.type === "build");
  assert.equal(build.build.model, null);
  assert.deepEqual(build.build.findings, []);
  assert.deepEqual(build.build.parts, [
    { name: "Arm", parent: null, kind: "main", element: "", string: null, attributes: [{ name: "Shape", value: "round", from: "own" }], joint: null },
  ]);
  assert.deepEqual(read({ type: "light", drawing: "a" }), { type: "light", drawing: "a", part: null });
});

const part = (name: string, parent: string | null, kind: Part["kind"] = "main"): Part => ({ name, parent, kind, element: `e-${name}`, string: null, attributes: [], joint: null });

test("the hierarchy has every part of the model once", () => {
  const parts = new Parts([part("eye", "Head", "sub"), part("Head", "Body"), part("Body", null), part("Arm", "Body"), part("swatch", null, "legend"), part("old", null, "unused")]);
  const names = (name: string | null) => parts.children(name).map((one) => one.name);
  assert.deepEqual([names(null), names("Body"), names("Head")], [["Body"], ["Head", "Arm"], ["eye"]]);
  assert.deepEqual(parts.aside.map(({ name }) => name), ["swatch", "old"]);
  assert.deepEqual([parts.main, parts.shapes], [3, 1]);
  const land = new Parts([part("Hill", null, "terrain")]);
  assert.deepEqual([land.main, land.carrier("Hill")?.name, land.aside.length], [1, "Hill", 0]);
  assert.deepEqual(parts.above("eye"), ["Head", "Body"]);
  assert.equal(parts.carrier("eye")?.name, "Head");
  assert.equal(parts.carrier("Arm")?.name, "Arm");
  assert.equal(parts.carrier("swatch"), undefined);
});

test("parts that hang on themselves, or on nothing that there is, hang on the root", () => {
  const parts = new Parts([part("A", "B"), part("B", "A"), part("C", "Nobody"), part("D", "A")]);
  const seen = new Set<string>();
  const walk = (name: string | null): void => {
    for (const child of parts.children(name)) {
      assert.ok(!seen.has(child.name), child.name);
      seen.add(child.name);
      walk(child.name);
    }
  };
  walk(null);
  assert.deepEqual([...seen].sort(), ["A", "B", "C", "D"]);
});

test("what is marked in a line is counted in characters", () => {
  assert.deepEqual(excerpt({ text: "    <text>右腕@胴🤖!</text>", from: 13, to: 15 }), { before: "<text>右腕@", marked: "胴🤖", after: "!</text>" });
  assert.deepEqual(excerpt({ text: "", from: 4, to: 9 }), { before: "", marked: "", after: "" });
  assert.deepEqual(excerpt({ text: "   ab", from: 1, to: 2 }), { before: "", marked: " ", after: " ab" });
});

test("of a long line, what is around the mark is shown", () => {
  const { before, marked, after } = excerpt({ text: `${"x".repeat(5000)}HERE${"y".repeat(5000)}`, from: 5000, to: 5004 });
  assert.match(before, /^…x{20,60}$/);
  assert.equal(marked, "HERE");
  assert.match(after, /^y{20,90}…$/);
  assert.ok(Array.from(excerpt({ text: "z".repeat(9000), from: 0, to: 9000 }).marked).length <= 110);
});

test("errors go before warnings, warnings before hints, each in the order of lines", () => {
  const finding = (severity: Finding["severity"], line: number): Finding => ({ severity, line, column: 1, code: "", message: "", label: "", help: [], text: "", from: 0, to: 0 });
  const order = sorted([finding("hint", 1), finding("error", 9), finding("warning", 2), finding("error", 3)]).map(({ severity, line }) => `${severity} ${line}`);
  assert.deepEqual(order, ["error 3", "error 9", "warning 2", "hint 1"]);
});

test("colours of the drawing are colours of the page", () => {
  assert.equal(cssColor("1 0.5 0"), "rgb(255 127.5 0 / 1)");
  assert.equal(cssColor("0 0 0 0.25"), "rgb(0 0 0 / 0.25)");
  assert.equal(cssColor("#d94d40"), "#d94d40");
  for (const none of ["url(http://x)", "1 2", "a;b", "1 0 zero"]) assert.equal(cssColor(none), null);
});

test("clips with held keys only are counted in drawings", () => {
  const track = (times: number[], held: boolean) => {
    const made = new NumberKeyframeTrack(".a", times, times);
    if (held) made.setInterpolation(InterpolateDiscrete);
    return made;
  };
  const held = keysOf({ tracks: [track([0, 0.5], true), track([0, 0.25, 1], true)] });
  assert.deepEqual(held, { times: [0, 0.25, 0.5, 1], held: true });
  assert.equal(keysOf({ tracks: [track([0, 1], true), track([0, 1], false)] }).held, false);
  assert.deepEqual([-1, 0, 0.24, 0.25, 0.9, 1, 5].map((time) => drawingAt(held, time)), [1, 1, 1, 2, 3, 4, 4]);
  assert.equal(drawingAt({ times: [0, Math.fround(0.1)], held: true }, 0.1), 2);
});

test("of models that come while one is read, only the newest is read next", async () => {
  const finish = new Map<number, (good: boolean) => void>();
  const read: number[] = [];
  const taken: number[] = [];
  const failed: number[] = [];
  const newest = new Newest<number, number>(
    (key) => {
      read.push(key);
      return new Promise((resolve, reject) => finish.set(key, (good) => (good ? resolve(key) : reject(new Error("bad")))));
    },
    (value) => taken.push(value),
    (_, key) => failed.push(key),
  );
  const settle = () => new Promise((resolve) => setImmediate(resolve));
  for (const key of [1, 2, 3, 4]) newest.want(key);
  assert.deepEqual(read, [1]);
  finish.get(1)!(true);
  await settle();
  assert.deepEqual([read, taken], [[1, 4], [1]]);
  newest.want(5);
  finish.get(4)!(false);
  await settle();
  finish.get(5)!(true);
  await settle();
  assert.deepEqual([read, taken, failed], [[1, 4, 5], [1, 5], [4]]);
});

test("views stand where `okoshi render --view` stands", () => {
  const near = (a: Vector3, b: readonly number[]) => assert.ok(a.distanceTo(new Vector3(...b)) < 1e-3, `${a.toArray()} is not ${b}`);
  near(directionOf([0, 0]), [0, 0, 1]);
  near(directionOf([90, 0]), [1, 0, 0]);
  near(directionOf([0, 90]), [0, 1, 0]);
});

test("bytes come from VS Code as bytes or as base64", () => {
  const bytes = Uint8Array.from({ length: 70_000 }, (_, at) => (at * 7) % 256);
  assert.deepEqual(new Uint8Array(toBuffer(toBase64(bytes))!), bytes);
  assert.deepEqual(new Uint8Array(toBuffer(bytes.subarray(3, 9))!), bytes.slice(3, 9));
  assert.equal(toBuffer(undefined), null);
});

test("a drawing keeps what is known of it when the list comes again", () => {
  const state = new State();
  const listed = [{ id: "a", name: "a.svg", folder: "" }];
  state.receive({ type: "drawings", drawings: listed });
  state.receive({ type: "build", drawing: "a", build: { revision: 1, milliseconds: 1, model: "builds/1.glb", picture: null, stale: false, triangles: 1, findings: [], parts: [part("A", null)], clips: [], originals: null } });
  state.receive({ type: "build", drawing: "nobody", build: { revision: 1, milliseconds: 1, model: null, picture: null, stale: false, triangles: 1, findings: [], parts: [], clips: [], originals: null } });
  state.receive({ type: "drawings", drawings: [...listed, { id: "b", name: "b.svg", folder: "" }] });
  assert.deepEqual(state.list.map(({ id, build }) => [id, build?.revision]), [["a", 1], ["b", undefined]]);
  state.receive({ type: "gone", drawing: "a" });
  assert.equal(state.find("a")?.gone, true);
});

test("a build belongs to the connection it came through, also when the host calls that open later", () => {
  const state = new State();
  const listed = { type: "drawings", drawings: [{ id: "a", name: "a.svg", folder: "" }] } as const;
  const build = { type: "build", drawing: "a", build: { revision: 1, milliseconds: 1, model: "builds/1.glb", picture: null, stale: false, triangles: 1, findings: [], parts: [], clips: [], originals: null } } as const;
  const isOfNow = () => state.find("a")?.connection === state.connection;
  state.setLink("open");
  state.receive(listed);
  state.receive(build);
  assert.ok(isOfNow());
  const first = state.connection;
  state.setLink("lost");
  assert.ok(!isOfNow(), "what came before is of the connection that was lost");
  state.setLink("connecting");
  state.receive(build);
  state.setLink("open");
  assert.ok(isOfNow() && state.connection !== first);
});
