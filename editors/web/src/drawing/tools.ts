// The tools that draw on the page of the drawing: shown while it is edited.

import { BringToFront, Circle, MousePointer2, Pencil, SendToBack, Square, Trash2, type IconNode } from "lucide";
import { button, fill, h, setHidden } from "../dom";
import type { Editing } from "../editing/editing";
import type { DrawnChange } from "../editing/messages";
import type { PaperPanel } from "../panels/paper";
import type { State } from "../state";
import { isForPage, type Keys } from "../shortcuts";
import { ghost, Mover, Pen, Span, spanned, type Desk } from "./hands";
import { number } from "./freehand";

type Tool = "select" | "draw" | "ellipse" | "rect";

const TOOLS: readonly (readonly [tool: Tool, icon: IconNode, label: string, key: string])[] = [
  ["select", MousePointer2, "Select and move", "Q"],
  ["draw", Pencil, "Draw a shape", "X"],
  ["ellipse", Circle, "Ellipse", "U"],
  ["rect", Square, "Rectangle", "Y"],
];

const COLORS: readonly (readonly [color: string, name: string])[] = [
  ["#e8b48c", "Skin"],
  ["#d1495b", "Red"],
  ["#ef8e3b", "Orange"],
  ["#f2c94c", "Yellow"],
  ["#5fa55a", "Green"],
  ["#3d7ea6", "Blue"],
  ["#7a5c9a", "Violet"],
  ["#5b4336", "Brown"],
];

/** How far an arrow key moves a part, as a share of the page; with Shift less. */
const NUDGE = 1 / 100;
const FINE = 1 / 1000;
/** Presses of arrow keys in quick succession are one change: it is made after so many milliseconds without one. */
const PAUSE = 300;
/** A shape that a key places is so large, as a share of what is seen. */
const PLACED = 0.25;

export class DrawingTools implements Desk {
  private readonly element = h("div", { class: "draw-tools", hidden: true, attributes: { role: "toolbar", "aria-label": "Drawing tools" } });
  private readonly hint = h("p", { class: "draw-hint muted", hidden: true }, "Draw each part as a shape of its own: a body, a head, arms and legs.");
  private readonly buttons = TOOLS.map(([tool, icon, label, key]) => [tool, button({ icon, label, key, press: ({ detail }) => this.press(tool, detail === 0) })] as const);
  private readonly swatches = COLORS.map(([color, name]) => [color, this.swatch(color, name)] as const);
  private readonly other = h("input", { class: "draw-color", title: "Another colour", attributes: { type: "color", "aria-label": "Another colour" }, on: { change: () => this.take(this.other.value) } });
  private readonly ofSelected = [
    button({ icon: BringToFront, label: "To the front", press: () => this.changeSelected((part) => ({ change: "restack", part, to: "front" })) }),
    button({ icon: SendToBack, label: "To the back", press: () => this.changeSelected((part) => ({ change: "restack", part, to: "back" })) }),
    button({ icon: Trash2, label: "Delete", press: () => this.erase() }),
  ];
  /** Whether a drawing is begun here, so that the view shows all of its model as that grows; until somebody turns the view. */
  isBegun = false;
  private tool: Tool = "select";
  private chosen: string = COLORS[1]![0];
  private placed = 0;
  private nudged: { readonly part: string; readonly x: number; readonly y: number; readonly draft: SVGElement; readonly timer: number } | null = null;

  constructor(readonly paper: PaperPanel, readonly state: State, private readonly editing: Editing, keys: Keys) {
    fill(
      this.element,
      h("div", { class: "draw-group" }, ...this.buttons.map(([, one]) => one)),
      h("div", { class: "draw-group" }, ...this.ofSelected),
      h("div", { class: "draw-group", attributes: { role: "group", "aria-label": "Colour" } }, ...this.swatches.map(([, one]) => one), this.other),
    );
    paper.element.prepend(this.element);
    paper.desk.append(this.hint);
    paper.element.addEventListener("keydown", (event) => this.onPaper(event));
    addEventListener("keydown", (event) => this.byLetter(event, keys.letters));
    editing.listen(["mode"], () => this.follow());
    state.on(["selection", "build", "current"], () => this.follow());
    this.choose("select");
    this.follow();
  }

  /** Whether the drawing can be drawn on at the moment. */
  private get isOn(): boolean {
    return this.editing.isOn && !this.paper.element.hidden;
  }

  /** Begins to draw, from wherever. */
  begin(): void {
    if (!this.editing.isOn) this.editing.toggle();
    if (!this.paper.isOn) this.paper.toggle();
    if (!this.isOn) return;
    this.isBegun = true;
    this.choose("draw");
    this.paper.desk.focus();
  }

  /** Gives up what is being drawn or moved; true if something was. */
  giveUp(): boolean {
    if (this.nudged) {
      clearTimeout(this.nudged.timer);
      this.nudged.draft.remove();
      this.nudged = null;
      return true;
    }
    return this.paper.letGo();
  }

  /** Leaves the tool that draws; true if there was one. */
  leave(): boolean {
    if (!this.isOn || this.tool === "select") return false;
    this.choose("select");
    return true;
  }

  color(): string {
    return this.chosen;
  }

  make(change: DrawnChange, draft: SVGElement | null): void {
    const since = this.state.drawing?.build?.revision ?? 0;
    void this.editing.apply(change).then((made) => {
      if (draft) this.paper.settle(draft, made, since);
    });
  }

