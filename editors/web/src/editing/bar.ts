// The bar over the model while it is edited: undo, redo, and why something was not done.

import { Redo2, Undo2, X } from "lucide";
import { button, fill, h, inCode, setHidden } from "../dom";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";
import type { Editing } from "./editing";

export class EditBar {
  readonly element = h("section", { class: "editbar", hidden: true, attributes: { "aria-label": "Editing" } });
  private readonly words = h("p", { class: "edit-words", attributes: { role: "status" } });
  private readonly refused = h("div", { class: "refusal", hidden: true, attributes: { role: "alert" } });
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;

  constructor(private readonly editing: Editing, private readonly state: State, private readonly viewer: Viewer) {
    this.undo = button({ icon: Undo2, label: "Undo", press: () => editing.undo() });
    this.redo = button({ icon: Redo2, label: "Redo", press: () => editing.redo() });
    const row = h("div", { class: "edit-row" }, this.words, this.undo, this.redo, button({ icon: X, label: "Stop editing", key: "W", press: () => editing.toggle() }));
    fill(this.element, row, this.refused);
    this.refused.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.preventDefault();
      this.dismiss();
    });
    editing.listen(["mode", "done", "picking"], () => this.draw());
    state.on(["steps", "selection"], () => this.draw());
    this.draw();
  }

  private draw(): void {
    const { editing } = this;
    setHidden(this.element, !editing.isOn, this.viewer.canvas);
    if (!editing.isOn) return void (this.refused.hidden = true);
    label(this.undo, "Undo", editing.undoes, "Ctrl+Z");
    label(this.redo, "Redo", editing.redoes, "Ctrl+Shift+Z");
    const words = this.now();
    if (this.words.textContent !== words) this.words.textContent = words;
    this.drawRefusal();
  }

  private now(): string {
    const { editing, state } = this;
    if (editing.isPicking) return `Click what ${state.selected ?? "it"} hangs on. Esc: give up`;
    if (editing.busy) return editing.words.doing;
    if (editing.refusal) return "Nothing was changed";
    if (editing.said !== "") return editing.said;
    if (state.selected === null) return "Click a part to change it";
    return editing.words.where;
  }

  private drawRefusal(): void {
    const { refusal } = this.editing;
    if (!refusal) return setHidden(this.refused, true, this.viewer.canvas);
    const words = `${refusal.why.charAt(0).toUpperCase()}${refusal.why.slice(1)}.`;
    if (!this.refused.hidden && this.refused.dataset["why"] === words) return;
    this.refused.dataset["why"] = words;
    const choices = refusal.choices.map(({ title, change }) => h("button", { class: "button choice", attributes: { type: "button" }, on: { click: () => void this.editing.choose(change) } }, ...inCode(title)));
    const close = h("button", { class: "button choice", attributes: { type: "button" }, on: { click: () => this.dismiss() } }, choices.length > 0 ? "Leave it" : "Close");
    this.refused.hidden = false;
    fill(this.refused, h("p", {}, ...inCode(words)), h("div", { class: "choices" }, ...choices, close));
    // Whoever works with the keyboard goes on here.
    if (choices.length > 0) choices[0]!.focus();
  }

  private dismiss(): void {
    this.editing.clear();
    this.viewer.canvas.focus();
  }
}

/** Says what a button would do, and whether it can. */
function label(one: HTMLButtonElement, does: string, what: string | null, keys: string): void {
  const words = what === null ? does : `${does}: ${what}`;
  one.setAttribute("aria-label", words);
  one.setAttribute("aria-keyshortcuts", keys.replace("Ctrl", "Control"));
  one.title = `${words} (${keys})`;
  one.disabled = what === null;
}
