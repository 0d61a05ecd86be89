// Tests of the page end, also those that fail: in each phase of a test something is let fail or hang, in a process of its own.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { closeAll, within } from "./closing";
import type { MockHost } from "./mock";
import { browse, skip } from "./setup";

const never = (): Promise<never> => new Promise(() => {});

// A file that takes no time to show.
const light = (host: MockHost): void => void host.broken.add("/light.html");

/** What goes wrong in the test of the other process, how it is told, and the limits that are reached. */
const FAULTS: Readonly<Record<string, { told: RegExp; limits?: Readonly<Record<string, string>>; prepare?(host: MockHost): void; run?(): Promise<void> }>> = {
  "the host does not start": { told: /no host/, prepare: (host) => { host.start = () => Promise.reject(new Error("no host")); } },
  "the page does not load": { told: /page\.goto: Timeout/, limits: { PATIENCE: "4" }, prepare: (host) => { host.silent = true; } },
  "the test fails": { told: /as expected/, run: () => Promise.reject(new Error("as expected")) },
  "the test hangs": { told: /test timed out/, limits: { TEST_LIMIT: "15" }, run: never },
  "the host does not stop": { told: /closing took more than/, limits: { PATIENCE: "4" }, prepare: (host) => {
    light(host);
    const stop = host.stop.bind(host);
    host.stop = async () => {
      await stop();
      return never();
    };
  } },
};

const fault = process.env["FAULT"];
if (fault !== undefined) {
  const { prepare, run } = FAULTS[fault]!;
  browse(fault, prepare ?? light, async () => run?.(), { hash: "light.html" });
} else {
  test("everything is closed, what was opened last first, though one fails and one hangs", async () => {
    const closed: string[] = [];
    const open = [() => closed.push("first"), never, () => Promise.reject(new Error("stuck")), () => closed.push("last")];
    await assert.rejects(closeAll(open, 20), /stuck; Error: closing took more than 0\.02 s/);
    assert.deepEqual(closed, ["last", "first"]);
    assert.deepEqual(open, []);
  });

  for (const [name, { told, limits }] of Object.entries(FAULTS)) {
    test(`the process ends when ${name}`, { skip }, async (t) => {
      // Otherwise the process would report to the runner of this file.
      const { NODE_TEST_CONTEXT: _, ...env } = process.env;
      const child = spawn(process.execPath, [fileURLToPath(import.meta.url)], { env: { ...env, FAULT: name, ...limits }, stdio: ["ignore", "pipe", "inherit"] });
      t.after(() => child.kill("SIGKILL"));
      let output = "";
      child.stdout.on("data", (text) => (output += String(text)));
      const status = await within(600_000, "the process", new Promise((resolve) => child.once("close", resolve)));
      assert.equal(status, 1);
      assert.match(output, told);
    });
  }
}
