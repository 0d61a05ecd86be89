// A button that opens a menu; both are returned.

import type { IconNode } from "lucide";
import { button, h } from "../dom";

export interface Choice {
  readonly label: string;
  /** What it is for, below the label. */
  readonly note?: string;
  readonly key?: string;
  /** Whether it can be chosen at the moment; without it, always. */
  readonly isPossible?: () => boolean;
  readonly press: () => void;
}

/** An item of a menu, which closes before the choice is made. */
export function menuItem({ label, note, key, press }: Choice, close: () => void): HTMLButtonElement {
  const click = (): void => {
    close();
    press();
  };
  return h("button", { class: "menu-item", attributes: { type: "button", role: "menuitem", tabindex: -1 }, on: { click } }, h("span", {}, label, note !== undefined && h("span", { class: "menu-note" }, note)), key !== undefined && h("kbd", {}, key));
}

/** Moves the focus among the items of a menu; false for keys that do not. */
export function moveFocus(items: readonly HTMLElement[], key: string): boolean {
  const at = items.findIndex((item) => item === document.activeElement);
  const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[key];
  if (to !== undefined) items.at(to % items.length)?.focus();
  return to !== undefined;
}

export function menu({ icon, label }: { readonly icon: IconNode; readonly label: string }, choices: readonly Choice[]): [HTMLElement, HTMLButtonElement] {
  const items = choices.map((choice) => menuItem(choice, () => set(false, true)));
  const list = h("div", { class: "menu", hidden: true, attributes: { role: "menu", "aria-label": label } }, ...items);
  const opener = button({ icon, label, press: () => set(list.hidden !== false, false) });
  opener.setAttribute("aria-haspopup", "menu");
  const element = h("div", { class: "menu-place" }, opener, list);
  const shown = (): readonly HTMLElement[] => items.filter(({ hidden }) => !hidden);
  const set = (open: boolean, back: boolean): void => {
    list.hidden = !open;
    if (open) choices.forEach(({ isPossible }, at) => (items[at]!.hidden = isPossible?.() === false));
    opener.setAttribute("aria-expanded", String(open));
    if (open) shown()[0]?.focus();
    else if (back) opener.focus();
  };
  set(false, false);
  element.addEventListener("focusout", ({ relatedTarget }) => {
    if (!(relatedTarget instanceof Node && element.contains(relatedTarget))) set(false, false);
  });
  list.addEventListener("keydown", (event) => {
    if (event.key === "Escape") set(false, true);
    else if (!moveFocus(shown(), event.key)) return;
    event.preventDefault();
    event.stopPropagation();
  });
  return [element, opener];
}
