// What tests open, and how long they wait. Whatever becomes of a test, what it opened is closed, so that the process can end.

import { spawn, type ChildProcess } from "node:child_process";
import { createInterface } from "node:readline";
import type { TestContext } from "node:test";

/** The limit of every wait, in milliseconds, which only ends a test that hangs: a page may load for a minute on a machine with other work. PATIENCE gives it in seconds. */
export const PATIENCE = 1000 * Number(process.env["PATIENCE"] ?? 180);
/** The limit of a test, in milliseconds: a few waits. TEST_LIMIT gives it in seconds. */
export const TEST_LIMIT = 1000 * Number(process.env["TEST_LIMIT"] ?? (5 * PATIENCE) / 1000);
/** The limit for the start of the browser, in milliseconds. */
export const LAUNCH_LIMIT = 180_000;

/** Closes something, at once or in time. */
export type Close = () => unknown;

/** The result of a promise, or an error that names what took longer than the limit. */
export async function within<T>(limit: number, what: string, promise: Promise<T>): Promise<T> {
  let timer: NodeJS.Timeout | undefined;
  const late = new Promise<never>((_, fail) => {
    timer = setTimeout(() => fail(new Error(`${what} took more than ${limit / 1000} s`)), limit);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** Closes all, what was opened last first, each within a limit in milliseconds; throws what failed afterwards. */
export async function closeAll(open: Close[], limit = PATIENCE): Promise<void> {
  const failures: unknown[] = [];
  for (let close = open.pop(); close; close = open.pop()) await within(limit, "closing", Promise.resolve().then(close)).catch((error: unknown) => failures.push(error));
  if (failures.length > 0) throw new AggregateError(failures, failures.map(String).join("; "));
}

/** Returns a function that registers what to close at the end of a test, also when the test fails or exceeds its limit. */
export function closing(t: Pick<TestContext, "after">): (close: Close) => void {
  const open: Close[] = [];
  // One hook, as node skips the hooks after one that fails.
  t.after(() => closeAll(open));
  return (close) => void open.push(close);
}

/** A program that serves a page. */
export interface Serving {
  readonly address: string;
  stop(): Promise<void>;
}

/** Starts `okoshi preview` in a folder, with more arguments. Returns its address. */
export const preview = (okoshi: string, folder: string, target: string, onClose: (close: Close) => void, more: readonly string[] = []): Promise<Serving> => serving(okoshi, folder, ["preview", target, ...more], onClose);

/** Starts a command of okoshi that serves a page, in a folder. Returns its address. */
export async function serving(okoshi: string, folder: string, words: readonly string[], onClose: (close: Close) => void): Promise<Serving> {
  const program = spawn(okoshi, [...words, "--quiet"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise<void>((resolve) => program.once("close", () => resolve()));
  const stop = (): Promise<void> => stopped(program, ended);
  onClose(stop);
  const address = new Promise<string>((found, failed) => {
    createInterface(program.stdout).once("line", found);
    program.once("error", failed);
    program.once("exit", (code) => failed(new Error(`okoshi ${words[0]} ended with ${code}`)));
  });
  return { address: await within(PATIENCE, `the start of okoshi ${words[0]}`, address), stop };
}

/** Ends a program, by force if it does not end by itself. */
async function stopped(program: ChildProcess, ended: Promise<void>): Promise<void> {
  program.kill();
  const force = setTimeout(() => program.kill("SIGKILL"), 5_000);
  await ended;
  clearTimeout(force);
}
