// The line for drawings in which nothing has a name: it says how to begin, and offers to name the parts.

import { h } from "../dom";
import { isAutomatic, type Parts } from "../parts";
import type { Editing } from "./editing";

/** Whether there are parts, and none has a name that a person gave it. */
export function isNameless(parts: Parts): boolean {
  const nodes = parts.all.filter((part) => part.kind === "main");
  return nodes.length > 1 && nodes.every(isAutomatic);
}

/** What is shown while nothing has a name. */
export function namelessLine(editing: Editing): HTMLElement {
  const name = h("button", { class: "button choice", attributes: { type: "button" }, on: { click: () => void editing.apply({ change: "name-parts" }) } }, "Name the parts for me");
  return h("div", { class: "offer", hidden: true }, h("p", {}, "Nothing here has a name. Click a part and name it, or let okoshi do it."), h("div", { class: "choices" }, name));
}
