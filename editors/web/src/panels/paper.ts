// The drawing beside the model: a click on it means what it shows.

import { Maximize } from "lucide";
import { button, fill, h, svg } from "../dom";
import type { Host } from "../host/host";
import { Replaced } from "../host/replaced";
import { readPaper, type Box, type Paper, type Point } from "../protocol";
import type { State } from "../state";
import { Latest } from "../viewport/latest";
import { isRemembered, remember } from "./remembered";

const SHOWN = "okoshi.drawing";
/** How far beside a thin line a click still means it, in pixels. */
const REACH = 6;
/** How far the pointer goes in a click, in pixels: from there on it drags. */
const CLICK = 4;
const NEAREST = 40;
/** Two clicks within so many milliseconds are a double-click. */
const TWICE = 500;

/** A part of the page that is looked at: how many times as large as all of it, and where its left top corner is, in pixels. */
interface Look {
  readonly zoom: number;
  readonly x: number;
  readonly y: number;
}

const ALL: Look = { zoom: 1, x: 0, y: 0 };

/** Where the page lies in the window, and what of the drawing it is. */
interface Placed {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
  readonly page: Box;
}

/** What a press on the drawing does instead of looking around. */
export interface Hand {
  /** Whether it takes a press at a point of the page, on a part or beside all; `shape` is what lies there, if that only belongs to the part. */
  press(at: Point, part: string | null, shape: string | null): boolean;
  /** The pointer has gone over points; with Shift it is held to what is even or straight. */
  drag(over: readonly Point[], shift: boolean): void;
  /** It is released; `false` if that was a click. */
  release(): boolean;
  cancel(): void;
}

export class PaperPanel {
  readonly element = h("section", { class: "paper", hidden: true, attributes: { "aria-label": "Drawing" } });
  /** Where the page lies. */
  readonly desk = h("div", { class: "paper-desk", attributes: { role: "group", "aria-label": "Page" } });
  /** What is being drawn, in units of the drawing. */
  readonly drafts = svg("svg", { class: "paper-drafts", "aria-hidden": "true" });
  hand: Hand | null = null;
  isOn = isRemembered(SHOWN);
  private readonly picture = h("img", { attributes: { alt: "", draggable: "false" } });
  private readonly marks = svg("svg", { class: "paper-marks", "aria-hidden": "true" });
  private readonly sheet = h("div", { class: "paper-sheet" }, this.picture, this.marks, this.drafts);
  private readonly whole = button({ icon: Maximize, label: "Show all of the drawing", class: "paper-all", press: () => this.see(ALL) });
  private readonly note = h("p", { class: "paper-note muted", hidden: true, attributes: { role: "status" } });
  private readonly lacking = h("p", { class: "paper-lacking muted", hidden: true, attributes: { role: "status" } });
  private readonly context = document.createElement("canvas").getContext("2d");
  private readonly listeners: (() => void)[] = [];
  private readonly pointers = new Map<number, Point>();
  private paper: Paper | null = null;
  private paths: Path2D[] = [];
  private asked: string | null = null;
  private look = ALL;
  private fails = false;
  /** The build whose page is shown. */
  private revision = 0;
  /** When the last click was. */
  private clicked = 0;
  /** Where the page lay when the hand took the pointer; null while it has not. What moves the page meanwhile must not tear a line apart. */
  private held: Placed | null = null;
  /** How far the pointer has gone since it was pressed. */
  private gone = 0;
  private readonly latest: Latest<string, Paper>;

  constructor(private readonly state: State, host: Host, private readonly picked: (part: string) => void, private readonly renamed: () => void) {
    this.latest = new Latest(
      async (address) => readPaper(JSON.parse(new TextDecoder().decode(await host.model(address)))),
      (paper, address) => this.take(paper, address),
      // The address of what replaced it is on its way.
      (error) => !(error instanceof Replaced) && this.say("The drawing could not be fetched."),
    );
    fill(this.desk, this.sheet, this.whole, this.note, this.lacking);
    fill(this.element, this.desk);
    this.picture.addEventListener("error", () => {
      // What browsers do not read as a picture is at least shown as areas.
      this.fails = this.picture.hasAttribute("src");
      this.draw();
    });
    this.listenToPointer();
    new ResizeObserver(() => this.place()).observe(this.desk);
    state.on(["current", "build"], () => this.ask());
    state.on(["selection", "hover", "light", "hidden"], () => this.draw());
  }

