// Which documents are drawings, and whether one has strings. Independent of the editor.

const LANGUAGES = ["xml", "svg"];

/** The documents for the language server: `*.svg` files of these schemes in XML or SVG, and untitled XML or SVG. */
export function selector(schemes: readonly string[]): { scheme: string; language: string; pattern?: string }[] {
  const files = schemes.flatMap((scheme) => LANGUAGES.map((language) => ({ scheme, language, pattern: "**/*.svg" })));
  return [...files, ...LANGUAGES.map((language) => ({ scheme: "untitled", language }))];
}

/** `selector` as a function of a document's language, and its URI's scheme and path. */
export function isDrawing(schemes: readonly string[], language: string, scheme: string, path: string): boolean {
  if (!LANGUAGES.includes(language)) return false;
  return scheme === "untitled" || (schemes.includes(scheme) && path.endsWith(".svg"));
}

/** The name of a file by the path of its URI. */
export const nameOf = (path: string): string => path.slice(path.lastIndexOf("/") + 1);

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