  private press(tool: Tool, byKey: boolean): void {
    // The key that chose a tool also places a shape: there is no pointer to draw it with.
    if (byKey && tool === this.tool && (tool === "ellipse" || tool === "rect")) this.place(tool);
    else this.choose(tool);
  }

  private choose(tool: Tool): void {
    this.paper.letGo();
    this.tool = tool;
    for (const [own, one] of this.buttons) one.setAttribute("aria-pressed", String(own === tool));
    this.give();
  }

  /** Hands the tool to the paper, while it is edited. */
  private give(): void {
    const { tool } = this;
    const on = this.editing.isOn;
    this.paper.hand = !on ? null : tool === "select" ? new Mover(this) : tool === "draw" ? new Pen(this) : new Span(this, tool);
    const { desk } = this.paper;
    desk.dataset["tool"] = on ? tool : "none";
    if (on) desk.tabIndex = 0;
    else desk.removeAttribute("tabindex");
  }

  private follow(): void {
    const wasHidden = this.element.hidden;
    setHidden(this.element, !this.editing.isOn, this.paper.desk);
    if (wasHidden !== this.element.hidden) {
      this.giveUp();
      if (this.element.hidden) this.tool = "select";
      this.choose(this.tool);
    }
    const { drawing, selected } = this.state;
    this.hint.hidden = !this.editing.isOn || drawing?.build?.parts.length !== 0;
    for (const one of this.ofSelected) one.disabled = selected === null;
    for (const [color, one] of this.swatches) one.setAttribute("aria-pressed", String(color === this.chosen));
    this.other.value = this.chosen;
    this.other.classList.toggle("chosen", this.swatches.every(([color]) => color !== this.chosen));
  }

  private swatch(color: string, name: string): HTMLButtonElement {
    const one = h("button", { class: "draw-swatch", title: name, attributes: { type: "button", "aria-label": name }, on: { click: () => this.take(color) } });
    one.style.setProperty("--swatch", color);
    return one;
  }

  /** What is drawn next has a colour, and so has the selected part while nothing is drawn. */
  private take(color: string): void {
    this.chosen = color;
    this.follow();
    if (this.tool === "select") this.changeSelected((part) => ({ change: "paint", part, fill: color }));
  }

  private changeSelected(change: (part: string) => DrawnChange): void {
    const { selected } = this.state;
    if (selected !== null) this.make(change(selected), null);
  }

  private erase(): void {
    const { selected } = this.state;
    if (selected === null) return;
    // Others may get the number that was its name.
    void this.editing.apply({ change: "erase", part: selected } satisfies DrawnChange).then((made) => {
      if (made && this.state.selected === selected) this.state.select(null);
    });
  }

  /** Places a shape in the middle of what is seen. */
  private place(kind: "ellipse" | "rect"): void {
    const { from, to } = this.paper.seen;
    const half = (PLACED / 2) * Math.min(to.x - from.x, to.y - from.y);
    // One after the other, none hides the one before.
    const shift = (this.placed++ % 5) * (half / 3);
    const [x, y] = [(from.x + to.x) / 2 + shift, (from.y + to.y) / 2 + shift];
    this.make({ change: "draw", shape: spanned(kind, { x: x - half, y: y - half }, { x: x + half, y: y + half }), fill: this.chosen }, null);
  }

  /** The keys of the tools, wherever the focus is. */
  private byLetter(event: KeyboardEvent, hasLetters: boolean): void {
    if (!this.isOn || !hasLetters || event.shiftKey || !isForPage(event)) return;
    const found = TOOLS.find(([, , , key]) => key === event.key.toUpperCase());
    if (!found) return;
    event.preventDefault();
    this.choose(found[0]);
  }

  /** Keys while the focus is on the drawing or its tools. */
  private onPaper(event: KeyboardEvent): void {
    if (!this.isOn || !isForPage(event)) return;
    const { key, shiftKey, target } = event;
    const ways: Readonly<Record<string, readonly [number, number]>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const way = ways[key];
    if (way && this.state.selected !== null) this.nudge(this.state.selected, way, shiftKey ? FINE : NUDGE);
    else if (key === "Delete" || key === "Backspace") this.erase();
    else if (key === "Enter" && target === this.paper.desk && (this.tool === "ellipse" || this.tool === "rect")) this.place(this.tool);
    else return;
    event.preventDefault();
  }

  private nudge(part: string, [right, down]: readonly [number, number], share: number): void {
    const before = this.nudged?.part === part ? this.nudged : null;
    if (this.nudged) clearTimeout(this.nudged.timer);
    if (this.nudged && !before) this.nudgeNow();
    const [, , width, height] = this.paper.page;
    const step = share * Math.max(width, height);
    const [x, y] = [(before?.x ?? 0) + right * step, (before?.y ?? 0) + down * step];
    const draft = before?.draft ?? ghost(this.paper, part);
    draft.setAttribute("transform", `translate(${number(x)} ${number(y)})`);
    this.nudged = { part, x, y, draft, timer: setTimeout(() => this.nudgeNow(), PAUSE) as unknown as number };
  }

  private nudgeNow(): void {
    const { nudged } = this;
    this.nudged = null;
    if (nudged) this.make({ change: "move", part: nudged.part, by: [nudged.x, nudged.y] }, nudged.draft);
  }
}
