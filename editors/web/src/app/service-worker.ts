// Keeps the files of the program in the browser, so that it opens without a network. A new version is taken as a whole, when no page of the old one is open.

/** What TypeScript does not know of service workers without knowing nothing of pages. */
interface Extendable extends Event {
  waitUntil(done: Promise<unknown>): void;
}
interface Fetched extends Extendable {
  readonly request: Request;
  respondWith(response: Promise<Response>): void;
}
interface Scope {
  readonly registration: { readonly scope: string };
  readonly clients: { claim(): Promise<void> };
  addEventListener(type: "install" | "activate", listener: (event: Extendable) => void): void;
  addEventListener(type: "fetch", listener: (event: Fetched) => void): void;
}

/** The files by their addresses from the folder, and their version; put here when the folder is made. */
declare const FILES: readonly string[];
declare const VERSION: string;

const scope = globalThis as unknown as Scope;
const NAME = `okoshi ${VERSION}`;
const addresses = new Set(FILES.map((file) => new URL(file, scope.registration.scope).href));

scope.addEventListener("install", (event) => {
  // Not from the browser's other cache, which may hold those of the last version.
  const requests = [...addresses].map((address) => new Request(address, { cache: "reload" }));
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(requests)));
});

scope.addEventListener("activate", (event) => {
  const clear = async (): Promise<void> => {
    for (const name of await caches.keys()) if (name.startsWith("okoshi ") && name !== NAME) await caches.delete(name);
    await scope.clients.claim();
  };
  event.waitUntil(clear());
});

scope.addEventListener("fetch", (event) => {
  const address = new URL(event.request.url);
  address.search = address.hash = "";
  if (event.request.method !== "GET" || !addresses.has(address.href)) return;
  event.respondWith(caches.open(NAME).then(async (cache) => (await cache.match(address.href)) ?? fetch(event.request)));
});
