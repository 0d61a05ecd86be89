import assert from "node:assert/strict";
import { test } from "node:test";
import { AnimationClip, BoxGeometry, Group, InterpolateDiscrete, Mesh, NumberKeyframeTrack, Object3D, Vector3 } from "three";
import { Exports } from "../src/exports";
import { toBase64 } from "../src/host/base64";
import { toBuffer } from "../src/host/code";
import type { Host } from "../src/host/host";
import { figures, niceAbove } from "../src/panels/chart";
import { cssColor, drivenBy } from "../src/panels/inspector";
import { excerpt, sorted } from "../src/panels/findings";
import { Parts } from "../src/parts";
import { Messages, read, type ClipFacts, type Finding, type Part, type PerformanceFacts } from "../src/protocol";
import { isRow, linesOf, typedAhead, wordsOf } from "../src/panels/rows";
import { drawingAt, keysOf, Player } from "../src/viewport/clips";
import { Model } from "../src/viewport/model";
import { onNodes } from "../src/viewport/side-by-side";
import { ExposureSheet, describeExposure, peaks } from "../src/viewport/exposure-sheet";
import { Latest } from "../src/viewport/latest";
import { neighbors } from "../src/viewport/onion-skin";
import { pathOf } from "../src/viewport/path";
import { describeFilming, describeTiming, PerformanceTimes, type Rows } from "../src/viewport/performance";
import { directionOf } from "../src/viewport/view";
import type { Viewer } from "../src/viewport/viewer";
import { State } from "../src/state";

test("unknown messages are dropped, and missing fields become empty", () => {
  for (const none of [null, 7, "build", [], {}, { type: "ofTheFuture" }]) assert.equal(read(none), null);
  const build = read({ type: "build", drawing: "a", build: { revision: 3, parts: [{ name: "Arm", kind: "strange", attributes: { Shape: { value: "round", from: "own" } } }] } });
  assert.ok(build?.type === "build");
  assert.equal(build.build.model, null);
  assert.deepEqual(build.build.findings, []);
  assert.equal(build.build.size, null);
  assert.deepEqual(build.build.parts, [
    { name: "Arm", parent: null, kind: "main", element: "", namedBy: null, string: null, attributes: [{ name: "Shape", value: "round", from: "own" }], joint: null, depth: null, depthWhy: null, back: null, form: null, undo: { depth: null, back: null, form: null } },
  ]);
  assert.deepEqual(read({ type: "light", drawing: "a" }), { type: "light", drawing: "a", part: null });
});

const part = (name: string, parent: string | null, kind: Part["kind"] = "main"): Part => ({ name, parent, kind, element: `e-${name}`, namedBy: null, string: null, attributes: [], joint: null, depth: null, depthWhy: null, back: null, form: null, undo: { depth: null, back: null, form: null } });

test("a moving picture is saved under the names of drawing and clip, and what goes wrong is said until another drawing is shown", async () => {
  const state = new State();
  const build = { revision: 1, model: "builds/7.glb" };
  const drawings = [{ id: "a", name: "dog.svg", folder: "" }, { id: "b", name: "b.svg", folder: "" }];
  for (const message of [{ type: "drawings", drawings }, { type: "build", drawing: "a", build }]) state.receive(read(message)!);
  state.show("a");
  const [run, walk] = ["run", "walk"].map((name) => new AnimationClip(name, 1, []));
  const viewer = { playback: { player: { clip: walk, clips: [run, walk] } }, view: { angles: () => [30, 15] } } as unknown as Viewer;
  const asked: unknown[] = [];
  const saved: string[] = [];
  let why = "";
  const host = {
    film: async (...request: unknown[]) => {
      asked.push(request);
      if (why !== "") throw new Error(why);
      return new Blob();
    },
    save: async (name: string) => void saved.push(name),
  } as unknown as Host;
  const exports = new Exports(viewer, state, host);
  const said: string[] = [];
  exports.onWords(() => said.push(exports.words));
  await Promise.all([exports.film(), exports.film()]);
  assert.deepEqual(asked, [["builds/7.glb", 1, [30, 15]]], "one at a time");
  assert.deepEqual(saved, ["dog-walk.gif"]);
  assert.deepEqual(said, ["Making a moving picture of walk…", ""]);
  why = "the clip lasts 90 seconds";
  await exports.film();
  assert.equal(exports.words, "There is no moving picture: the clip lasts 90 seconds");
  state.show("b");
  assert.equal(exports.words, "");
});

