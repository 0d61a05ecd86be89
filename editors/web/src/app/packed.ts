// Compressed drawings (`.svgz`): they are unpacked when they are opened, and drawings like all others from then on.

import type { Opened } from "./access";
import { collect, TooLarge } from "./collect";
import { kindOf } from "./kinds";

/** The largest drawing that is unpacked, in bytes: a few of them can unpack to any number. */
const LARGEST = 64 << 20;

/** A compressed drawing as a plain one, or with the reason why it cannot be one; all other files as they are. Compression is recognised by the first bytes, not by the name. */
export async function unpacked(opened: Opened): Promise<Opened> {
  const { path, bytes } = opened;
  if (kindOf(path) !== "drawing") return opened;
  const plain = path.replace(/\.svgz$/i, ".svg");
  const isPacked = bytes[0] === 0x1f && bytes[1] === 0x8b;
  // The file that was opened is not written: programs expect it to be compressed.
  if (!isPacked) return plain === path ? opened : { ...opened, path: plain, handle: null };
  try {
    const text = await collect(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")), LARGEST);
    return { ...opened, path: plain, bytes: text, handle: null, packedAs: path };
  } catch (error) {
    return { ...opened, trouble: error instanceof TooLarge ? `${path} is larger than ${LARGEST >> 20} MiB when it is unpacked: save it as plain SVG.` : `${path} is compressed, but damaged: save it again, or as plain SVG.` };
  }
}