  onToggle(listener: () => void): void {
    this.listeners.push(listener);
    listener();
  }

  toggle(): void {
    this.isOn = !this.isOn;
    remember(SHOWN, this.isOn);
    this.ask();
    for (const listener of this.listeners) listener();
  }

  /** Asks for the page of the drawing that is shown, if it is not here. */
  private ask(): void {
    const address = this.state.drawing?.build?.paper ?? null;
    this.element.hidden = !this.isOn || this.state.current === null;
    if (this.element.hidden) return;
    if (address === null) {
      this.asked = this.paper = null;
      this.paths = [];
      this.say("Nothing is drawn yet.");
      return this.draw();
    }
    const key = `${this.state.drawing?.connection} ${address}`;
    if (key === this.asked) return;
    this.asked = key;
    this.latest.want(address);
  }

  private take(paper: Paper, address: string): void {
    if (address !== this.state.drawing?.build?.paper) return;
    const moved = this.paper?.page.join() !== paper.page.join();
    this.paper = paper;
    this.paths = paper.shapes.map(({ area }) => new Path2D(area));
    this.fails = false;
    this.say("");
    const { leftOut } = paper;
    this.lacking.textContent = `Not shown: ${leftOut.join(", ")}. Linked pictures may have 8 MiB together.`;
    this.lacking.hidden = leftOut.length === 0;
    const before = this.picture.src;
    // As a picture, a drawing runs no scripts and loads nothing.
    this.picture.src = URL.createObjectURL(new Blob([paper.picture], { type: "image/svg+xml" }));
    if (before) URL.revokeObjectURL(before);
    for (const layer of [this.marks, this.drafts]) layer.setAttribute("viewBox", paper.page.join(" "));
    this.revision = this.state.drawing.build.revision;
    this.sweep();
    if (moved) this.look = ALL;
    this.place();
    this.draw();
  }

  /** Left, top, width and height of the page. */
  get page(): Box {
    return this.paper?.page ?? [0, 0, 1, 1];
  }

  /** How long a pixel is, in units of the drawing. */
  get unit(): number {
    return 1 / (this.scale * this.look.zoom);
  }

  /** The corners of what is seen of the page. */
  get seen(): { readonly from: Point; readonly to: Point } {
    const { left, top, right, bottom } = this.desk.getBoundingClientRect();
    const [x, y, width, height] = this.page;
    const [from, to] = [this.onPage({ x: left, y: top }), this.onPage({ x: right, y: bottom })];
    return { from: { x: Math.max(from.x, x), y: Math.max(from.y, y) }, to: { x: Math.min(to.x, x + width), y: Math.min(to.y, y + height) } };
  }

  /** The area of a part, as path data. */
  areaOf(part: string): string {
    return this.shapesOf(part).map(({ area }) => area).join("");
  }

  /** A draft is decided: it is shown until the drawing, which showed the build `since`, shows it itself. */
  settle(draft: SVGElement, made: boolean, since: number): void {
    if (!made) return draft.remove();
    draft.dataset["since"] = String(since);
    this.sweep();
  }

  private sweep(): void {
    for (const draft of this.drafts.querySelectorAll<SVGElement>("[data-since]")) if (Number(draft.dataset["since"]) < this.revision) draft.remove();
  }

  /** Takes the pointer from the hand; true if it had it. */
  letGo(): boolean {
    if (!this.held) return false;
    this.held = null;
    this.hand?.cancel();
    return true;
  }

  private say(words: string): void {
    this.note.textContent = words;
    this.note.hidden = words === "";
    this.lacking.hidden ||= words !== "";
    this.sheet.hidden = words !== "";
  }

  private see(look: Look): void {
    this.look = look;
    this.place();
  }

  /** Pixels per unit of the drawing if all of it is seen. */
  private get scale(): number {
    if (!this.paper) return 1;
    const [, , width, height] = this.paper.page;
    return Math.max(Math.min((this.desk.clientWidth - 24) / width, (this.desk.clientHeight - 24) / height), 1e-9);
  }

