// Moving pictures, made by a worker of their own: the other one goes on with the drawing meanwhile.

import { Calls, type Port } from "./calls";

/** Makes a moving picture. `slow` is called if it takes long, with what gives it up. */
export function film(port: Port, call: { readonly bytes: Uint8Array<ArrayBuffer>; readonly clip: number | null; readonly view: readonly [number, number] }, slow: (stop: () => void) => void, long?: number): Promise<Blob> {
  return new Promise((resolve, reject) => {
    const end = (why: string): void => {
      calls.end();
      reject(new Error(why));
    };
    const calls: Calls = new Calls(port, {
      ready: () => {},
      failed: (why) => end(`okoshi could not be loaded: ${why}`),
      done: () => {},
      stopped: () => end("okoshi stopped while it made one, perhaps because there is not enough memory"),
      slow: () => slow(() => end("you stopped it")),
    }, long);
    calls.make({ call: "film", ...call }).then(
      (value) => {
        calls.end();
        if (value instanceof Uint8Array) resolve(new Blob([value], { type: "image/gif" }));
        else reject(new Error(String(value)));
      },
      // It was ended, and why is said already.
      () => {},
    );
  });
}
