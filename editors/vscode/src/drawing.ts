// Which documents are drawings, and whether one has strings. Knows nothing of the editor.

/** What the language server looks after: `*.svg` files, whatever language they count as, and untitled XML. */
export const selector = [
  { scheme: "file", language: "xml", pattern: "**/*.svg" },
  { scheme: "file", language: "svg", pattern: "**/*.svg" },
  { scheme: "untitled", language: "xml" },
  { scheme: "untitled", language: "svg" },
];

/** The same as `selector`, of a document's language, its URI's scheme and path. */
export function isDrawing(language: string, scheme: string, path: string): boolean {
  if (language !== "xml" && language !== "svg") return false;
  return scheme === "untitled" || (scheme === "file" && path.endsWith(".svg"));
}

const annotated = /<(?:[\w-]+:)?(?:text|tspan|desc)\b[^<>]*>\s*(?:[%$*@％＄＊＠]|(?:"[^"<]*"|[^\s@$＠＄"()<>]+)[@$＠＄])/u;

/**
 * Whether a drawing's text seems to have strings: a text or description that begins with `%`, `$`, `*`, `@`,
 * `Name@` or `Name$`, full-width signs included. The language server knows better; this is for when there is none.
 */
export function hasStrings(text: string): boolean {
  return annotated.test(text);
}

/** A node of the outline, as far as counting goes. */
export interface Outline {
  readonly children?: readonly Outline[] | undefined;
}

/** How many entries an outline has, the inner ones included. */
export function countOutline(nodes: readonly Outline[]): number {
  let count = 0;
  const waiting = [...nodes];
  for (let node = waiting.pop(); node !== undefined; node = waiting.pop()) {
    count += 1;
    if (node.children) waiting.push(...node.children);
  }
  return count;
}
