import assert from "node:assert/strict";
import { test } from "node:test";
import { words, type Facts } from "../src/status-text";

const running = { kind: "running", version: "0.1.0" } as const;
const say = (facts: Facts) => words(running, facts).text;

test("a drawing without strings has no counts", () => {
  assert.deepEqual(words(running, { parts: 0, errors: 0, warnings: 0 }), words(running, undefined));
  assert.equal(words(running, undefined).text, "Okoshi");
});

test("parts are counted, errors come before warnings", () => {
  assert.equal(say({ parts: 1, errors: 0, warnings: 0 }), "Okoshi: 1 part");
  assert.equal(say({ parts: 14, errors: 0, warnings: 0 }), "Okoshi: 14 parts");
  assert.equal(say({ parts: 14, errors: 0, warnings: 1 }), "Okoshi: 1 warning in 14 parts");
  assert.equal(say({ parts: 14, errors: 2, warnings: 1 }), "Okoshi: 2 errors, 1 warning in 14 parts");
});

test("the colour follows the worst severity", () => {
  assert.equal(words(running, { parts: 1, errors: 1, warnings: 1 }).severity, "error");
  assert.equal(words(running, { parts: 1, errors: 0, warnings: 1 }).severity, "warning");
  assert.equal(words(running, { parts: 1, errors: 0, warnings: 0 }).severity, "information");
  assert.equal(words({ kind: "missing", path: "okoshi" }, undefined).severity, "warning");
  assert.equal(words({ kind: "failed", why: "no" }, undefined).severity, "error");
});

test("counts are not shown while the server is not running", () => {
  const facts = { parts: 9, errors: 9, warnings: 9 };
  for (const kind of ["idle", "starting", "stopped"] as const) assert.doesNotMatch(words({ kind }, facts).text, /9/);
  assert.equal(words({ kind: "starting" }, facts).busy, true);
});

test("a missing program is named", () => {
  assert.match(words({ kind: "missing", path: "/opt/okoshi" }, undefined).detail, /\/opt\/okoshi/);
});
