// A page that shows one model by itself: the player's page with the model in it.

import { toBase64 } from "../host/base64";

/** What such a page shows. */
export interface Played {
  readonly name: string;
  /** The model, as binary glTF in Base64. */
  readonly model: string;
  /** The clip that plays first; null for the first one. */
  readonly clip: string | null;
  /** From where the model is seen: degrees to its left, and up. */
  readonly view: readonly [number, number];
}

/** Puts a model into the player's page. */
export function playerWith(page: string, bytes: Uint8Array, shown: Omit<Played, "model">): Blob {
  const played: Played = { ...shown, model: toBase64(bytes) };
  // Nothing in a name ends the element that it is in.
  const json = JSON.stringify(played).replaceAll("<", "\\u003c");
  const title = shown.name.replace(/[&<>]/g, (sign) => `&#${sign.charCodeAt(0)};`);
  return new Blob([page.replace("OKOSHI_TITLE", () => title).replace("OKOSHI_SHOWN", () => json)], { type: "text/html" });
}
