// Which documents are drawings, and whether one has strings. Independent of the editor.

/** The documents for the language server: `*.svg` files in XML or SVG, and untitled XML or SVG. */
export const selector = [
  { scheme: "file", language: "xml", pattern: "**/*.svg" },
  { scheme: "file", language: "svg", pattern: "**/*.svg" },
  { scheme: "untitled", language: "xml" },
  { scheme: "untitled", language: "svg" },
];

/** `selector` as a function of a document's language, and its URI's scheme and path. */
export function isDrawing(language: string, scheme: string, path: string): boolean {
  if (language !== "xml" && language !== "svg") return false;
  return scheme === "untitled" || (scheme === "file" && path.endsWith(".svg"));
}

const annotated = /<(?:[\w-]+:)?(?:text|tspan|desc)\b[^<>]*>\s*(?:[%$*@％＄＊＠]|(?:"[^"<]*"|[^\s@$＠＄"()<>]+)[@$＠＄])/u;

/**
 * Whether a drawing's text seems to have strings: a text or description that begins with `%`, `$`, `*`, `@`,
 * `Name@` or `Name$`, including full-width signs. An approximation for when there is no language server.
 */
export function hasStrings(text: string): boolean {
  return annotated.test(text);
}

/** A node of the outline, for counting. */
export interface Outline {
  readonly children?: readonly Outline[] | undefined;
}

/** The number of entries in an outline, including nested ones. */
export function countOutline(nodes: readonly Outline[]): number {
  let count = 0;
  const waiting = [...nodes];
  for (let node = waiting.pop(); node !== undefined; node = waiting.pop()) {
    count += 1;
    if (node.children) waiting.push(...node.children);
  }
  return count;
}
