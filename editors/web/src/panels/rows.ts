// The rows of the hierarchy: which parts are shown, in which order, and how deep.

import { isAside, type Parts } from "../parts";
import type { Part } from "../protocol";

export interface Row {
  readonly part: Part;
  /** Depth in the hierarchy, from 1. */
  readonly level: number;
  /** Whether its children are shown; null if it has none. */
  readonly open: boolean | null;
  /** Its place among its siblings, from 1, and their number. */
  readonly place: number;
  readonly among: number;
}

/** The heading above the parts that are not in the model. */
export const HEADING = "heading";
export type Line = Row | typeof HEADING;

export const isRow = (line: Line | undefined): line is Row => line !== undefined && line !== HEADING;

/** The lines of all parts whose ancestors are open; with words to search for, those of the parts that match and their ancestors. */
export function linesOf(parts: Parts, words: readonly string[], isOpen: (part: Part) => boolean): Line[] {
  const found = words.length > 0 ? matching(parts, words) : null;
  const shown = (siblings: readonly Part[]): readonly Part[] => (found ? siblings.filter((part) => found.has(part)) : siblings);
  const lines: Line[] = [];
  const walk = (siblings: readonly Part[], level: number): void => {
    siblings.forEach((part, at) => {
      const below = shown(parts.children(part.name));
      const open = below.length === 0 ? null : found !== null || isOpen(part);
      lines.push({ part, level, open, place: at + 1, among: siblings.length });
      if (open) walk(below, level + 1);
    });
  };
  walk(shown(parts.children(null)), 1);
  const aside = shown(parts.aside);
  if (aside.length > 0) lines.push(HEADING);
  aside.forEach((part, at) => lines.push({ part, level: 1, open: null, place: at + 1, among: aside.length }));
  return lines;
}

/** The parts that match, and the ancestors of those in the model. */
function matching(parts: Parts, words: readonly string[]): ReadonlySet<Part> {
  const found = new Set<Part>();
  const walk = (siblings: readonly Part[]): boolean => {
    let any = false;
    for (const part of siblings) {
      const below = walk(parts.children(part.name));
      if (!below && !isMatch(part, words)) continue;
      found.add(part);
      any = true;
    }
    return any;
  };
  walk(parts.children(null));
  for (const part of parts.aside) if (isMatch(part, words)) found.add(part);
  return found;
}

/** Whether name, id or string of a part contain all words, which `wordsOf` made. */
export function isMatch(part: Part, words: readonly string[]): boolean {
  const text = searchable(part);
  return words.every((word) => text.includes(word));
}

/** The words that are searched for. */
export const wordsOf = (query: string): string[] => plain(query).split(/\s+/).filter(Boolean);

const searchables = new WeakMap<Part, string>();
function searchable(part: Part): string {
  let text = searchables.get(part);
  if (text === undefined) searchables.set(part, (text = plain(`${part.name} #${part.element} ${part.string?.text ?? ""}`)));
  return text;
}

/** Text without case and accents. */
function plain(text: string): string {
  return text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
}

/** The name that a row shows: legends have none, their text identifies them. */
export const titleOf = (part: Part): string => (isAside(part) && part.string ? part.string.text : part.name);

/** The index of the next row after one whose title begins with the typed text, going round; the row itself if it still fits longer text. Null if there is none. */
export function typedAhead(lines: readonly Line[], from: number, typed: string): number | null {
  const wanted = plain(typed);
  // The same letter again goes on to the next row that begins with it.
  const again = wanted.length > 1 && [...wanted].every((letter) => letter === wanted[0]);
  const start = wanted.length === 1 || again ? 1 : 0;
  for (let step = start; step <= lines.length; step++) {
    const at = (from + step) % lines.length;
    const line = lines[at];
    if (isRow(line) && plain(titleOf(line.part)).startsWith(again ? wanted[0]! : wanted)) return at;
  }
  return null;
}
