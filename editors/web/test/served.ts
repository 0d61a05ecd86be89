// Serves the page that was just bundled, as an editor does: its files, and nothing else.

import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { join } from "node:path";
import { DIST } from "./browser";

const FILES: Readonly<Record<string, readonly [file: string, type: string]>> = { "/": ["page.html", "text/html"], "/page.js": ["page.js", "text/javascript"], "/page.css": ["page.css", "text/css"] };

export async function servePage(): Promise<{ address: string; close(): Promise<void> }> {
  const server = createServer(({ url }, response) => {
    const found = FILES[url ?? ""];
    response.writeHead(found ? 200 : 204, found ? { "content-type": found[1] } : {});
    response.end(found && readFileSync(join(DIST, found[0])));
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  const close = (): Promise<void> =>
    new Promise((resolve) => {
      server.close(() => resolve());
      server.closeAllConnections();
    });
  return { address: `http://127.0.0.1:${(server.address() as AddressInfo).port}/`, close };
}