  private place(): void {
    if (!this.paper || this.element.hidden) return;
    this.whole.hidden = this.look === ALL;
    const [, , width, height] = this.paper.page;
    const { style } = this.sheet;
    style.width = `${width * this.scale}px`;
    style.height = `${height * this.scale}px`;
    style.transform = `translate(-50%, -50%) translate(${this.look.x}px, ${this.look.y}px) scale(${this.look.zoom})`;
  }

  private get placed(): Placed {
    const { left, top, width, height } = this.sheet.getBoundingClientRect();
    return { left, top, width, height, page: this.page };
  }

  /** A point of the window on the page, in units of the drawing. */
  private onPage({ x, y }: Point, { left, top, width, height, page }: Placed = this.placed): Point {
    const [minX, minY, w, h] = page;
    return { x: minX + ((x - left) / width) * w, y: minY + ((y - top) / height) * h };
  }

  /** The part that is meant by a point of the window. */
  private at(point: Point): string | null {
    const { x, y } = this.onPage(point);
    const written = this.paper?.strings.findLast(({ box: [left, top, right, bottom] }) => x >= left && x <= right && y >= top && y <= bottom);
    if (written) return this.carrier(written.part);
    const part = this.shapeAt(point);
    return part === null ? null : this.carrier(part);
  }

  /** What is drawn at a point of the window, by itself. */
  private shapeAt(point: Point): string | null {
    const { paper, context } = this;
    if (!paper || !context) return null;
    const { x, y } = this.onPage(point);
    const hit = this.paths.findLastIndex((path) => context.isPointInPath(path, x, y, "evenodd"));
    context.lineWidth = (2 * REACH) / (this.scale * this.look.zoom);
    const found = hit >= 0 ? hit : this.paths.findLastIndex((path) => context.isPointInStroke(path, x, y));
    return paper.shapes[found]?.part ?? null;
  }

  /** What a click on a shape selects: as on the model, the part that shows it. */
  private carrier(part: string): string | null {
    const { parts } = this.state;
    return parts.carrier(part)?.name ?? parts.get(part)?.name ?? null;
  }

