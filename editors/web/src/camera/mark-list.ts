// The list of the marks that are tracked: colour, name, whether each is seen.

import { X } from "lucide";
import { button, fill, h } from "../dom";
import type { Mark } from "./messages";

export class MarkList {
  readonly element = h("ul", { class: "camera-marks", attributes: { "aria-label": "Marks" } });
  private readonly offered = h("datalist", { attributes: { id: "camera-mark-names" } });
  private rows: { readonly item: HTMLElement; readonly state: HTMLElement; readonly remove: HTMLButtonElement }[] = [];
  private marks: readonly Mark[] = [];

  constructor(private readonly rename: (mark: number, name: string) => void, private readonly remove: (mark: number) => void) {}

  /** Shows these marks; `names` are those of the drawing's `Mark`s. */
  show(marks: readonly Mark[], names: readonly string[]): void {
    this.marks = marks;
    fill(this.offered, ...names.map((value) => h("option", { attributes: { value } })));
    this.rows = marks.map(({ name, color }, mark) => {
      const swatch = h("span", { class: "camera-swatch", title: color });
      swatch.style.background = color;
      const field = h("input", { class: "camera-name", attributes: { type: "text", list: "camera-mark-names", value: name, maxlength: 64, spellcheck: "false", autocomplete: "off", "aria-label": `Name of the mark ${name}` } });
      field.addEventListener("change", () => this.rename(mark, field.value.trim()));
      const state = h("span", { class: "muted camera-state" });
      const remove = button({ icon: X, label: `Remove the mark ${name}`, press: () => this.remove(mark) });
      return { item: h("li", {}, swatch, field, state, remove), state, remove };
    });
    fill(this.element, ...this.rows.map(({ item }) => item), this.offered);
  }

  /** Puts the names back as they are: a new one was refused. */
  restore(): void {
    this.marks.forEach(({ name }, mark) => {
      const field = this.rows[mark]?.item.querySelector("input");
      if (field) field.value = name;
    });
  }

  /** Says something about each mark, such as that it is lost. */
  tell(states: readonly string[]): void {
    this.rows.forEach(({ state }, mark) => {
      const told = states[mark] ?? "";
      if (state.textContent !== told) state.textContent = told;
    });
  }

  /** Marks can be removed before they are recorded. */
  allowRemoving(isAllowed: boolean): void {
    for (const { remove } of this.rows) remove.hidden = !isAllowed;
  }
}
