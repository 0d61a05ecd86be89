import assert from "node:assert/strict";
import { test } from "node:test";
import { smallSize, whyNot } from "../src/camera/camera";
import { curve } from "../src/camera/curves";
import { Link, type Socket } from "../src/camera/link";
import { frameMessage, readMessage, readTrack, type FromTracker } from "../src/camera/messages";
import { trailPath } from "../src/camera/overlay";
import { nearest } from "../src/camera/pictures";
import { fileName, markNames, strings } from "../src/camera/strings";
import { Parts } from "../src/parts";

const PIXELS = { width: 2, height: 1, data: [1, 2, 3, 255, 4, 5, 6, 255] };

test("a frame is a header and RGB", () => {
  const message = frameMessage(258, PIXELS, 12.5);
  assert.deepEqual([...new Uint8Array(message)], [2, 1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0x29, 0x40, 1, 2, 3, 4, 5, 6]);
});

test("messages of the program are read, and others dropped", () => {
  for (const none of [null, "", "{", "[]", '{"type":"other"}', new ArrayBuffer(8)]) assert.equal(readMessage(none), null);
  assert.deepEqual(readMessage('{"type":"seen","sequence":3,"marks":[[1,2,3],null,[1]],"recorded":2}'), { type: "seen", sequence: 3, marks: [{ x: 1, y: 2, radius: 3 }, null, null], recorded: 2 });
  assert.deepEqual(readMessage('{"type":"marks","marks":[{"name":"a","colour":"#010203"},{"name":"b","colour":"url(x)"}]}'), { type: "marks", marks: [{ name: "a", color: "#010203" }, { name: "b", color: "#808080" }] });
  assert.deepEqual(readMessage('{"type":"error","message":"no","isFrame":true}'), { type: "error", message: "no", isFrame: true });
});

test("a track says where each mark is and when it is lost", () => {
  const track = readTrack('{"format":"okoshi track","version":1,"size":[320,240],"times":[0,0.1,0.2],"marks":[{"name":"a","colour":"#010203","lost":[[1,2]],"points":[[1,2],[3,4],[5,6]]}]}');
  assert.deepEqual(track.size, [320, 240]);
  assert.deepEqual(track.marks[0], { name: "a", color: "#010203", points: [[1, 2], [3, 4], [5, 6]], isLost: [false, true, true], isAmbiguous: [false, false, false] });
  const ambiguous = readTrack('{"times":[0,0.1,0.2],"marks":[{"name":"a","colour":"#010203","lost":[[1,2]],"ambiguous":[[2,2]],"points":[[1,2],[3,4],[5,6]]}]}');
  assert.deepEqual(ambiguous.marks[0]!.isLost, [false, true, true]);
  assert.deepEqual(ambiguous.marks[0]!.isAmbiguous, [false, false, true]);
  assert.deepEqual(curve(track, track.marks[0]!, 1), [[0, (2 / 240) * 100], null, null]);
  assert.deepEqual(readTrack("nothing").marks, []);
});

/** A socket that keeps what is sent. */
function fakeSocket() {
  const sent: unknown[] = [];
  const listeners = new Map<string, (event: unknown) => void>();
  const socket = { readyState: 1, send: (data: unknown) => sent.push(data), close: () => {}, addEventListener: (name: string, listener: (event: unknown) => void) => listeners.set(name, listener) };
  return { sent, socket: socket as unknown as Socket, hear: (data: string) => listeners.get("message")?.({ data }), end: () => listeners.get("close")?.({}) };
}

test("one frame is on its way at a time, and none is sent twice", () => {
  const { sent, socket, hear, end } = fakeSocket();
  const received: FromTracker[] = [];
  let ends = 0;
  const link = new Link(socket, () => {}, (message) => received.push(message), () => ends++);
  assert.ok(link.isReady && link.frame(PIXELS, 10));
  assert.ok(!link.isReady, "the first frame is not answered yet");
  hear('{"type":"marks","marks":[]}');
  assert.ok(!link.isReady);
  hear('{"type":"seen","sequence":1,"marks":[],"recorded":0}');
  assert.ok(link.isReady);
  assert.ok(!link.frame(PIXELS, 10) && !link.frame(PIXELS, 9), "the same picture, and an older one");
  assert.ok(link.frame(PIXELS, 20));
  hear('{"type":"error","message":"no frame","isFrame":true}');
  assert.ok(link.isReady);
  assert.deepEqual(sent.map((message) => new DataView(message as ArrayBuffer).getUint32(0, true)), [1, 2]);
  assert.equal(received.length, 3);
  end();
  end();
  assert.equal(ends, 1);
});

test("a connection that the page closes is not lost", () => {
  const { socket, end } = fakeSocket();
  const link = new Link(socket, () => {}, () => {}, () => assert.fail("lost"));
  link.close();
  end();
});

test("pictures are found by their time", () => {
  assert.deepEqual([-5, 0, 4, 6, 10, 99].map((time) => nearest([0, 10, 20], time)), [0, 0, 0, 1, 1, 2]);
  assert.equal(nearest([], 3), 0);
});

test("pictures of all cameras are made small, and small ones stay", () => {
  assert.deepEqual(smallSize(640, 480), { width: 320, height: 240 });
  assert.deepEqual(smallSize(1080, 1920), { width: 180, height: 320 });
  assert.deepEqual(smallSize(160, 120), { width: 160, height: 120 });
});

test("trails have gaps where the mark is lost", () => {
  assert.equal(trailPath([[1, 2], [3, 4], null, [5, 6]]), "M1.0 2.0L3.0 4.0M5.0 6.0");
  assert.equal(trailPath([]), "");
});

test("the drawing's marks are offered, and the strings for the track told", () => {
  const part = (name: string, value: string) => ({ name, parent: null, kind: "main" as const, element: "", namedBy: null, string: null, attributes: [{ name: "Mark", value, from: "own" as const }], joint: null, depth: null, depthWhy: null, back: null, form: null, undo: { depth: null, back: null, form: null } });
  assert.deepEqual(markNames(new Parts([part("a", "red"), part("b", "#102030"), part("c", "red"), part("d", "blue")])), ["red", "blue"]);
  const said = strings("hands.json", [{ name: "red", color: "#d01020" }, { name: "left-hand", color: "#1020d0" }], (name) => name === "red");
  assert.deepEqual(said, { perform: 'Perform "hands.json"', marks: ["Mark red", "Mark #1020d0"] });
});

test("any name becomes that of a file", () => {
  assert.deepEqual(["", "arms", "arms.json", "../a/b.JSON", 'a "b"'].map(fileName), ["hands.json", "arms.json", "arms.json", "ab.json", "a b.json"]);
});

test("each failure of a camera has its words", () => {
  const named = (name: string) => whyNot(Object.assign(new Error(), { name }));
  assert.match(named("NotAllowedError"), /Allow it/);
  assert.match(named("NotFoundError"), /no camera/);
  assert.match(named("NotReadableError"), /Another program/);
  assert.match(whyNot(new Error("insecure")), /secure/);
  assert.match(whyNot("?"), /could not be started/);
});