test("other files are saved under the name of the drawing, where there are any", async () => {
  const state = new State();
  const build = { revision: 1, model: "builds/7.glb", exports: "exports/7" };
  const drawings = [{ id: "a", name: "dog.svg", folder: "" }, { id: "b", name: "b.svg", folder: "" }];
  for (const message of [{ type: "drawings", drawings }, { type: "build", drawing: "a", build }, { type: "build", drawing: "b", build: { ...build, exports: null } }]) state.receive(read(message)!);
  state.show("a");
  const asked: string[] = [];
  const saved: string[] = [];
  const host = { file: async (address: string) => (asked.push(address), new Blob()), save: async (name: string) => void saved.push(name) };
  const exports = new Exports({} as Viewer, state, host as unknown as Host);
  const said: string[] = [];
  exports.onWords(() => said.push(exports.words));
  await exports.obj();
  await exports.puppet();
  assert.deepEqual([asked, saved], [["exports/7.obj", "exports/7.svg"], ["dog.obj", "dog-puppet.svg"]]);
  assert.deepEqual(said, ["Making an OBJ file…", "", "Making a puppet sheet…", ""]);
  host.file = async () => Promise.reject(new Error("the drawing has errors"));
  await exports.puppet();
  assert.equal(exports.words, "There is no puppet sheet: the drawing has errors");
  state.show("b");
  assert.equal(exports.files, null);
  await exports.obj();
  assert.equal(saved.length, 2);
  assert.equal(new Exports({} as Viewer, state, { file: null } as unknown as Host).files, null);
});

test("a build may refer to parts of the build before, and to no other", () => {
  const messages = new Messages();
  const build = (revision: number, parts: unknown[], since?: number) => ({ type: "build", drawing: "a", build: { revision, parts, since } });
  const names = (message: unknown) => (message as { build: { parts: readonly Part[] } }).build.parts.map(({ name }) => name);
  const [one, two, three, four] = ["one", "two", "three", "four"].map((name) => ({ name }));
  assert.equal(messages.read(build(2, [[0, 1]], 1)), "missed");
  const first = messages.read(build(1, [one, two, three]));
  const second = messages.read(build(2, [[0, 2], four, [2, 1]], 1));
  assert.deepEqual(names(second), ["one", "two", "four", "three"]);
  // Parts that did not change are the same objects.
  assert.ok((second as { build: { parts: readonly Part[] } }).build.parts[0] === (first as { build: { parts: readonly Part[] } }).build.parts[0]);
  assert.deepEqual(names(messages.read(build(3, [[3, 1], [0, 1]], 2))), ["three", "one"]);
  assert.equal(messages.read(build(9, [[0, 1]], 7)), "missed");
  assert.deepEqual(names(messages.read(build(9, [one]))), ["one"]);
  assert.equal(new Messages().read(build(10, [[0, 1]], 9)), "missed");
});

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

