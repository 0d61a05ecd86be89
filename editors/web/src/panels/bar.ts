// The header of the page: the drawing, its last build, and the connection.

import { LayoutGrid, WifiOff } from "lucide";
import { count, fill, h, icon } from "../dom";
import type { Size } from "../protocol";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";

/** `0.62 × 1.7 × 0.31 m`, and in its tooltip which is which. */
function sizeOf({ width, height, depth }: Size): HTMLElement {
  const [x, y, z] = [width, height, depth].map((length) => String(Number(length.toPrecision(3))));
  return h("span", { class: "bar-size", title: `${x} m wide, ${y} m high, ${z} m deep` }, `${x} × ${y} × ${z} m`);
}

export class Bar {
  readonly element = h("header", { class: "bar" });
  private readonly back = h("a", { class: "button wide", title: "All drawings (G)", attributes: { href: "#" } }, icon(LayoutGrid), h("span", {}, "Drawings"));
  private readonly title = h("h1", { class: "bar-title" });
  private readonly facts = h("p", { class: "bar-facts muted" });
  private readonly link = h("p", { class: "bar-link", attributes: { role: "status" } });

  constructor(private readonly state: State, private readonly viewer: Viewer) {
    fill(this.element, this.back, this.title, this.facts, this.link);
    state.on(["current", "drawings", "build", "link"], () => this.draw());
    viewer.on(["model"], () => this.draw());
    this.draw();
  }

  private draw(): void {
    const { drawing, list, link, linkNote } = this.state;
    this.back.hidden = drawing === undefined || list.length < 2;
    this.title.textContent = drawing?.name ?? "okoshi";
    const build = drawing?.build;
    fill(
      this.facts,
      ...(build
        ? [
            h("span", {}, count(this.state.parts.main, "part")),
            h("span", {}, count(this.viewer.model?.triangles ?? build.triangles, "triangle")),
            ...(build.size ? [sizeOf(build.size)] : []),
            h("span", { class: "bar-time", title: `Build ${build.revision}`, attributes: { "data-build": build.revision } }, `built in ${Math.round(build.milliseconds)} ms`),
          ]
        : []),
    );
    this.element.dataset["link"] = link;
    this.link.hidden = link === "open" && linkNote === "";
    fill(this.link, link === "lost" && icon(WifiOff), h("span", {}, linkNote || (link === "lost" ? "Connection lost, trying again…" : "Connecting…")));
  }
}
