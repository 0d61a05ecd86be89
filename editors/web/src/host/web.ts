// The host over http: messages through a WebSocket, models and pictures by GET.

import { read, type FromHost, type ToHost } from "../protocol";
import type { Host, Link } from "./host";

/** Pauses between attempts to connect, in milliseconds. */
const FIRST_PAUSE = 200;
const LAST_PAUSE = 5000;
/** How long an attempt may take before it is given up, in milliseconds. */
const PATIENCE = 10000;

export class WebHost implements Host {
  private socket: WebSocket | undefined;
  private pause = FIRST_PAUSE;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private handler: (message: FromHost) => void = () => {};
  private link: (state: Link) => void = () => {};

  listen(handler: (message: FromHost) => void, link: (state: Link) => void): void {
    this.handler = handler;
    this.link = link;
    this.link("connecting");
    this.connect();
    // Someone who looks at the page again, or is online again, need not wait out the pause.
    addEventListener("online", () => this.hurry());
    document.addEventListener("visibilitychange", () => {
      if (!document.hidden) this.hurry();
    });
  }

  send(message: ToHost): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  model(address: string): Promise<ArrayBuffer> {
    // Not by fetch(), which hands a megabyte over some 4 ms later. The server forbids to keep models: one that was started again
    // counts its builds anew, and what was kept under an address may be another model.
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open("GET", address);
      request.responseType = "arraybuffer";
      request.onload = () => {
        if (request.status === 200) resolve(request.response as ArrayBuffer);
        else reject(new Error(`the server answered ${request.status}`));
      };
      request.onerror = () => reject(new Error("the server did not answer"));
      request.send();
    });
  }

  async picture(address: string): Promise<string> {
    return address;
  }

  async save(name: string, content: Blob): Promise<void> {
    const address = URL.createObjectURL(content);
    const link = document.createElement("a");
    link.href = address;
    link.download = name;
    link.click();
    // The browser reads the blob after the click; a minute is long enough for it to begin.
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }

  private hurry(): void {
    if (this.timer === undefined) return;
    this.pause = FIRST_PAUSE;
    this.connect();
  }

  private connect(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    const address = new URL("live", location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    address.hash = "";
    const socket = new WebSocket(address);
    this.socket = socket;
    const patience = setTimeout(() => socket.close(), PATIENCE);
    socket.addEventListener("open", () => {
      clearTimeout(patience);
      this.pause = FIRST_PAUSE;
      this.link("open");
    });
    socket.addEventListener("message", ({ data }) => {
      if (typeof data !== "string") return;
      let json: unknown;
      try {
        json = JSON.parse(data);
      } catch {
        return;
      }
      const message = read(json);
      if (message) this.handler(message);
    });
    // An error is always followed by a close.
    socket.addEventListener("close", () => {
      clearTimeout(patience);
      if (this.socket !== socket) return;
      this.link("lost");
      this.timer = setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(this.pause * 2, LAST_PAUSE);
    });
  }
}
