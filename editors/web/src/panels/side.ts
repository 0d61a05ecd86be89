// The side panel with the hierarchy and the inspector. In a small window it is a drawer over the viewport, which shows one of the two, and
// which a button in the corner opens.

import { ChevronUp, X } from "lucide";
import { button, fill, h, icon } from "../dom";
import { SMALL } from "../layout";
import type { State } from "../state";
import type { Inspector } from "./inspector";
import type { Tree } from "./tree";

type Tab = "parts" | "part";

export class Side {
  readonly element = h("aside", { class: "side", attributes: { "aria-label": "Parts", id: "side" } });
  /** Opens the drawer. */
  readonly opener: HTMLButtonElement;
  private readonly words = h("span", { class: "drawer-words" });
  private readonly tabs: Readonly<Record<Tab, HTMLButtonElement>>;
  private open = false;

  constructor(state: State, private readonly tree: Tree, inspector: Inspector) {
    this.opener = h("button", { class: "drawer-opener", attributes: { type: "button", "aria-expanded": "false", "aria-controls": "side" }, on: { click: () => this.show(state.selected === null ? "parts" : "part") } }, this.words, icon(ChevronUp));
    const tab = (name: Tab, words: string): HTMLButtonElement => h("button", { class: "button drawer-tab", attributes: { type: "button" }, on: { click: () => this.choose(name) } }, words);
    this.tabs = { parts: tab("parts", "Parts"), part: tab("part", "Selected part") };
    const close = button({ icon: X, label: "Close the parts", press: () => this.close() });
    const head = h("div", { class: "drawer-head" }, h("div", { class: "drawer-tabs", attributes: { role: "group", "aria-label": "Shown" } }, this.tabs.parts, this.tabs.part), close);
    fill(this.element, head, tree.element, inspector.element);
    this.element.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || event.defaultPrevented || !this.open || !SMALL.matches) return;
      event.preventDefault();
      event.stopPropagation();
      this.close();
    });
    const draw = (): void => {
      this.words.textContent = state.selected ?? "Parts";
      this.tabs.part.textContent = state.selected ?? "No part selected";
      this.tabs.part.disabled = state.selected === null;
      if (state.selected === null) this.choose("parts");
    };
    state.on(["selection", "current"], draw);
    draw();
    this.set(false);
  }

  /** Goes to the list of parts. */
  focusTree(): void {
    this.show("parts");
    this.tree.focus();
  }

  /** Goes to the field that searches the parts. */
  focusSearch(): void {
    this.show("parts");
    this.tree.focusSearch();
  }

  /** Shows the selected part, where there is room for it or the list. */
  showPart(): void {
    if (SMALL.matches) this.show("part");
  }

  private show(tab: Tab): void {
    const wasOpen = this.open;
    this.choose(tab);
    this.set(true);
    if (SMALL.matches && !wasOpen) this.tabs[tab].focus();
  }

  private close(): void {
    this.set(false);
    this.opener.focus();
  }

  private choose(tab: Tab): void {
    this.element.dataset["tab"] = tab;
    for (const [name, button] of Object.entries(this.tabs)) button.setAttribute("aria-pressed", String(name === tab));
  }

  private set(open: boolean): void {
    this.open = open;
    this.element.dataset["open"] = String(open);
    this.opener.setAttribute("aria-expanded", String(open));
  }
}
