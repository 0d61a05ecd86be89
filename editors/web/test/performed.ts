// Performed figures, as `okoshi preview` sends them: the mark of the right hand strikes late, and that of the left one hardly moves.

import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { WebSocket } from "ws";
import { closeAll, PATIENCE, preview, within, type Close } from "./closing";
import type { Made } from "./drawings";

const CASE = join("..", "..", "tests", "cases", "perform-plays");

/** The figure of the case with other clips. The arm that strikes is red, to be found in pictures. */
export const puppet = (clips: string): string => readFileSync(join(CASE, "drawing.svg"), "utf8").replace(/%Perform[^<]*/, clips).replace('fill="#888888" id="rarm"', 'fill="#e02010" id="rarm"');

/** The build of a drawing beside the case's track, `hands.json`. */
export async function performed(okoshi: string, drawing: string): Promise<Made> {
  const folder = mkdtempSync(join(tmpdir(), "okoshi-performed-"));
  writeFileSync(join(folder, "drawing.svg"), drawing);
  writeFileSync(join(folder, "hands.json"), readFileSync(join(CASE, "hands.json")));
  const open: Close[] = [() => rmSync(folder, { recursive: true })];
  try {
    const { address } = await preview(okoshi, folder, "drawing.svg", (close) => open.push(close));
    const build = await within(PATIENCE, "the first build", firstBuild(address));
    const file = async (path: unknown) => Buffer.from(await (await fetch(new URL(String(path), address))).arrayBuffer());
    return { model: await file(build["model"]), originals: build["originals"] === null ? null : await file(build["originals"]), picture: null, build };
  } finally {
    await closeAll(open);
  }
}

/** The first build with a model that a host sends. */
async function firstBuild(address: string): Promise<Record<string, unknown>> {
  const socket = new WebSocket(new URL("/live", address.replace(/^http/, "ws")), { origin: new URL(address).origin });
  try {
    return await new Promise((found, failed) => {
      socket.on("error", failed);
      socket.on("message", (data) => {
        const message = JSON.parse(String(data)) as { type: string; build?: Record<string, unknown> };
        if (message.type === "build" && message.build?.["model"]) found(message.build);
      });
    });
  } finally {
    socket.terminate();
  }
}