  private listenToPointer(): void {
    const element = this.desk;
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), { x: event.clientX, y: event.clientY });
    }, { passive: false });
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || (event.target as Element).closest("button")) return;
      const at = { x: event.clientX, y: event.clientY };
      // A second finger looks around.
      this.letGo();
      if (this.pointers.size === 0) {
        this.gone = 0;
        this.held = this.paper !== null && this.hand?.press(this.onPage(at), this.at(at), this.shapeAt(at)) === true ? this.placed : null;
      }
      this.pointers.set(event.pointerId, at);
      element.setPointerCapture(event.pointerId);
    });
    element.addEventListener("pointermove", (event) => {
      const now = { x: event.clientX, y: event.clientY };
      const before = this.pointers.get(event.pointerId);
      if (!before) return void (event.pointerType !== "touch" && this.state.hover(this.at(now)));
      this.gone += Math.hypot(now.x - before.x, now.y - before.y);
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
      this.pointers.set(event.pointerId, now);
      const { held } = this;
      if (held) return this.hand?.drag(passed(event).map((point) => this.onPage(point, held)), event.shiftKey);
      if (this.gone <= CLICK) return;
      if (other) this.zoom(apart(now, other) / Math.max(apart(before, other), 1), other);
      else this.see({ ...this.look, x: this.look.x + now.x - before.x, y: this.look.y + now.y - before.y });
    });
    element.addEventListener("pointerup", (event) => {
      if (!this.pointers.delete(event.pointerId) || this.pointers.size > 0) return;
      const { held } = this;
      this.held = null;
      if (held ? this.hand?.release() : this.gone > CLICK) return;
      const at = { x: event.clientX, y: event.clientY };
      const part = this.at(at);
      const inner = this.shapeAt(at);
      // A click into the selected part means the shape there, unless it is the second half of a double-click.
      const goesIn = this.hand !== null && part !== null && part === this.state.selected && inner !== null && this.state.parts.get(inner) !== undefined && event.timeStamp - this.clicked > TWICE;
      this.clicked = event.timeStamp;
      this.state.select(goesIn ? inner : part);
      if (part !== null) this.picked(part);
    });
    element.addEventListener("pointercancel", ({ pointerId }) => {
      if (this.pointers.delete(pointerId)) this.letGo();
    });
    element.addEventListener("pointerleave", () => this.state.hover(null));
    element.addEventListener("dblclick", (event) => {
      if (!(event.target as Element).closest("button")) this.renamed();
    });
  }

  /** Zooms about a point of the window. */
  private zoom(by: number, { x, y }: Point): void {
    const zoom = Math.min(Math.max(this.look.zoom * by, 1), NEAREST);
    if (zoom === 1) return this.see(ALL);
    const { left, top, width, height } = this.desk.getBoundingClientRect();
    const grown = zoom / this.look.zoom;
    const [dx, dy] = [x - left - width / 2, y - top - height / 2];
    this.see({ zoom, x: dx - (dx - this.look.x) * grown, y: dy - (dy - this.look.y) * grown });
  }

  /** Marks the parts that are selected, pointed at, and under an editor's cursor, and leads from their strings to them. */
  private draw(): void {
    const { paper, state } = this;
    if (!paper || this.element.hidden) return fill(this.marks);
    const marked = [["lit", state.lit], ["chosen", state.selected], ["hovered", state.hovered]] as const;
    fill(
      this.marks,
      this.fails && svg("path", { class: "paper-area", "fill-rule": "evenodd", d: paper.shapes.map(({ area }) => area).join("") }),
      ...marked.flatMap(([kind, part]) => (part === null ? [] : this.marksOf(paper, part, kind))),
    );
  }

  private shapesOf(part: string): Paper["shapes"] {
    return this.paper?.shapes.filter((shape) => shape.part === part || this.carrier(shape.part) === part) ?? [];
  }

  private marksOf(paper: Paper, part: string, kind: string): SVGElement[] {
    const shapes = this.shapesOf(part);
    const area = shapes.map((shape) => shape.area).join("");
    const strings = paper.strings.filter((string) => string.part === part);
    const corners = shapes.flatMap((shape) => points(shape.area));
    const boxes = strings.map(({ box: [left, top, right, bottom] }) => svg("rect", { class: `paper-string ${kind}`, x: left, y: top, width: right - left, height: bottom - top }));
    const leads = strings.flatMap(({ box }) => {
      const ends = lead(box, corners);
      return ends ? [svg("path", { class: `paper-lead ${kind}`, d: `M${ends[0].x} ${ends[0].y}L${ends[1].x} ${ends[1].y}` })] : [];
    });
    return [...(area === "" ? [] : [svg("path", { class: `paper-mark ${kind}`, d: area })]), ...boxes, ...leads];
  }
}

/** The points that a pointer has gone over since the last event, which may be several in a frame. */
function passed(event: PointerEvent): readonly Point[] {
  const events = event.getCoalescedEvents?.() ?? [];
  return (events.length > 0 ? events : [event]).map(({ clientX: x, clientY: y }) => ({ x, y }));
}

const apart = (a: Point, b: Point): number => Math.hypot(a.x - b.x, a.y - b.y);

/** The corners of path data that consists of straight lines. */
function points(area: string): Point[] {
  const numbers = area.match(/-?[\d.]+/g)?.map(Number) ?? [];
  return Array.from({ length: numbers.length >> 1 }, (_, index) => ({ x: numbers[2 * index]!, y: numbers[2 * index + 1]! }));
}

/** The shortest way from a box to a corner; null if a corner is in it. */
function lead([left, top, right, bottom]: Box, corners: readonly Point[]): readonly [Point, Point] | null {
  let nearest: readonly [Point, Point] | null = null;
  for (const corner of corners) {
    const from = { x: Math.min(Math.max(corner.x, left), right), y: Math.min(Math.max(corner.y, top), bottom) };
    if (!nearest || apart(from, corner) < apart(...nearest)) nearest = [from, corner];
  }
  return nearest && apart(...nearest) > 0 ? nearest : null;
}
