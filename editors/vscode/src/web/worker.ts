// The worker: loads the module, and serves the extension with it.

import init, { Server } from "okoshi_web";
import { BrowserMessageReader, BrowserMessageWriter, createMessageConnection } from "vscode-jsonrpc/browser";
import { Language } from "./language";

declare const self: DedicatedWorkerGlobalScope;

// The first message is the compiled module. Others wait in the reader until it is loaded.
self.addEventListener(
  "message",
  ({ data }: MessageEvent<WebAssembly.Module>) => {
    const reader = new BrowserMessageReader(self);
    const early: MessageEvent[] = [];
    const wait = (event: MessageEvent): void => void early.push(event);
    self.addEventListener("message", wait);
    init({ module_or_path: data }).then(
      () => {
        self.removeEventListener("message", wait);
        new Language(new Server(), createMessageConnection(reader, new BrowserMessageWriter(self)));
        for (const event of early) self.dispatchEvent(new MessageEvent("message", { data: event.data }));
      },
      // Outside of the promise, so that the extension is told.
      (error: unknown) => setTimeout(() => {
        throw error;
      }),
    );
  },
  { once: true },
);
