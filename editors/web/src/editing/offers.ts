// What is offered below the model of a drawing that does not move yet: names for its parts where nothing has one, then a motion.

import { X } from "lucide";
import type { Commands } from "../commands";
import { button, fill, h, setHidden } from "../dom";
import { isAutomatic, type Parts } from "../parts";
import type { State } from "../state";
import type { Editing } from "./editing";

/** Whether there are parts, and none has a name that a person gave it. */
export function isNameless(parts: Parts): boolean {
  const nodes = parts.all.filter((part) => part.kind === "main");
  return nodes.length > 1 && nodes.every(isAutomatic);
}

/** The part that carries most of the others; null if none carries any. */
function carrier(parts: Parts): string | null {
  const roots = parts.children(null).map(({ name }) => ({ name, size: parts.family(name).size }));
  const largest = roots.reduce((a, b) => (b.size > a.size ? b : a), { name: "", size: 1 });
  return largest.size > 1 ? largest.name : null;
}

type Offer = "names" | "motion";

export class Offers {
  readonly element = h("section", { class: "offer", hidden: true, attributes: { "aria-label": "What to do next" } });
  /** The drawing whose parts okoshi named, and those whose offers were turned down. */
  private named: string | null = null;
  private readonly declined = new Set<string | null>();

  /** The focus goes `elsewhere` if it is on an offer that ends. */
  constructor(private readonly editing: Editing, private readonly state: State, private readonly commands: Commands, private readonly elsewhere: HTMLElement) {
    editing.listen(["mode", "done", "picking"], () => this.draw());
    commands.onMode(() => this.draw());
    state.on(["selection", "build", "current"], () => this.draw());
    this.draw();
  }

  private draw(): void {
    const { isOn } = this.editing;
    const next = isOn || !this.commands.isPosing ? this.next() : null;
    const key = next === null ? "" : `${next} ${isOn}`;
    if (this.element.dataset["offer"] === key) return;
    this.element.dataset["offer"] = key;
    const hasFocus = this.element.contains(document.activeElement);
    setHidden(this.element, next === null, this.elsewhere);
    if (next === null) return fill(this.element);
    const close = button({ icon: X, label: "Close the offer", press: () => this.decline() });
    const [words, ...choices] = next === "motion" ? this.motion() : this.names(isOn);
    fill(this.element, words, h("div", { class: "choices" }, ...choices), close);
    if (hasFocus) choices[0]!.focus();
  }

  private next(): Offer | null {
    const { editing, state } = this;
    if (!editing.isPossible || editing.isPicking || editing.refusal !== null || this.declined.has(state.current)) return null;
    if (isNameless(state.parts)) return "names";
    const isStill = state.drawing?.build?.clips.length === 0 && carrier(state.parts) !== null;
    return editing.isOn && this.named === state.current && isStill ? "motion" : null;
  }

  private names(isOn: boolean): [HTMLElement, ...HTMLElement[]] {
    const words = isOn ? "Nothing here has a name. Click a part and name it, or let okoshi do it." : "Nothing here has a name yet. Parts with names can move.";
    const byHand = choice("Name them myself", () => this.editing.toggle());
    return [h("p", {}, words), choice("Name the parts for me", () => void this.nameAll()), ...(isOn ? [] : [byHand])];
  }

  private motion(): [HTMLElement, ...HTMLElement[]] {
    return [h("p", {}, "The parts have names. Correct them in the list, or go on."), choice("Let it move", () => void this.move())];
  }

  private async nameAll(): Promise<void> {
    const { editing, state } = this;
    if (!editing.isOn) editing.toggle();
    const { current } = state;
    if (await editing.apply({ change: "name-parts" })) this.named = current;
    this.draw();
  }

  /** The clip that fits the figure. */
  private async move(): Promise<void> {
    const part = carrier(this.state.parts);
    if (part !== null) await this.editing.apply({ change: "clip", part, clip: 0, motion: "", limited: null, held: null });
  }

  private decline(): void {
    this.declined.add(this.state.current);
    this.draw();
  }
}

function choice(words: string, press: () => void): HTMLElement {
  return h("button", { class: "button choice", attributes: { type: "button" }, on: { click: press } }, words);
}
