// What is drawn over the picture: rings around marks, their trails, and the cross for the keyboard.

import { fill, svg } from "../dom";
import type { Mark, Sighting } from "./messages";

/** A place of a mark; null where it was not seen. */
export type Place = readonly [number, number] | null;

export interface Ring {
  readonly mark: Mark;
  readonly at: Sighting;
  /** Whether this is only where the mark may have been. */
  readonly isLost?: boolean;
  /** Whether something else may be the mark. */
  readonly isAmbiguous?: boolean;
}

/** How much larger than the mark a ring is, in pixels of the picture. */
const MARGIN = 3;

export class Overlay {
  readonly element = svg("svg", { class: "camera-overlay", "aria-hidden": "true", preserveAspectRatio: "none" });
  private readonly trails = svg("g", {});
  private readonly rings = svg("g", {});
  private readonly cross = svg("path", { class: "camera-cross", visibility: "hidden" });

  constructor() {
    this.element.append(this.trails, this.rings, this.cross);
  }

  /** The size of the picture, in pixels. Places are middles of pixels. */
  resize(width: number, height: number): void {
    this.element.setAttribute("viewBox", `-0.5 -0.5 ${width} ${height}`);
  }

  showRings(rings: readonly Ring[]): void {
    fill(
      this.rings,
      ...rings.flatMap(({ mark, at, isLost, isAmbiguous }) => {
        const ring = { cx: at.x, cy: at.y, r: at.radius + MARGIN };
        return [svg("circle", { ...ring, class: "camera-ring-edge" }), svg("circle", { ...ring, class: `camera-ring${isLost ? " lost" : ""}${isAmbiguous ? " ambiguous" : ""}`, stroke: mark.color, "data-mark": mark.name })];
      }),
    );
  }

  showTrails(trails: readonly { readonly mark: Mark; readonly places: readonly Place[] }[]): void {
    fill(this.trails, ...trails.map(({ mark, places }) => svg("path", { d: trailPath(places), class: "camera-trail", stroke: mark.color })));
  }

  showCross(at: { readonly x: number; readonly y: number } | null): void {
    this.cross.setAttribute("visibility", at ? "visible" : "hidden");
    if (at) this.cross.setAttribute("d", `M${at.x - 9} ${at.y}h6m6 0h6M${at.x} ${at.y - 9}v6m0 6v6`);
  }
}

/** A line through places, with gaps where the mark was not seen. */
export function trailPath(places: readonly Place[]): string {
  let path = "";
  let isDrawn = false;
  for (const place of places) {
    if (place) path += `${isDrawn ? "L" : "M"}${place[0].toFixed(1)} ${place[1].toFixed(1)}`;
    isDrawn = place !== null;
  }
  return path;
}
