// The strings that a drawing needs for a recorded track.

import type { Parts } from "../parts";
import type { Mark } from "./messages";

/** The names of the drawing's `Mark`s, each once. Colours by number are no names. */
export function markNames(parts: Parts): string[] {
  const values = parts.all.flatMap(({ attributes }) => attributes.filter(({ name }) => name === "Mark").map(({ value }) => value));
  return [...new Set(values)].filter((value) => /^[\p{L}\p{N}_-]+$/u.test(value));
}

/** What is written for a track: a `Perform`, and the `Mark` of each part. Marks are named by their colour; others by its number. */
export function strings(file: string, marks: readonly Mark[], isColor: (name: string) => boolean): { readonly perform: string; readonly marks: readonly string[] } {
  return { perform: `Perform "${file}"`, marks: marks.map(({ name, color }) => `Mark ${isColor(name) ? name : color}`) };
}

/** A name for a file: what a person typed, without folders, and with its extension. */
export function fileName(typed: string): string {
  const name = typed.trim().replace(/["\\/:*?<>|]/g, "").replace(/^\.+/, "").replace(/\.json$/i, "");
  return `${name || "hands"}.json`;
}
