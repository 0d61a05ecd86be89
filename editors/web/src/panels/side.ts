// The side panel with the hierarchy and the inspector: beside the viewport, or on a narrow page a sheet below it.

import { ChevronUp } from "lucide";
import { fill, h, icon } from "../dom";
import type { State } from "../state";
import type { Inspector } from "./inspector";
import type { Tree } from "./tree";

export class Side {
  readonly element = h("aside", { class: "side", attributes: { "aria-label": "Parts", "data-open": "true" } });
  private readonly words = h("span", { class: "sheet-words" });

  constructor(state: State, tree: Tree, inspector: Inspector) {
    const toggle = h(
      "button",
      { class: "sheet-head", attributes: { type: "button", "aria-expanded": "true" }, on: { click: () => this.set(toggle, this.element.dataset["open"] !== "true") } },
      this.words,
      icon(ChevronUp),
    );
    fill(this.element, toggle, h("div", { class: "side-body" }, tree.element, inspector.element));
    const draw = (): void => void (this.words.textContent = state.selected ?? "Parts");
    state.on(["selection", "current"], draw);
    draw();
  }

  private set(toggle: HTMLElement, open: boolean): void {
    this.element.dataset["open"] = String(open);
    toggle.setAttribute("aria-expanded", String(open));
  }
}
