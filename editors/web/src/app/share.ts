// Links that hold a drawing: packed, behind the # of the page's address. Browsers send nothing of that to a server.

import { toBase64 } from "../host/base64";
import { collect } from "./collect";

/** The longest link that is made, in letters: browsers take longer ones, but what people send links with cuts them off. */
export const LONGEST = 32_000;
/** The largest text that a link may unpack to, in bytes: a few letters can pack a thousand times as much. */
const LARGEST = 8 << 20;
/** No name is longer, in letters. */
const LONGEST_NAME = 80;

const MARK = /^#name=[^&]*&drawing=/;

export interface Shared {
  readonly name: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

/** Whether the part of an address behind its # is of such a link: that of others is one name, in which there is no =. */
export const isShared = (hash: string): boolean => MARK.test(hash);

/** A link to a drawing on a page. */
export async function linkTo(page: string, { name, bytes }: Shared): Promise<string> {
  // With a checksum, unlike `deflate-raw`.
  const packed = await collect(new Blob([bytes]).stream().pipeThrough(new CompressionStream("deflate")), Infinity);
  const letters = toBase64(packed).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  return `${page.replace(/#.*$/s, "")}#name=${encodeURIComponent(name)}&drawing=${letters}`;
}

/** The drawing in a link. Rejects if it was cut off or changed on its way, or is too large. */
export async function sharedIn(hash: string): Promise<Shared> {
  const query = new URLSearchParams(hash.slice(1));
  const packed = Uint8Array.from(atob((query.get("drawing") ?? "").replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
  const bytes = await collect(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate")), LARGEST);
  // What is no text is no drawing.
  if (new TextDecoder("utf-8", { fatal: true }).decode(bytes).trim() === "") throw new Error("it is empty");
  return { name: fileName(query.get("name") ?? ""), bytes };
}

/** A name for the drawing of a link, which anybody may have written: without folders, and of a drawing. */
function fileName(name: string): string {
  const own = name.replace(/^.*[\\/]/s, "").replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu, "").replace(/\.svg$/i, "").trim();
  return `${[...own].slice(0, LONGEST_NAME).join("") || "drawing"}.svg`;
}
