// The kinds of `Shape` as little pictures: what becomes of an outline that is drawn on the ground, seen from above at an angle.

import { fill, h, inCode, svg } from "../dom";

/** A path, and how it is drawn. */
type Piece = readonly [look: "top" | "side" | "shade" | "line" | "dashed", path: string];

/** Pieces by kind, from back to front, in a picture of 48 × 36. */
const PICTURES: Readonly<Record<string, readonly Piece[]>> = {
  default: [["side", "M6 16v8l20 8v-8Z"], ["shade", "M26 24v8l16-9v-8Z"], ["top", "M6 16l16-9 20 8-16 9Z"]],
  roundv: [["side", "M16 8v20c0 3 3.6 5 8 5s8-2 8-5V8Z"], ["shade", "M27 13v19.600c3-.8 5-2.5 5-4.600V8c0 2.1-2 4-5 5Z"], ["top", "M16 8a8 4.5 0 1 0 16 0a8 4.5 0 1 0-16 0Z"]],
  roundh: [["side", "M10 10h28c3 0 5 3.6 5 8s-2 8-5 8H10Z"], ["shade", "M13 22h28.500c-.8 2.5-2 4-3.5 4H10c1.2 0 2.3-1.5 3-4Z"], ["top", "M10 10a4.5 8 0 1 0 0 16a4.5 8 0 1 0 0-16Z"]],
  round: [["side", "M11 18a13 13 0 1 0 26 0a13 13 0 1 0-26 0Z"], ["shade", "M35.5 11.9A13 13 0 0 1 14.65 27.03A17 17 0 0 0 35.5 11.9Z"], ["line", "M11 18c2 3.5 7 5 13 5s11-1.5 13-5"]],
  cone: [["side", "M24 4L9 27c0 3 6.7 5.5 15 5.500s15-2.5 15-5.500Z"], ["shade", "M24 4L39 27c0 2.4-4.3 4.5-10.3 5.200Z"]],
  conev: [["shade", "M31 5L17 13l9 18 17-10Z"], ["side", "M17 13L5 24l21 7Z"]],
  coneh: [["side", "M14 9l19 6-7 16L5 23Z"], ["shade", "M33 15l10 6-17 10Z"]],
  inflate: [["side", "M13 28c-6 0-9-3.5-9-7.500S7.5 14 11 14c0-5 4-9 9.5-9 4.5 0 8 2.5 9 6.5 1-.5 2-.7 3-.7 4 0 7 3 6.8 6.700C42.5 18 44 20 44 22.500c0 3.5-3 5.5-7 5.5-4 3-9.5 3-13 1-3.5 1.5-8 1-11-1Z"], ["shade", "M44 22.500c0 3.5-3 5.5-7 5.5-4 3-9.5 3-13 1-3.5 1.5-8 1-11-1-3 0-5.5-1-7-2.5 8 1.5 28 1.5 37.7-5 .2.6.3 1.3.3 2Z"], ["line", "M14 14c.5-3 3-5.5 6.5-5.7"]],
  lathe: [["side", "M18 6c0 5 2 5 2 7 0 3-7 4-7 11 0 4.5 5 8.5 11 8.500s11-4 11-8.500c0-7-7-8-7-11 0-2 2-2 2-7Z"], ["shade", "M30 6c0 5-2 5-2 7 0 3 7 4 7 11 0 4.5-5 8.5-11 8.5 4-2 6-5 6-8.5 0-6-5-8-5-11 0-2 2-2 2-5.500Z"], ["top", "M18 6a6 2.5 0 1 0 12 0a6 2.5 0 1 0-12 0Z"], ["line", "M24 1v3"]],
  model: [["side", "M10 11v15l14 7V18Z"], ["shade", "M38 11v15l-14 7V18Z"], ["top", "M24 4L10 11l14 7 14-7Z"], ["line", "M17 7.500l14 7v5"]],
  flat: [["top", "M4 20l18-10 22 7-18 11Z"], ["line", "M13 19.500l10-5M20 21.700l11-6"]],
  none: [["dashed", "M11 18a13 13 0 1 0 26 0a13 13 0 1 0-26 0Z"], ["line", "M24 12.500v11M18.5 18h11"]],
};

export interface KindChoice {
  readonly name: string;
  readonly summary: string;
}

/** Pictures to choose from, one of which may be chosen already. Arrow keys go from one to the next, and choose nothing by that: each choice is a change of the drawing. */
export function kindPictures(label: string, key: string, kinds: readonly KindChoice[], chosen: number | null, otherwise: string, choose: (at: number) => void): HTMLElement {
  const about = h("p", { class: "muted kind-about" });
  const say = (at: number | null): void => fill(about, ...inCode(at === null ? otherwise : kinds[at]!.summary));
  const all = kinds.map(({ name, summary }, at) =>
    h(
      "button",
      {
        class: "kind",
        title: summary.replaceAll("`", ""),
        attributes: { type: "button", role: "radio", "aria-checked": String(at === chosen), tabindex: at === (chosen ?? 0) ? 0 : -1, "data-key": `${key} ${name}` },
        on: { click: () => at !== chosen && choose(at), focus: () => say(at), blur: () => say(chosen), pointerenter: () => say(at), pointerleave: () => say(chosen) },
      },
      picture(name),
      h("span", {}, name),
    ),
  );
  const group = h("div", { class: "kinds", attributes: { role: "radiogroup", "aria-label": label } }, ...all);
  group.addEventListener("keydown", (event) => {
    const at = all.findIndex((one) => one === document.activeElement);
    const next = at < 0 || event.ctrlKey || event.altKey || event.metaKey ? null : goal(event.key, at, kinds);
    if (next === null) return;
    event.preventDefault();
    // The page has keys of its own.
    event.stopPropagation();
    all.forEach((one, index) => (one.tabIndex = index === next ? 0 : -1));
    all[next]!.focus();
  });
  say(chosen);
  return h("div", {}, group, about);
}

/** Where a key goes to; null for keys that go nowhere. */
function goal(key: string, at: number, kinds: readonly KindChoice[]): number | null {
  const count = kinds.length;
  if (key === "ArrowRight" || key === "ArrowDown") return (at + 1) % count;
  if (key === "ArrowLeft" || key === "ArrowUp") return (at + count - 1) % count;
  if (key === "Home") return 0;
  if (key === "End") return count - 1;
  if (!/^[a-z]$/i.test(key)) return null;
  // A letter goes to the next name that begins with it.
  const order = kinds.map((_, step) => (at + 1 + step) % count);
  return order.find((index) => kinds[index]!.name.startsWith(key.toLowerCase())) ?? at;
}

function picture(kind: string): SVGSVGElement | null {
  const pieces = PICTURES[kind];
  if (!pieces) return null;
  const drawn = svg("svg", { viewBox: "0 0 48 36", class: "kind-picture", "aria-hidden": "true" });
  for (const [look, path] of pieces) drawn.append(svg("path", { class: `kind-${look}`, d: path }));
  return drawn;
}
