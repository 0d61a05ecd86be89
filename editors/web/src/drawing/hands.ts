// What the pointer does on the drawing: it draws a line, spans a box, or moves a part.

import { svg } from "../dom";
import type { DrawnChange, NewShape } from "../editing/messages";
import type { Hand, PaperPanel } from "../panels/paper";
import type { Point } from "../protocol";
import type { State } from "../state";
import { freehand, number } from "./freehand";

/** How far the pointer goes in a click, in pixels. */
const CLICK = 4;
/** What is spanned is at least so large, in pixels: less is a slip of the hand. */
const LEAST = 6;

/** Where a hand works, and what it does there. */
export interface Desk {
  readonly paper: PaperPanel;
  readonly state: State;
  color(): string;
  /** Makes a change; what is shown of it stays until the drawing shows it. */
  make(change: DrawnChange, draft: SVGElement): void;
}

/** Draws the border of a shape. */
export class Pen implements Hand {
  private points: Point[] = [];
  private draft = svg("path", { class: "paper-draft", d: "" });

  constructor(private readonly desk: Desk) {}

  press(at: Point): boolean {
    this.points = [at];
    this.draft = svg("path", { class: "paper-draft", d: "", fill: this.desk.color() });
    this.desk.paper.drafts.append(this.draft);
    return true;
  }

  drag(over: readonly Point[]): void {
    this.points.push(...over);
    this.draft.setAttribute("d", `M${this.points.map(({ x, y }) => `${number(x)} ${number(y)}`).join("L")}Z`);
  }

  release(): boolean {
    const path = freehand(this.points, this.desk.paper.unit);
    if (path === null) this.cancel();
    else {
      this.draft.setAttribute("d", path);
      this.desk.make({ change: "draw", shape: { path }, fill: this.desk.color() }, this.draft);
    }
    return true;
  }

  cancel(): void {
    this.draft.remove();
  }
}

/** Spans an ellipse or a rectangle between two corners. */
export class Span implements Hand {
  private from: Point = { x: 0, y: 0 };
  private to: Point = this.from;
  private draft: SVGElement = svg("path", { d: "" });

  constructor(private readonly desk: Desk, private readonly kind: "ellipse" | "rect") {}

  press(at: Point): boolean {
    this.from = this.to = at;
    this.draft = svg(this.kind, { class: "paper-draft", fill: this.desk.color() });
    this.desk.paper.drafts.append(this.draft);
    return true;
  }

  drag(over: readonly Point[], isEven: boolean): void {
    const at = over.at(-1) ?? this.to;
    const [width, height] = [at.x - this.from.x, at.y - this.from.y];
    const side = Math.max(Math.abs(width), Math.abs(height));
    this.to = isEven ? { x: this.from.x + side * Math.sign(width || 1), y: this.from.y + side * Math.sign(height || 1) } : at;
    for (const [name, value] of Object.entries(placed(this.kind, this.from, this.to))) this.draft.setAttribute(name, number(value));
  }

  release(): boolean {
    const least = LEAST * this.desk.paper.unit;
    if (Math.abs(this.to.x - this.from.x) < least || Math.abs(this.to.y - this.from.y) < least) this.cancel();
    else this.desk.make({ change: "draw", shape: spanned(this.kind, this.from, this.to), fill: this.desk.color() }, this.draft);
    return true;
  }

  cancel(): void {
    this.draft.remove();
  }
}

/** The attributes of what two corners span. */
function placed(kind: "ellipse" | "rect", from: Point, to: Point): Readonly<Record<string, number>> {
  const [left, top] = [Math.min(from.x, to.x), Math.min(from.y, to.y)];
  const [width, height] = [Math.abs(to.x - from.x), Math.abs(to.y - from.y)];
  return kind === "rect" ? { x: left, y: top, width, height } : { cx: left + width / 2, cy: top + height / 2, rx: width / 2, ry: height / 2 };
}

/** The shape that two corners span. */
export function spanned(kind: "ellipse" | "rect", from: Point, to: Point): NewShape {
  const [a = 0, b = 0, c = 0, d = 0] = Object.values(placed(kind, from, to));
  return kind === "rect" ? { rect: [a, b, c, d] } : { ellipse: [a, b, c, d] };
}

/** Moves the part under the pointer. */
export class Mover implements Hand {
  private part = "";
  private from: Point = { x: 0, y: 0 };
  private by: Point = this.from;
  private draft: SVGElement | null = null;

  constructor(private readonly desk: Desk) {}

  press(at: Point, part: string | null, shape: string | null): boolean {
    if (part === null) return false;
    // What belongs to a part goes with it, unless it is selected itself.
    this.part = shape !== null && shape === this.desk.state.selected ? shape : part;
    this.from = at;
    this.by = { x: 0, y: 0 };
    this.draft = null;
    return true;
  }

  drag(over: readonly Point[], isStraight: boolean): void {
    const at = over.at(-1);
    if (!at) return;
    let [x, y] = [at.x - this.from.x, at.y - this.from.y];
    if (isStraight) [x, y] = Math.abs(x) > Math.abs(y) ? [x, 0] : [0, y];
    const { paper, state } = this.desk;
    if (!this.draft && Math.hypot(x, y) <= CLICK * paper.unit) return;
    if (!this.draft) {
      state.select(this.part);
      this.draft = ghost(paper, this.part);
    }
    this.by = { x, y };
    this.draft.setAttribute("transform", `translate(${number(x)} ${number(y)})`);
  }

  release(): boolean {
    if (!this.draft) return false;
    this.desk.make({ change: "move", part: this.part, by: [this.by.x, this.by.y] }, this.draft);
    return true;
  }

  cancel(): void {
    this.draft?.remove();
  }
}

/** The outline of a part, to be moved. */
export function ghost(paper: PaperPanel, part: string): SVGElement {
  const draft = svg("path", { class: "paper-ghost", d: paper.areaOf(part) });
  paper.drafts.append(draft);
  return draft;
}
