// What files are to okoshi, by the ends of their names.

/** What drawings may link to. */
const LINKED = ["bvh", "png", "jpg", "jpeg", "gif", "webp", "json", "tmx", "tmj", "tsx", "tsj", "glb"];

/** How drawings are made of other files. */
const WAYS: Readonly<Record<string, string>> = {
  ai: "save it as SVG in the program that made it",
  cdr: "save it as SVG in the program that made it",
  pdf: "open it in Inkscape and save it as SVG",
  eps: "open it in Inkscape and save it as SVG",
  kra: "save it as SVG, or as PNG and open that",
  psd: "save it as PNG and open that",
};

/** Pictures, of which a drawing can be made. */
export const isPicture = (path: string): boolean => /\.(png|jpe?g|gif|webp)$/i.test(path);

export type Kind = "drawing" | "linked";

/** The kind of a file, or why it is none, as a sentence. */
export function kindOf(path: string): Kind | { readonly why: string } {
  const ending = /\.([^./]+)$/.exec(path.toLowerCase())?.[1] ?? "";
  if (ending === "svg" || ending === "svgz") return "drawing";
  if (LINKED.includes(ending)) return "linked";
  const way = WAYS[ending] ?? "okoshi reads SVG, and the motions, pictures and maps that a drawing links to";
  return { why: `${path} is no drawing: ${way}.` };
}
