// The side panel with the hierarchy and the inspector. In a small window it is a drawer over the viewport, which shows one of the two, and
// which a button in the corner opens.

import { ChevronUp, X } from "lucide";
import { button, fill, h, icon } from "../dom";
import { SMALL } from "../layout";
import type { State } from "../state";
import type { Inspector } from "./inspector";
import type { Tree } from "./tree";

type Tab = "parts" | "part" | "more";

export class Side {
  readonly element = h("aside", { class: "side", attributes: { "aria-label": "Parts", id: "side" } });
  /** Opens the drawer. */
  readonly opener: HTMLButtonElement;
  private readonly words = h("span", { class: "drawer-words" });
  private readonly tabs: Partial<Record<Tab, HTMLButtonElement>>;
  private readonly tabRow: HTMLElement;
  /** What the host's own entry has added, in place of the list where there is room for it beside the selected part. */
  private added: { readonly opener: HTMLButtonElement; readonly shown: (isShown: boolean) => void } | null = null;
  private open = false;

  constructor(state: State, private readonly tree: Tree, inspector: Inspector) {
    this.opener = h("button", { class: "drawer-opener", attributes: { type: "button", "aria-expanded": "false", "aria-controls": "side" }, on: { click: () => this.show(state.selected === null ? "parts" : "part") } }, this.words, icon(ChevronUp));
    const [parts, part] = [this.tab("parts", "Parts"), this.tab("part", "Selected part")];
    this.tabs = { parts, part };
    this.tabRow = h("div", { class: "drawer-tabs", attributes: { role: "group", "aria-label": "Shown" } }, parts, part);
    const close = button({ icon: X, label: "Close the parts", press: () => this.close() });
    const head = h("div", { class: "drawer-head" }, this.tabRow, close);
    fill(this.element, head, tree.element, inspector.element);
    this.element.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || event.defaultPrevented || !this.open || !SMALL.matches) return;
      event.preventDefault();
      event.stopPropagation();
      this.close();
    });
    const draw = (): void => {
      this.words.textContent = state.selected ?? "Parts";
      part.textContent = state.selected ?? "No part selected";
      part.disabled = state.selected === null;
      if (state.selected === null && this.element.dataset["tab"] === "part") this.choose("parts");
    };
    state.on(["selection", "current"], draw);
    draw();
    this.choose("parts");
    this.set(false);
  }

  private tab(name: Tab, words: string): HTMLButtonElement {
    return h("button", { class: "button drawer-tab", attributes: { type: "button" }, on: { click: () => this.choose(name) } }, words);
  }

  /** Adds something that is shown in place of the list of parts; a button of the toolbar opens it, in a small window a tab. `shown` is told whether it is. */
  add(words: string, element: HTMLElement, opener: HTMLButtonElement, shown: (isShown: boolean) => void): void {
    element.classList.add("side-added");
    this.added = { opener, shown };
    this.tabs.more = this.tab("more", words);
    this.tabRow.append(this.tabs.more);
    this.element.insertBefore(element, this.tree.element);
    opener.addEventListener("click", () => this.choose(this.element.dataset["tab"] === "more" ? "parts" : "more"));
    SMALL.addEventListener("change", () => this.tell());
    this.choose("parts");
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
    if (SMALL.matches && !(this.open && this.element.dataset["tab"] === "more")) this.show("part");
  }

  private show(tab: Tab): void {
    const wasOpen = this.open;
    this.choose(tab);
    this.set(true);
    if (SMALL.matches && !wasOpen) this.tabs[tab]?.focus();
  }

  private close(): void {
    this.set(false);
    this.opener.focus();
  }

  private choose(tab: Tab): void {
    this.element.dataset["tab"] = tab;
    for (const [name, button] of Object.entries(this.tabs)) button.setAttribute("aria-pressed", String(name === tab));
    this.added?.opener.setAttribute("aria-pressed", String(tab === "more"));
    this.tell();
  }

  private tell(): void {
    this.added?.shown(this.element.dataset["tab"] === "more" && (this.open || !SMALL.matches));
  }

  private set(open: boolean): void {
    this.open = open;
    this.element.dataset["open"] = String(open);
    this.opener.setAttribute("aria-expanded", String(open));
    this.tell();
  }
}
