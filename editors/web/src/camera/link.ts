// The connection to the program that tracks marks: one frame is on its way at a time, so that none waits in a queue.

import { frameMessage, readMessage, type FromTracker, type Pixels, type ToTracker } from "./messages";

/** What a connection needs of a WebSocket. */
export type Socket = Pick<WebSocket, "send" | "close" | "readyState" | "addEventListener">;

/** `WebSocket.OPEN`, also where there is no WebSocket. */
const OPEN = 1;

export class Link {
  private sequence = 0;
  private onTheWay = 0;
  private lastTime = -Infinity;
  private isClosed = false;

  /** `opened` is called when messages can be sent: earlier ones are dropped. */
  constructor(private readonly socket: Socket, opened: () => void, received: (message: FromTracker) => void, lost: () => void) {
    socket.addEventListener("open", () => {
      if (!this.isClosed) opened();
    });
    socket.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
      const message = readMessage(data);
      if (!message || this.isClosed) return;
      if (message.type === "seen" || (message.type === "error" && message.isFrame)) this.onTheWay = Math.max(this.onTheWay - 1, 0);
      received(message);
    });
    socket.addEventListener("close", () => {
      if (this.isClosed) return;
      this.isClosed = true;
      lost();
    });
  }

  /** Whether the program is ready for a frame; frames that come earlier are left out. */
  get isReady(): boolean {
    return this.socket.readyState === OPEN && this.onTheWay === 0;
  }

  /** Sends a frame that was taken at a time in milliseconds, unless it was sent already. Returns whether it was sent. */
  frame(pixels: Pixels, time: number): boolean {
    if (this.socket.readyState !== OPEN || time < this.lastTime + 1) return false;
    this.lastTime = time;
    this.onTheWay++;
    this.sequence++;
    this.socket.send(frameMessage(this.sequence, pixels, time));
    return true;
  }

  ask(message: ToTracker): void {
    if (this.socket.readyState === OPEN) this.socket.send(JSON.stringify(message));
  }

  close(): void {
    this.isClosed = true;
    this.socket.close();
  }
}
