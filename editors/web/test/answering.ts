// A worker for tests.

import type { Call, Effects, FromWorker, Port, Value } from "../src/host/worker/calls";

/** A worker that answers when a test says so. */
export class Answering implements Port {
  readonly asked: Call[] = [];
  ended = false;
  private listeners: ((event: { data: FromWorker }) => void)[] = [];
  private errors: ((event: { message?: string }) => void)[] = [];

  postMessage(call: Call): void {
    this.asked.push(call);
  }
  terminate(): void {
    this.ended = true;
  }
  addEventListener(type: "message" | "error", listener: unknown): void {
    if (type === "message") this.listeners.push(listener as (event: { data: FromWorker }) => void);
    else this.errors.push(listener as (event: { message?: string }) => void);
  }
  say(data: FromWorker): void {
    for (const listener of this.listeners) listener({ data });
  }
  fail(message: string): void {
    for (const listener of this.errors) listener({ message });
  }
  done(effects: Partial<Effects> & { value?: Value } = {}): void {
    this.say({ type: "done", value: undefined, messages: [], texts: [], refused: [], ...effects });
  }
}
