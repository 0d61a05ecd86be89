// A host for the page: serves the bundle under a strict policy, models and pictures by GET, and messages through a WebSocket.

import { EventEmitter, once } from "node:events";
import { readFileSync } from "node:fs";
import { createServer, type IncomingMessage, type Server, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { join } from "node:path";
import { WebSocketServer, type WebSocket } from "ws";
import { PATIENCE, within } from "./closing";
import type { Made } from "./drawings";

/** What the tests need of the host. */
export const POLICY = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'";

const TYPES: Readonly<Record<string, string>> = { html: "text/html; charset=utf-8", js: "text/javascript; charset=utf-8", css: "text/css; charset=utf-8", glb: "model/gltf-binary", png: "image/png" };

interface Held {
  readonly id: string;
  name: string;
  folder: string;
  build: Record<string, unknown> | null;
  gone: boolean;
}

export class MockHost {
  private server: Server | null = null;
  private sockets: WebSocketServer | null = null;
  private readonly files = new Map<string, Buffer>();
  private readonly drawings = new Map<string, Held>();
  private builds = 0;
  private port = 0;
  /** The messages of the page. */
  readonly heard: Record<string, unknown>[] = [];
  private readonly events = new EventEmitter();
  /** Answers with models that wait for `release`; null if none has to wait. */
  private waiting: (() => void)[] | null = null;
  /** Whether requests are left without an answer. */
  silent = false;
  /** Addresses that return invalid files. */
  readonly broken = new Set<string>();
  /** Addresses of models that newer ones replaced: the answer is empty, as the program's. */
  readonly replaced = new Set<string>();
  /** What is offered while there are no drawings: names, and a picture of all of them. */
  offered: { readonly key: string; readonly names: readonly string[]; readonly picture: Buffer } | null = null;
  /** The requested addresses. */
  readonly asked: string[] = [];

  constructor(private readonly dist: string) {}

  get address(): string {
    return `http://127.0.0.1:${this.port}/`;
  }

  /** Starts to listen; after a stop on the same port. */
  async start(): Promise<void> {
    const server = createServer((request, response) => this.answer(request, response));
    this.sockets = new WebSocketServer({ server, path: "/live" });
    this.sockets.on("connection", (socket) => this.greet(socket));
    await new Promise<void>((resolve, reject) => server.once("error", reject).listen(this.port, "127.0.0.1", resolve));
    this.port = (server.address() as AddressInfo).port;
    this.server = server;
  }

  async stop(): Promise<void> {
    for (const socket of this.sockets?.clients ?? []) socket.terminate();
    this.sockets?.close();
    this.server?.closeAllConnections();
    await new Promise((resolve) => this.server?.close(resolve));
  }

  /** Restarts the count of builds, like a host that was restarted. */
  forget(): void {
    this.builds = 0;
    this.files.clear();
    this.drawings.clear();
  }

  add(id: string, name = id, folder = ""): void {
    this.drawings.set(id, { id, name, folder, build: null, gone: false });
    this.say({ type: "drawings", drawings: this.list() });
  }

  /** Adds a build. One with errors keeps the last good model. */
  built(id: string, { model, originals, exports, picture, build }: Made): void {
    const held = this.drawings.get(id)!;
    const number = ++this.builds;
    const before = held.build;
    if (model) this.files.set(`/builds/${number}.glb`, model);
    if (originals) this.files.set(`/builds/${number}.originals.glb`, originals);
    for (const [ending, file] of Object.entries(exports ?? {})) this.files.set(`/exports/${number}${ending}`, file);
    if (picture) this.files.set(`/builds/${number}.png`, picture);
    held.gone = false;
    held.build = {
      ...build,
      revision: number,
      model: model ? `builds/${number}.glb` : (before?.["model"] ?? null),
      originals: originals ? `builds/${number}.originals.glb` : null,
      exports: exports ? `exports/${number}` : null,
      picture: picture ? `builds/${number}.png` : (before?.["picture"] ?? null),
    };
    this.say({ type: "build", drawing: id, build: held.build, aFieldOfTheFuture: 1 });
  }

  gone(id: string): void {
    this.drawings.get(id)!.gone = true;
    this.say({ type: "gone", drawing: id });
  }

  say(message: unknown): void {
    for (const socket of this.sockets?.clients ?? []) socket.send(JSON.stringify(message));
  }

  /** The messages of a type, as soon as there are so many. */
  async messages(type: string, number: number): Promise<Record<string, unknown>[]> {
    const all = () => this.heard.filter((message) => message["type"] === type);
    await this.until(`${number} messages of the type ${type}`, () => all().length >= number);
    return all();
  }

  /** Waits until the page has requested an address. */
  async request(address: string): Promise<void> {
    await this.until(`a request for ${address}`, () => this.asked.includes(address));
  }

  /** Lets requests for models wait until `release`. */
  hold(): void {
    this.waiting ??= [];
  }

  release(): void {
    const waiting = this.waiting ?? [];
    this.waiting = null;
    for (const send of waiting) send();
  }

  private async until(what: string, holds: () => boolean): Promise<void> {
    const heard = async () => {
      while (!holds()) await once(this.events, "heard");
    };
    await within(PATIENCE, what, heard());
  }

  private list() {
    return [...this.drawings.values()].map(({ id, name, folder }) => ({ id, name, folder }));
  }

  private greet(socket: WebSocket): void {
    socket.on("message", (data) => {
      this.heard.push(JSON.parse(String(data)) as Record<string, unknown>);
      this.events.emit("heard");
    });
    if (this.offered) {
      const { key, names, picture } = this.offered;
      for (const name of names) this.files.set(`/starters/${name}.png`, picture);
      const starters = names.map((name) => ({ name, about: `A ${name}`, picture: name === "empty" ? null : `starters/${name}.png` }));
      socket.send(JSON.stringify({ type: "starters", key, starters }));
    }
    socket.send("not json");
    socket.send(JSON.stringify({ type: "ofTheFuture" }));
    socket.send(JSON.stringify({ type: "drawings", drawings: this.list() }));
    for (const { id, build, gone } of this.drawings.values()) {
      if (build) socket.send(JSON.stringify({ type: "build", drawing: id, build }));
      if (gone) socket.send(JSON.stringify({ type: "gone", drawing: id }));
    }
  }

  private answer({ url = "/" }: IncomingMessage, response: ServerResponse): void {
    const { pathname } = new URL(url, this.address);
    this.asked.push(pathname);
    this.events.emit("heard");
    if (this.silent) return;
    const page = pathname === "/" ? "page.html" : /^\/page\.(js|css)$/.test(pathname) ? pathname.slice(1) : null;
    const body = page ? readFileSync(join(this.dist, page)) : this.broken.has(pathname) ? Buffer.from("no model") : this.files.get(pathname);
    const type = TYPES[(page ?? pathname).split(".").at(-1) ?? ""] ?? "application/octet-stream";
    const send = () =>
      response
        .writeHead(this.replaced.has(pathname) ? 204 : body ? 200 : 404, { "content-type": type, "content-security-policy": POLICY, "x-content-type-options": "nosniff", "cache-control": "no-store" })
        .end(this.replaced.has(pathname) ? "" : (body ?? ""));
    if (this.waiting && pathname.endsWith(".glb")) this.waiting.push(send);
    else send();
  }
}
