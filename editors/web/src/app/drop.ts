// Files that are dropped anywhere on the page.

import { h } from "../dom";
import { dropped, type Opened } from "./access";

export function listenToDrops(take: (opened: readonly Opened[]) => void, failed: (error: unknown) => void): HTMLElement {
  const element = h("div", { class: "drop", hidden: true, attributes: { "aria-hidden": "true" } }, h("p", {}, "Drop drawings, and what they link to"));
  const hasFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") === true;
  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    element.hidden = false;
  });
  addEventListener("dragleave", ({ relatedTarget }) => {
    // Between two elements of the page there is one; there is none where the page ends.
    if (relatedTarget === null) element.hidden = true;
  });
  addEventListener("drop", (event) => {
    element.hidden = true;
    if (!hasFiles(event) || !event.dataTransfer) return;
    event.preventDefault();
    dropped(event.dataTransfer).then(take, failed);
  });
  return element;
}
