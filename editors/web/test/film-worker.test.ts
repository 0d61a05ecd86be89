// Moving pictures by a worker of their own, without a browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { film } from "../src/host/worker/film";
import { Answering } from "./answering";

const call = { bytes: Uint8Array.of(1), clip: 2, view: [30, 15] as const };

test("a film is what its worker made, which is ended then", async () => {
  const port = new Answering();
  const made = film(port, call, () => {});
  port.say({ type: "ready" });
  assert.deepEqual(port.asked, [{ call: "film", ...call }]);
  port.done({ value: new TextEncoder().encode("GIF89a") });
  assert.deepEqual([(await made).type, await (await made).text(), port.ended], ["image/gif", "GIF89a", true]);
});

test("why there is no film is said: by the program, after a fault, without the program, and when a person stopped it", async () => {
  const fails = async (act: (port: Answering) => void, why: RegExp): Promise<void> => {
    const port = new Answering();
    const made = film(port, call, () => {});
    act(port);
    await assert.rejects(made, why);
    assert.ok(port.ended);
  };
  const answers = (act: (port: Answering) => void) => (port: Answering) => (port.say({ type: "ready" }), act(port));
  await fails(answers((port) => port.done({ value: "the clip lasts 90 seconds" })), /^Error: the clip lasts 90 seconds$/);
  await fails(answers((port) => port.say({ type: "stopped" })), /not enough memory/);
  await fails((port) => port.say({ type: "failed", why: "this browser is too old for it" }), /could not be loaded: this browser is too old/);
  const port = new Answering();
  const made = film(port, call, (stop) => stop(), 1);
  port.say({ type: "ready" });
  await assert.rejects(made, /you stopped it/);
  assert.ok(port.ended);
});
