// The host over HTTP: messages through a WebSocket, models and pictures by GET.

import { Messages, type FromHost, type ToHost } from "../protocol";
import { download } from "./download";
import type { Answer, Attempted, Host, Link } from "./host";
import { Replaced } from "./replaced";

/** Delays between attempts to connect, in milliseconds. */
const FIRST_PAUSE = 200;
const LAST_PAUSE = 5000;
/** How long an attempt may take, in milliseconds. */
const PATIENCE = 10000;

export class WebHost implements Host {
  readonly showsFindings = false;
  readonly changes = { doing: "Saving…", done: "Saved", where: "Changes are saved in the drawing" };
  readonly invitation = {
    heading: "Begin with a drawing",
    toStarters: "A click writes it into this folder, to draw on in Inkscape. Drawings saved in the folder appear here, too.",
    alone: "Drawings saved in the folder appear here.",
  };
  readonly jumps = true;
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
    // Reconnects at once when the user looks at the page again or is online again.
    addEventListener("online", () => this.hurry());
    document.addEventListener("visibilitychange", () => {
      if (!document.hidden) this.hurry();
    });
  }

  send(message: ToHost): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  model(address: string): Promise<ArrayBuffer> {
    // Not fetch(), which takes about 4 ms longer for a megabyte. The server forbids caching: after a restart it counts builds from the
    // beginning, so the same address may be another model.
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open("GET", address);
      request.responseType = "arraybuffer";
      request.onload = () => {
        if (request.status === 200) resolve(request.response as ArrayBuffer);
        else if (request.status === 204) reject(new Replaced());
        else reject(new Error(`the server answered ${request.status}`));
      };
      request.onerror = () => reject(new Error("the server did not answer"));
      request.send();
    });
  }

  async picture(address: string): Promise<string> {
    return address;
  }

  readonly save = download;

  readonly film = async (model: string, clip: number | null, view: readonly [number, number]): Promise<Blob> => {
    // Moving pictures have the numbers of their models.
    const address = model.replace(/^builds\/(\d+)\.glb$/, "films/$1.gif");
    const asked = `view=${view.map((angle) => angle.toFixed(2)).join(",")}`;
    return this.file(clip === null ? `${address}?${asked}` : `${address}?clip=${clip}&${asked}`);
  };

  readonly file = async (address: string): Promise<Blob> => {
    const response = await fetch(address);
    if (response.ok) return response.blob();
    throw new Error(response.status === 404 ? "the drawing was built again meanwhile; try once more" : (await response.text()) || `the server answered ${response.status}`);
  };

  readonly post = async (what: "changes" | "forms", key: string, request: unknown): Promise<Answer> => {
    const response = await this.posted(what, key, request);
    return { ok: response.ok, body: await response.json().catch(() => null) };
  };

  readonly attempt = async (key: string, request: unknown): Promise<Attempted | null> => {
    const response = await this.posted("tries", key, request);
    const address = response.headers.get("okoshi-model");
    return response.status === 200 && address !== null ? { address, bytes: await response.arrayBuffer() } : null;
  };

  readonly share = null;
  readonly player = null;
  readonly openCamera = (): WebSocket => new WebSocket(socketAddress("camera"));

  private posted(what: string, key: string, request: unknown): Promise<Response> {
    return fetch(what, { method: "POST", headers: { "content-type": "application/json", "okoshi-key": key }, body: JSON.stringify(request) });
  }

  private hurry(): void {
    if (this.timer === undefined) return;
    this.pause = FIRST_PAUSE;
    this.connect();
  }

  private connect(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    const socket = new WebSocket(socketAddress("live"));
    this.socket = socket;
    const messages = new Messages();
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
      const message = messages.read(json);
      // The next connection begins with everything.
      if (message === "missed") socket.close();
      else if (message) this.handler(message);
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

function socketAddress(path: string): URL {
  const address = new URL(path, location.href);
  address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
  address.hash = "";
  return address;
}
