// Dragging a part onto another one in the list, which it then hangs on. Keys do the same by the form's "Hangs on".

import { h } from "../dom";
import type { State } from "../state";
import type { Editing } from "./editing";

/** A press that moves less than this, in pixels, is a click. */
const STILL = 5;
/** A finger that rests so long on a row drags it, in milliseconds; one that moves before scrolls the list. */
const REST = 350;
/** So near to an edge of the list, in pixels, it scrolls. */
const EDGE = 28;

/** What a part would hang on; null for nothing. */
interface Goal {
  readonly parent: string | null;
  /** The row, or the list where it is empty. */
  readonly place: Element;
}

export class HangingByDrag {
  private press: { readonly part: string; readonly x: number; readonly y: number; readonly id: number } | null = null;
  private drags = false;
  private goal: Goal | null = null;
  private rest: ReturnType<typeof setTimeout> | undefined;
  private scrolling = 0;
  private readonly label = h("div", { class: "hanging", hidden: true, attributes: { "aria-hidden": "true" } });

  /** `list` has the rows, each with the name of its part. */
  constructor(private readonly list: HTMLElement, private readonly editing: Editing, private readonly state: State) {
    document.body.append(this.label);
    list.addEventListener("pointerdown", (event) => this.down(event));
    addEventListener("pointermove", (event) => this.move(event));
    addEventListener("pointerup", (event) => this.up(event));
    addEventListener("pointercancel", () => this.stop());
    // The click at the end of a drag selects nothing.
    list.addEventListener("click", (event) => this.drags && event.stopImmediatePropagation(), { capture: true });
    list.addEventListener("touchmove", (event) => this.drags && event.preventDefault(), { passive: false });
    list.addEventListener("contextmenu", (event) => (this.drags || this.rest !== undefined) && event.preventDefault());
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.drags) return;
      event.preventDefault();
      event.stopPropagation();
      this.stop();
    }, { capture: true });
    editing.listen(["mode"], () => this.stop());
    // A part that is gone cannot be dragged on.
    state.on(["build", "current"], () => this.press && !state.parts.get(this.press.part) && this.stop());
  }

  private down(event: PointerEvent): void {
    this.stop();
    const row = rowAt(event.target);
    const part = this.state.parts.get(row?.dataset["part"] ?? null);
    const isButton = event.target instanceof Element && event.target.closest("[data-eye], [data-fold]") !== null;
    if (!this.editing.isOn || this.editing.isPicking || part?.kind !== "main" || isButton || event.button !== 0) return;
    this.press = { part: part.name, x: event.clientX, y: event.clientY, id: event.pointerId };
    if (event.pointerType !== "touch") return;
    this.rest = setTimeout(() => {
      this.rest = undefined;
      this.begin();
    }, REST);
  }

  private move(event: PointerEvent): void {
    const { press } = this;
    if (!press || event.pointerId !== press.id) return;
    if (!this.drags) {
      if (Math.hypot(event.clientX - press.x, event.clientY - press.y) < STILL) return;
      if (event.pointerType === "touch") return this.stop();
      this.begin();
    }
    this.follow(event.clientX, event.clientY);
  }

  private begin(): void {
    const { press } = this;
    if (!press) return;
    this.drags = true;
    document.body.classList.add("hangs");
    this.follow(press.x, press.y);
  }

  private follow(x: number, y: number): void {
    this.aim(x, y);
    const { top, bottom } = this.list.getBoundingClientRect();
    const by = y < top + EDGE ? -6 : y > bottom - EDGE ? 6 : 0;
    cancelAnimationFrame(this.scrolling);
    if (by === 0 || y < top - EDGE || y > bottom + EDGE) return;
    const before = this.list.scrollTop;
    this.list.scrollTop += by;
    if (this.list.scrollTop !== before) this.scrolling = requestAnimationFrame(() => this.drags && this.follow(x, y));
  }

  /** Shows what the part would hang on if it were let go at a point. */
  private aim(x: number, y: number): void {
    const { press, label } = this;
    if (!press) return;
    const under = document.elementFromPoint(x, y);
    const row = rowAt(under);
    const onto = row && this.state.parts.carrier(row.dataset["part"]!);
    const inList = under !== null && this.list.contains(under);
    const goal = onto ? { parent: onto.name, place: row } : inList && !row && !under.closest(".tree-break") ? { parent: null, place: this.list } : null;
    const isNew = goal !== null && goal.parent !== press.part && goal.parent !== (this.state.parts.get(press.part)?.parent ?? null);
    this.mark(isNew ? goal : null);
    label.hidden = false;
    label.textContent = this.goal ? `Hang ${press.part} on ${this.goal.parent ?? "nothing"}` : press.part;
    const { offsetWidth: width, offsetHeight: height } = label;
    label.style.transform = `translate(${Math.min(x + 12, innerWidth - width - 4)}px, ${Math.min(y + 14, innerHeight - height - 4)}px)`;
  }

  private mark(goal: Goal | null): void {
    this.goal?.place.classList.remove("takes");
    this.goal = goal;
    goal?.place.classList.add("takes");
  }

  private up(event: PointerEvent): void {
    const { press, goal, drags } = this;
    if (!press || event.pointerId !== press.id) return;
    if (drags && goal) void this.editing.apply({ change: "hang", part: press.part, parent: goal.parent });
    // The click comes after this.
    setTimeout(() => this.press === press && this.stop());
    this.label.hidden = true;
  }

  private stop(): void {
    clearTimeout(this.rest);
    cancelAnimationFrame(this.scrolling);
    this.rest = undefined;
    this.press = null;
    this.drags = false;
    this.label.hidden = true;
    document.body.classList.remove("hangs");
    this.mark(null);
  }
}

const rowAt = (target: EventTarget | null): HTMLElement | null => (target instanceof Element ? target.closest<HTMLElement>(".tree-item[data-part]") : null);
