// The slider between the drawn look and true 3D, for models with view-dependent terrain.

import { Map } from "lucide";
import { button, fill, h, setHidden } from "../dom";
import type { Viewer } from "../viewport/viewer";

export class BendBar {
  readonly element = h("section", { class: "bendbar", hidden: true, attributes: { "aria-label": "Drawn look" } });
  private readonly slider = h("input", {
    class: "bend-slider",
    title: "How much of the drawn look terrain keeps (B)",
    attributes: { type: "range", min: 0, max: 1, step: 0.01, "aria-label": "From true 3D to the drawn look", "aria-keyshortcuts": "B" },
  });

  constructor(private readonly viewer: Viewer) {
    fill(
      this.element,
      h("span", { class: "bend-end", attributes: { "aria-hidden": "true" } }, "True 3D"),
      this.slider,
      h("span", { class: "bend-end", attributes: { "aria-hidden": "true" } }, "Drawn look"),
      button({ icon: Map, label: "Drawn view", key: "4", wide: true, press: () => viewer.lookAsDrawn() }),
    );
    this.slider.addEventListener("input", () => viewer.setBent(Number(this.slider.value)));
    viewer.on(["model", "display"], () => this.follow());
    this.follow();
  }

  private follow(): void {
    const { bent } = this.viewer;
    setHidden(this.element, !this.viewer.bends, this.viewer.canvas);
    this.slider.value = String(bent);
    this.slider.setAttribute("aria-valuetext", bent === 1 ? "as drawn" : bent === 0 ? "true 3D" : `${Math.round(bent * 100)} % of the drawn look`);
  }
}
