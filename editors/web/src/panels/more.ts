// Tools that a narrow bar folds away: in a wide bar they are among the others, in a narrow one a button opens them.

import { Ellipsis } from "lucide";
import { button, h } from "../dom";

/** Adds to a bar `children`, and the button that opens them where the style sheet folds them. */
export function more(label: string, children: readonly (Node | string | null | false)[]): readonly [folded: HTMLElement, opener: HTMLElement] {
  const folded = h("div", { class: "folded" }, ...children);
  const opener = button({ icon: Ellipsis, label, class: "more", press: () => set(folded.dataset["open"] !== "true") });
  const set = (open: boolean): void => {
    folded.dataset["open"] = String(open);
    opener.setAttribute("aria-expanded", String(open));
  };
  set(false);
  const escape = (event: KeyboardEvent): void => {
    if (event.key !== "Escape" || event.defaultPrevented || folded.dataset["open"] !== "true") return;
    set(false);
    opener.focus();
    event.preventDefault();
    event.stopPropagation();
  };
  folded.addEventListener("keydown", escape);
  opener.addEventListener("keydown", escape);
  // A press anywhere else closes it, and so does Tab beyond its end.
  addEventListener("pointerdown", ({ target }) => {
    if (!(target instanceof Node && (folded.contains(target) || opener.contains(target)))) set(false);
  });
  folded.addEventListener("focusout", ({ relatedTarget }) => {
    if (relatedTarget instanceof Node && !folded.contains(relatedTarget) && !opener.contains(relatedTarget)) set(false);
  });
  return [folded, opener];
}
