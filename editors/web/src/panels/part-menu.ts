// The menu of a part, by a right click or a long press on it, in the model or in the list, or with the menu key.

import type { Commands } from "../commands";
import { fill, h } from "../dom";
import type { Editing } from "../editing/editing";
import { isAside } from "../parts";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";
import { menuItem, moveFocus, type Choice } from "./menu";

/** A press that moves less than this, in pixels, is a click or a long press. */
const STILL = 6;
/** How long a finger rests on a part, in milliseconds. */
const REST = 550;

/** What the menu leads to in the form of the part. */
export interface Leads {
  rename(): void;
  hang(): void;
  /** Goes to a field of the form. */
  field(attribute: string): void;
}

export class PartMenu {
  private readonly title = h("div", { class: "menu-title", attributes: { "aria-hidden": "true" } });
  private readonly list = h("div", { attributes: { role: "menu" } });
  readonly element = h("div", { class: "menu part-menu", hidden: true }, this.title, this.list);
  private press: { readonly x: number; readonly y: number; readonly id: number; readonly touch: boolean } | null = null;
  private rest: ReturnType<typeof setTimeout> | undefined;
  private before: Element | null = null;
  /** Whether a finger has opened it, and is still there. */
  private byTouch = false;

  constructor(
    private readonly state: State,
    private readonly viewer: Viewer,
    private readonly commands: Commands,
    private readonly editing: Editing,
    private readonly leads: Leads,
    tree: HTMLElement,
  ) {
    const { canvas } = viewer;
    canvas.parentElement!.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    addEventListener("pointermove", (event) => {
      if (this.press && event.pointerId === this.press.id && Math.hypot(event.clientX - this.press.x, event.clientY - this.press.y) >= STILL) this.forget();
    });
    addEventListener("pointerup", (event) => {
      const { press } = this;
      if (!press || event.pointerId !== press.id) return;
      this.forget();
      if (!press.touch) this.openAt(press.x, press.y);
    });
    addEventListener("pointercancel", () => this.forget());
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // The mouse events that follow a touch would take the focus, and so close the menu.
    canvas.addEventListener("touchend", (event) => {
      if (this.byTouch) event.preventDefault();
      this.byTouch = false;
    }, { passive: false });
    tree.addEventListener("contextmenu", (event) => {
      const row = rowOf(event.target);
      // Where rows are dragged with a finger, a long press begins that.
      const isTouch = event instanceof PointerEvent && event.pointerType === "touch";
      if (event.defaultPrevented || !row || editing.isPicking || (editing.isOn && isTouch)) return;
      event.preventDefault();
      this.open(row.dataset["part"]!, event.clientX, event.clientY);
    });
    for (const place of [canvas, tree]) {
      place.addEventListener("keydown", (event) => {
        if (event.key !== "ContextMenu" && !(event.key === "F10" && event.shiftKey)) return;
        event.preventDefault();
        const row = rowOf(event.target);
        const { left, top, width, height } = (row ?? canvas).getBoundingClientRect();
        const name = row?.dataset["part"] ?? state.selected;
        if (name !== null && !editing.isPicking) this.open(name, left + (row ? 24 : width / 2), top + (row ? height : height / 2));
      });
    }
    addEventListener("pointerdown", ({ target }) => {
      if (!(target instanceof Node && this.element.contains(target))) this.close(false);
    }, { capture: true });
    addEventListener("blur", () => this.close(false));
    addEventListener("resize", () => this.close(false));
    this.element.addEventListener("focusout", ({ relatedTarget }) => {
      if (!(relatedTarget instanceof Node && this.element.contains(relatedTarget))) this.close(false);
    });
    this.element.addEventListener("keydown", (event) => this.key(event));
    this.element.addEventListener("contextmenu", (event) => event.preventDefault());
    state.on(["current"], () => this.close(false));
  }

  private down(event: PointerEvent): void {
    const isSecond = this.press !== null;
    this.forget();
    const touch = event.pointerType === "touch";
    if (isSecond || event.target !== this.viewer.canvas || event.button !== (touch ? 0 : 2) || this.commands.isPosing || this.editing.isPicking) return;
    this.press = { x: event.clientX, y: event.clientY, id: event.pointerId, touch };
    if (!touch) return;
    this.rest = setTimeout(() => {
      this.forget();
      this.openAt(event.clientX, event.clientY);
      this.byTouch = !this.element.hidden;
    }, REST);
  }

  private forget(): void {
    clearTimeout(this.rest);
    this.press = null;
  }

  /** The menu of the part at a point of the model. */
  private openAt(x: number, y: number): void {
    const part = this.commands.pointer?.partAt(x, y);
    if (part) this.open(part, x, y);
  }

  private open(name: string, x: number, y: number): void {
    this.state.select(name);
    const part = this.state.parts.get(name);
    const items = part && !isAside(part) ? this.items(name, part.kind === "main") : [];
    if (items.length === 0) return;
    this.before = document.activeElement;
    this.title.textContent = name;
    this.list.setAttribute("aria-label", name);
    fill(this.list, ...items.map((item) => menuItem(item, () => this.close(true))));
    this.element.hidden = false;
    const { offsetWidth: width, offsetHeight: height } = this.element;
    this.element.style.left = `${Math.max(Math.min(x, innerWidth - width - 6), 6)}px`;
    this.element.style.top = `${Math.max(Math.min(y, innerHeight - height - 6), 6)}px`;
    (this.list.firstElementChild as HTMLElement).focus({ preventScroll: true });
  }

  private items(name: string, isNode: boolean): Choice[] {
    const { commands, editing, leads } = this;
    // What changes the drawing turns editing on: whoever chooses it from a menu means it.
    const change = (label: string, go: () => void, key?: string): Choice => ({
      label,
      ...(key === undefined ? {} : { key }),
      press: () => {
        if (!editing.isOn) editing.toggle();
        go();
      },
    });
    const changes = editing.isPossible ? [...(isNode ? [change("Rename…", () => leads.rename(), "F2"), change("Hang on another part…", () => leads.hang())] : []), change("Colour…", () => leads.field("Color")), change("Shape…", () => leads.field("Shape"))] : [];
    return [
      ...changes,
      { label: "Frame", key: "F", press: () => this.viewer.frameSelected() },
      { label: this.state.isHidden(name) ? "Show" : "Hide", key: "H", press: () => commands.hide() },
      { label: "Show only this part", key: "Shift+H", press: () => commands.isolate() },
      ...(this.state.hidden.size > 0 ? [{ label: "Show all", key: "A", press: () => commands.showAll() }] : []),
    ];
  }

  private key(event: KeyboardEvent): void {
    const items = [...this.list.querySelectorAll<HTMLElement>("[role=menuitem]")];
    // Enter and the space bar press the item; the page's own keys wait.
    if (event.key === "Enter" || event.key === " ") return;
    event.stopPropagation();
    if (event.key === "Escape" || event.key === "Tab") this.close(true);
    else if (!moveFocus(items, event.key)) return;
    event.preventDefault();
  }

  private close(back: boolean): void {
    if (this.element.hidden) return;
    const { before } = this;
    const had = this.element.contains(document.activeElement);
    this.element.hidden = true;
    if ((back || had) && before instanceof HTMLElement && before.isConnected && before !== document.body) before.focus({ preventScroll: true });
    else if (had) this.viewer.canvas.focus({ preventScroll: true });
  }
}

const rowOf = (target: EventTarget | null): HTMLElement | null => (target instanceof Element ? target.closest<HTMLElement>("[data-part]") : null);