test("parts whose parent is missing or themselves become children of the root", () => {
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

test("a search lists what matches, whatever its case and accents, and what carries it", () => {
  const parts = new Parts([part("Körper", null), part("Arm", "Körper"), part("Hand", "Arm"), part("Bein", "Körper"), part("old", null, "unused")]);
  const names = (query: string) => linesOf(parts, wordsOf(query), () => false).map((line) => (isRow(line) ? `${line.level} ${line.part.name} ${line.place}/${line.among}` : line));
  assert.deepEqual(names(""), ["1 Körper 1/1", "heading", "1 old 1/1"]);
  assert.deepEqual(names("HAND"), ["1 Körper 1/1", "2 Arm 1/1", "3 Hand 1/1"]);
  assert.deepEqual(names("korper"), ["1 Körper 1/1"]);
  assert.deepEqual(names("e- hand"), ["1 Körper 1/1", "2 Arm 1/1", "3 Hand 1/1"]);
  assert.deepEqual(names("nobody"), []);
});

test("the lines of thousands of parts take one look at each", () => {
  const names = Array.from({ length: 5000 }, (_, at) => `P${at}`);
  const parts = new Parts(names.map((name, at) => part(name, at === 0 ? null : `P${Math.floor((at - 1) / 10)}`)));
  let looks = 0;
  const children = parts.children.bind(parts);
  parts.children = (name) => {
    looks++;
    return children(name);
  };
  assert.equal(linesOf(parts, [], () => true).length, names.length);
  assert.equal(looks, names.length + 1);
  // A search looks for what matches first.
  looks = 0;
  assert.equal(linesOf(parts, wordsOf("p4999"), () => false).length, 5);
  assert.ok(looks <= names.length + 10, `${looks} looks for a search`);
});

test("typing goes to the next name that begins so, and round", () => {
  const parts = new Parts(["Arm", "Bein", "Brust", "Ast"].map((name) => part(name, null)));
  const lines = linesOf(parts, [], () => true);
  const go = (from: number, typed: string) => typedAhead(lines, from, typed);
  assert.deepEqual([go(0, "b"), go(1, "b"), go(2, "b"), go(0, "a"), go(1, "br"), go(2, "br"), go(0, "aa"), go(0, "x")], [1, 2, 1, 3, 2, 2, 3, null]);
});

test("what is hidden is hidden with all that hangs on it, and can be shown alone", () => {
  const state = new State();
  state.receive({ type: "drawings", drawings: [{ id: "a", name: "a.svg", folder: "" }] });
  state.receive({ type: "build", drawing: "a", build: { revision: 1, milliseconds: 1, model: "builds/1.glb", picture: null, paper: null, stale: false, incomplete: false, triangles: 1, size: null, findings: [], parts: [part("Body", null), part("Arm", "Body"), part("Hand", "Arm"), part("nail", "Hand", "sub")], clips: [], originals: null, exports: null } });
  state.show("a");
  state.setHidden("Arm", true);
  assert.deepEqual([...state.hidden].sort(), ["Arm", "Hand", "nail"]);
  assert.deepEqual(["Body", "Arm", "nail"].map((name) => state.isHidden(name)), [false, true, true]);
  state.isolate("nail");
  assert.deepEqual([...state.hidden].sort(), ["Arm", "Body"], "a shape is shown with its part");
  state.showAll();
  assert.equal(state.hidden.size, 0);
});

test("marks in a line count characters", () => {
  assert.deepEqual(excerpt({ text: "    <text>右腕@胴🤖!</text>", from: 13, to: 15 }), { before: "<text>右腕@", marked: "胴🤖", after: "!</text>" });
  assert.deepEqual(excerpt({ text: "", from: 4, to: 9 }), { before: "", marked: "", after: "" });
  assert.deepEqual(excerpt({ text: "   ab", from: 1, to: 2 }), { before: "", marked: " ", after: " ab" });
});

test("a long line is cut to the text around the mark", () => {
  const { before, marked, after } = excerpt({ text: `${"x".repeat(5000)}HERE${"y".repeat(5000)}`, from: 5000, to: 5004 });
  assert.match(before, /^…x{20,60}$/);
  assert.equal(marked, "HERE");
  assert.match(after, /^y{20,90}…$/);
  assert.ok(Array.from(excerpt({ text: "z".repeat(9000), from: 0, to: 9000 }).marked).length <= 110);
});

test("errors come before warnings, warnings before hints, each sorted by line", () => {
  const finding = (severity: Finding["severity"], line: number): Finding => ({ severity, line, column: 1, code: "", message: "", label: "", place: "", help: [], text: "", from: 0, to: 0 });
  const order = sorted([finding("hint", 1), finding("error", 9), finding("warning", 2), finding("error", 3)]).map(({ severity, line }) => `${severity} ${line}`);
  assert.deepEqual(order, ["error 3", "error 9", "warning 2", "hint 1"]);
});

test("colours of the drawing become CSS colours", () => {
  assert.equal(cssColor("1 0.5 0"), "rgb(255 127.5 0 / 1)");
  assert.equal(cssColor("0 0 0 0.25"), "rgb(0 0 0 / 0.25)");
  assert.equal(cssColor("#d94d40"), "#d94d40");
  for (const none of ["url(http://x)", "1 2", "a;b", "1 0 zero"]) assert.equal(cssColor(none), null);
});

test("clips with only held keys are counted in drawings", () => {
  const track = (times: number[], held: boolean) => {
    const made = new NumberKeyframeTrack(".a", times, times);
    if (held) made.setInterpolation(InterpolateDiscrete);
    return made;
  };
  const held = keysOf({ duration: 2, tracks: [track([0, 0.5], true), track([0, 0.25, 1, 2], true)] });
  assert.deepEqual(held, { times: [0, 0.25, 0.5, 1], held: true });
  assert.equal(keysOf({ duration: 1, tracks: [track([0, 1], true), track([0, 1], false)] }).held, false);
  assert.deepEqual(keysOf({ duration: 0, tracks: [track([0], true)] }).times, [0]);
  assert.deepEqual([-1, 0, 0.24, 0.25, 0.9, 1, 5].map((time) => drawingAt(held, time)), [1, 1, 1, 2, 3, 4, 4]);
  assert.equal(drawingAt({ times: [0, Math.fround(0.1)], held: true }, 0.1), 2);
});

test("a clip waits at its end for a longer one beside it", () => {
  const root = new Group();
  const clip = new AnimationClip("move", 1, [new NumberKeyframeTrack(`${root.uuid}.position[x]`, [0, 1], [0, 1])]);
  const player = new Player();
  player.take(new Model(root, [clip]), true);
  player.waitFor(2.5);
  assert.equal(player.end, 2.5);
  player.advance(1.5);
  assert.deepEqual([player.time, root.position.x, player.playing], [1.5, 1, true]);
  player.advance(1.25);
  assert.deepEqual([player.time, root.position.x], [0.25, 0.25]);
  player.seek(2);
  player.waitFor(0);
  assert.deepEqual([player.end, player.time, root.position.x], [1, 1, 1]);
});

test("a player begins with a preferred clip, and goes on with the one that is shown", () => {
  const clips = ["before", "after"].map((name) => new AnimationClip(name, 1, []));
  const model = () => new Model(new Group(), clips);
  const player = new Player();
  player.take(model(), true);
  assert.equal(player.clip?.name, "before");
  const other = new Player();
  other.take(model(), true, ({ name }) => name === "after");
  assert.equal(other.clip?.name, "after");
  player.take(model(), true, ({ name }) => name === "after");
  assert.equal(player.clip?.name, "before");
});

test("the neighbours of a time are the drawings, or the keys, before and after it", () => {
  const held = { keys: { times: [0, 0.5, 1], held: true } };
  assert.deepEqual([0.2, 0.5, 0.7, 1.5].map((time) => neighbors({ ...held, time }, null)), [[null, 0.5], [0, 1], [0, 1], [0.5, null]]);
  assert.deepEqual(neighbors({ keys: { times: [0, 0.5, 1], held: false }, time: 0.7 }, null), [0.5, 1]);
  const exposure = new ExposureSheet(facts({ exposure: [[2, 4], [7, 5], [10, 3]] }));
  const [before, after] = neighbors({ ...held, time: 5 / 24 }, exposure);
  assert.deepEqual([before, after].map((time) => exposure.drawingIn(exposure.frameAt(time!))), [0, 2]);
});

test("the way of a clip has all places of the model, unless it is very long", () => {
  const root = new Group();
  const mesh = new Mesh(new BoxGeometry(1, 1, 1));
  root.add(mesh);
  const clip = (far: number) => new AnimationClip("go", 1, [new NumberKeyframeTrack(`${mesh.uuid}.position[x]`, [0, 1], [0, far])]);
  const model = new Model(root, []);
  const along = (far: number) => pathOf(model, clip(far), (time) => void (mesh.position.x = far * time));
  assert.deepEqual([along(3).min.x, along(3).max.x], [-0.5, 3.5]);
  assert.equal(along(100), model.box);
});

test("of the models requested while one is loading, only the latest is loaded next", async () => {
  const finish = new Map<number, (good: boolean) => void>();
  const read: number[] = [];
  const taken: number[] = [];
  const failed: number[] = [];
  const newest = new Latest<number, number>(
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

test("views equal those of `okoshi render --view`", () => {
  const near = (a: Vector3, b: readonly number[]) => assert.ok(a.distanceTo(new Vector3(...b)) < 1e-3, `${a.toArray()} is not ${b}`);
  near(directionOf([0, 0]), [0, 0, 1]);
  near(directionOf([90, 0]), [1, 0, 0]);
  near(directionOf([0, 90]), [0, 1, 0]);
});

test("bytes from VS Code may be binary or base64", () => {
  const bytes = Uint8Array.from({ length: 70_000 }, (_, at) => (at * 7) % 256);
  assert.deepEqual(new Uint8Array(toBuffer(toBase64(bytes))!), bytes);
  assert.deepEqual(new Uint8Array(toBuffer(bytes.subarray(3, 9))!), bytes.slice(3, 9));
  assert.equal(toBuffer(undefined), null);
});

test("a drawing keeps its state when the list is sent again", () => {
  const state = new State();
  const listed = [{ id: "a", name: "a.svg", folder: "" }];
  state.receive({ type: "drawings", drawings: listed });
  state.receive({ type: "build", drawing: "a", build: { revision: 1, milliseconds: 1, model: "builds/1.glb", picture: null, paper: null, stale: false, incomplete: false, triangles: 1, size: null, findings: [], parts: [part("A", null)], clips: [], originals: null, exports: null } });
  state.receive({ type: "build", drawing: "nobody", build: { revision: 1, milliseconds: 1, model: null, picture: null, paper: null, stale: false, incomplete: false, triangles: 1, size: null, findings: [], parts: [], clips: [], originals: null, exports: null } });
  state.receive({ type: "drawings", drawings: [...listed, { id: "b", name: "b.svg", folder: "" }] });
  assert.deepEqual(state.list.map(({ id, build }) => [id, build?.revision]), [["a", 1], ["b", undefined]]);
  state.receive({ type: "gone", drawing: "a" });
  assert.equal(state.find("a")?.gone, true);
});

test("a build belongs to its connection, even if that is reported open later", () => {
  const state = new State();
  const listed = { type: "drawings", drawings: [{ id: "a", name: "a.svg", folder: "" }] } as const;
  const build = { type: "build", drawing: "a", build: { revision: 1, milliseconds: 1, model: "builds/1.glb", picture: null, paper: null, stale: false, incomplete: false, triangles: 1, size: null, findings: [], parts: [], clips: [], originals: null, exports: null } } as const;
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

const facts = (more: Partial<ClipFacts>): ClipFacts => ({
  name: "kick", figure: "Body", file: "kick.bvh", seconds: 0.5, fps: 24, frames: 12, drawings: 0, limited: true, exposure: [], chosen: [], omitted: [], held: [],
  ssd: Array.from({ length: 12 }, (_, at) => at), ssdStep: 1, joints: new Map(), unmatched: [], performance: null, ...more,
});

test("facts of clips are read, and missing ones become empty", () => {
  const message = read({
    type: "build",
    drawing: "a",
    build: { originals: "o.glb", clips: [{ name: "kick", figure: "Body", exposure: [[0, 2], [5, "x"], 7], omitted: [3, null], ssd: [0, "x", 0.5], joints: JSON.parse('{"__proto__": "Hips", "Arm": null}') as object, joint_reasons: JSON.parse('{"__proto__": "so"}') as object }, 5] },
  });
  assert.ok(message?.type === "build");
  const [clip, none] = message.build.clips;
  assert.equal(message.build.originals, "o.glb");
  assert.deepEqual([clip!.exposure, clip!.omitted, clip!.ssd, clip!.ssdStep, clip!.limited], [[[0, 2], [5, 0], [0, 0]], [3, 0], [0, 0, 0.5], 1, false]);
  assert.deepEqual([...clip!.joints], [["__proto__", { joint: "Hips", why: "so" }], ["Arm", { joint: "", why: "" }]]);
  assert.deepEqual([none!.name, none!.exposure, none!.fps], ["", [], 0]);
});

test("drawings replace the source frames up to the next drawing, except omitted ones", () => {
  // Frames 5 and 6 are omitted; 0 and 9 are held longer for them, and 2 for the frame after it.
  const exposure = new ExposureSheet(facts({ exposure: [[0, 2], [1, 1], [2, 2], [4, 1], [7, 1], [8, 1], [9, 2], [10, 2]], omitted: [5, 6] }));
  assert.deepEqual(exposure.runs.map(({ start, from, to }) => [start, from, to]), [[0, 0, 1], [2, 1, 2], [3, 2, 4], [5, 4, 5], [6, 7, 8], [7, 8, 9], [8, 9, 10], [10, 10, 12]]);
  assert.deepEqual([exposure.frames, exposure.sources], [12, 12]);
  // Times in single precision belong to their own frames.
  assert.deepEqual(Array.from({ length: 13 }, (_, at) => exposure.sourceAt(Math.fround(at / 24))), [0, 0, 1, 2, 3, 4, 7, 8, 9, 9, 10, 11, 11]);
  const shows = Array.from({ length: 12 }, (_, source) => exposure.drawingIn(exposure.frameAt(exposure.timeOf(source))));
  assert.deepEqual(shows, [0, 1, 2, 2, 3, 3, 3, 4, 5, 6, 7, 7]);
  assert.equal(describeExposure(exposure), "12 frames, 8 drawings, 2 in-betweens omitted");
});

test("without omitted frames a drawing may show any of the frames it replaces", () => {
  const exposure = new ExposureSheet(facts({ exposure: [[2, 4], [7, 5], [10, 3]], held: Array.from({ length: 9 }, (_, at) => at) }));
  assert.deepEqual(exposure.runs.map(({ from, to }) => [from, to]), [[0, 4], [4, 9], [9, 12]]);
  assert.deepEqual([0, 3, 4, 8, 9, 11].map((frame) => exposure.sourceAt((frame + 0.5) / 24)), [0, 3, 4, 8, 9, 11]);
  assert.equal(exposure.drawingIn(exposure.frameAt(exposure.timeOf(8))), 1);
  assert.equal(describeExposure(exposure), "12 frames, 3 drawings, 9 held");
});

test("a shortened clip, one that is not limited, and one without facts", () => {
  const short = new ExposureSheet(facts({ frames: 10, exposure: [[0, 1], [1, 1], [2, 2], [4, 1], [7, 1], [8, 1], [9, 1], [10, 2]], omitted: [5, 6] }));
  assert.deepEqual([short.frames, short.sources, short.sourceAt(9 / 24)], [10, 12, 11]);
  const full = new ExposureSheet(facts({ limited: false, exposure: Array.from({ length: 12 }, (_, at) => [at, 1] as const) }));
  assert.deepEqual([full.runs.length, full.frames, full.sources, full.drawingIn(4), full.sourceAt(5 / 24), full.ssd(5)], [0, 12, 12, -1, 5, 5]);
  assert.equal(describeExposure(full), "12 frames, as in the motion file");
  const none = new ExposureSheet(facts({ frames: 0, fps: 0, ssd: [], limited: false }));
  assert.deepEqual([none.frames, none.sources, none.sourceAt(3), none.timeOf(7) < 0.1, none.ssd(0)], [1, 1, 0, true, null]);
  const thinned = new ExposureSheet(facts({ frames: 22, limited: false, ssd: [1, 2, 3], ssdStep: 8 }));
  assert.deepEqual([thinned.sources, thinned.ssd(7), thinned.ssd(8), thinned.ssd(21)], [22, 1, 2, 3]);
});

const performance = (more: Partial<PerformanceFacts> = {}): PerformanceFacts => ({
  track: "hands.json", marks: [], keys: { performance: 8, motion: 2 }, shown: 8, timed: true, frames: { performance: 11, motion: 5 }, filming: "none", nearest: null,
  timing: [[0, 0], [8, 2], [10, 4]], input: [[0, 0, 0, 0, 0, 0, 0, 0, 1, 0.5, 0]], inputStep: 1, motion: [[0, 0.5, 1, 0.25, 0]], motionStep: 1, ...more,
});
const ROWS: Rows = { left: 10, right: 110, performance: [0, 50], motion: [80, 130] };

test("the timing of a performance goes through its keys, both ways", () => {
  const times = new PerformanceTimes(performance());
  assert.deepEqual([0, 4, 8, 9, 10, 12].map((frame) => times.motionAt(frame)), [0, 1, 2, 3, 4, 4]);
  assert.deepEqual([0, 1, 2, 3, 4].map((frame) => times.performanceAt(frame)), [0, 4, 8, 9, 10]);
  assert.equal(describeTiming(times.facts), "frame 3 of the motion stands in frame 9 of 11");
  assert.equal(describeTiming(performance({ shown: 9 })), "frame 3 of the motion stands in frame 9 of 11, shown in frame 10");
  // A key in the last frame is held: the rest of the motion is not shown.
  const held = new PerformanceTimes(performance({ keys: { performance: 10, motion: 2 }, timing: [[0, 0], [10, 2]] }));
  assert.deepEqual([held.motionAt(10), held.performanceAt(4)], [2, 10]);
  // The motion stands still while two frames of the performance show one of it.
  const still = new PerformanceTimes(performance({ timing: [[0, 0], [5, 0], [10, 4]] }));
  assert.deepEqual([still.motionAt(5), still.performanceAt(0), still.performanceAt(4)], [0, 0, 10]);
  const own = new PerformanceTimes(performance({ timed: false, timing: [] }));
  assert.deepEqual([own.motionAt(3), own.performanceAt(3)], [3, 3]);
  assert.equal(describeTiming(own.facts), "the motion keeps its timing");
});

test("how a performance is filmed is said in words", () => {
  assert.equal(describeFilming(performance()), "not filmed");
  assert.equal(describeFilming(performance({ filming: "camera", nearest: 7 })), "filmed by a camera that is nearest in frame 8");
  assert.equal(describeFilming(performance({ filming: "root", nearest: 0 })), "filmed by moving the figure, which is nearest to the viewer in frame 1");
});

test("the rows of a performance share one scale of time", () => {
  const times = new PerformanceTimes(performance());
  assert.deepEqual(times.curve("motion", 0, ROWS), [[10, 130], [20, 105], [30, 80], [40, 117.5], [50, 130]]);
  assert.deepEqual(times.curve("performance", 0, ROWS)[8], [90, 0]);
  assert.deepEqual(times.curve("motion", 7, ROWS), []);
  assert.deepEqual(times.links(ROWS).map(({ from, to, isKey }) => [...from, ...to, isKey]), [[10, 50, 10, 80, false], [90, 50, 30, 80, true], [110, 50, 50, 80, false]]);
  assert.deepEqual([-5, 31, 500].map((x) => times.frameAt("motion", x, ROWS)), [0, 2, 4]);
  assert.deepEqual([times.ratio("performance", 0, 9), times.ratio("motion", 0, 9)], [0.5, null]);
});

test("long curves of a performance keep their peaks", () => {
  // Two thousand frames in values of 4 frames each, on 100 pixels.
  const values = Array.from({ length: 500 }, (_, at) => (at === 333 ? 1 : 0.25));
  const times = new PerformanceTimes(performance({ frames: { performance: 2000, motion: 5 }, input: [values], inputStep: 4 }));
  const curve = times.curve("performance", 0, ROWS);
  assert.equal(curve.length, 100);
  const [x] = curve.find(([, y]) => y === 0)!;
  assert.ok(Math.abs(x - times.at(333 * 4, ROWS)) <= 1, `the peak is at ${x}`);
  assert.equal(times.ratio("performance", 0, 333 * 4 + 3), 1);
  assert.ok(curve.every(([x]) => x >= ROWS.left && x <= ROWS.right));
});

test("what a performance does is read, and missing facts become empty", () => {
  const clip = (value: unknown) => {
    const message = read({ type: "build", drawing: "a", build: { clips: [{ performance: value }] } });
    assert.ok(message?.type === "build");
    return message.build.clips[0]!.performance;
  };
  assert.equal(clip(undefined), null);
  const facts = clip({ track: "a.json", marks: [{ name: "red", color: "#d03020", performs: ["Arm", 7], ratio: 1, emphasized: true }, { color: "url(x)" }], keys: { performed: 8 }, timing: [[0, 0], [8, "x"]], input_curves: [[0, "x", 1]], input_step: 2, filming: "strange" })!;
  assert.deepEqual(facts.marks, [{ name: "red", color: "#d03020", parts: ["Arm", "7"], ratio: 1, emphasized: true, damped: false }, { name: "", color: "", parts: [], ratio: 0, emphasized: false, damped: false }]);
  assert.deepEqual([facts.keys, facts.timing, facts.input, facts.inputStep, facts.motion, facts.filming, facts.nearest], [{ performance: 8, motion: 0 }, [[0, 0], [8, 0]], [[0, 0, 1]], 2, [], "none", null]);
});

test("a curve is reduced to its peaks", () => {
  const values = Array.from({ length: 1000 }, (_, at) => (at === 777 ? 5 : at % 7 === 0 ? 1 : 0));
  const thin = peaks(values, 90);
  assert.equal(thin.step, 12);
  assert.equal(thin.values.length, 84);
  assert.equal(thin.values.indexOf(5), Math.floor(777 / 12));
  assert.deepEqual(peaks([3, 1], 90), { step: 1, values: [3, 1] });
});

test("the scale's numbers are short", () => {
  assert.deepEqual([0.0561, 0.1, 0.11, 7, 9, 1234].map(niceAbove).map((value) => Number(value.toPrecision(3))), [0.06, 0.1, 0.2, 8, 10, 2000]);
  assert.deepEqual([0, 0.0012345, 0.06, 1234.5, 0.0000123].map(figures), ["0", "0.00123", "0.06", "1,230", "1.2e−5"]);
});

test("the driving joint is that of the clip shown, otherwise of the first clip with the part", () => {
  const clip = (name: string, joint: string) => ({ name, joints: new Map([["Arm", { joint, why: "by its name" }]]), unmatched: ["Tail"] });
  const clips = [clip("walk", "RightArm"), clip("kick", "RightForeArm")];
  assert.equal(drivenBy("Arm", clips, "kick"), "RightForeArm — by its name");
  assert.equal(drivenBy("Arm", clips, "other"), "RightArm — by its name");
  assert.equal(drivenBy("Tail", clips), "no joint: it follows its parent");
  assert.equal(drivenBy("Tree", clips), null);
});

test("a clip of one file animates the nodes of another by their names in the files", () => {
  const node = (name: string, own: string) => Object.assign(new Object3D(), { name: own, userData: { name } });
  const there = new Map([["Arm", [node("Arm", "Arm"), node("Arm", "Arm_1")]]]);
  const here = new Map([["Arm", [node("Arm", "Arm_2"), node("Arm", "Arm_3")]]]);
  const track = (name: string) => new NumberKeyframeTrack(name, [0, 1], [0, 1]);
  const moved = onNodes(new AnimationClip("a", 7, [track("Arm.position"), track("Arm_1.position"), track("Gone.position")]), there, here);
  assert.equal(moved.duration, 7);
  assert.deepEqual(moved.tracks.map(({ name }) => name), here.get("Arm")!.map(({ uuid }) => `${uuid}.position`));
});
