// The hierarchy: an ARIA tree of the drawing's parts, followed by those that are not in the model. Only the rows near the visible ones are
// in the page.

import { ChevronRight, Eye, EyeOff, X } from "lucide";
import { button, count, fill, h, icon } from "../dom";
import { isAside, isAutomatic } from "../parts";
import type { Part } from "../protocol";
import type { State } from "../state";
import { HEADING, isMatch, isRow, linesOf, titleOf, typedAhead, wordsOf, type Line } from "./rows";
import { VirtualList } from "./virtual-list";

/** In drawings with more parts, shapes that belong to a part are folded at first. */
const FEW = 80;
/** Letters that are typed within this time belong together, in milliseconds. */
const TYPING = 700;

/** What a row says when it is pointed at. */
function describe({ element, string }: Part): string {
  if (!string) return `#${element} has no string`;
  return string.mayMean ? `${string.text}\nIt may also mean ${string.mayMean}.` : string.text;
}

/** What stands at the end of a row. */
function noteOf(part: Part): string | null {
  switch (part.kind) {
    case "legend":
      return "legend";
    case "unused":
      return "left out";
    case "sub":
      return "shape";
    case "terrain":
      return "landscape";
    case "character":
      return "character";
    case "region":
      return "region";
    case "main":
      return isAutomatic(part) ? "automatic" : part.string?.mayMean ? "uncertain" : part.joint;
  }
}

export class Tree {
  readonly element = h("section", { class: "tree-panel", attributes: { "aria-label": "Parts" } });
  private readonly place = h("div", { class: "tree-rows", attributes: { role: "none" } });
  readonly list = h("div", { class: "tree", attributes: { role: "tree", "aria-label": "Parts of the drawing" } }, this.place);
  private readonly empty = h("p", { class: "muted pad tree-empty", attributes: { role: "status" } });
  private readonly summary = h("span", { class: "muted" });
  private readonly query = h("input", { class: "search-field", attributes: { type: "search", placeholder: "Search parts", "aria-label": "Search parts", "aria-keyshortcuts": "/", spellcheck: "false", autocomplete: "off" } });
  private readonly clear = button({ icon: X, label: "Clear the search", class: "search-clear", press: () => this.stopSearch() });
  private readonly unhide = h("button", { class: "link unhide", hidden: true, title: "Show all parts (A)", attributes: { type: "button", "aria-keyshortcuts": "A" }, on: { click: () => this.showAll() } });
  private readonly rows: VirtualList;
  /** Parts that the user opened or closed; others have their initial state. */
  private readonly folds = new Map<string, boolean>();
  private words: readonly string[] = [];
  private lines: readonly Line[] = [];
  /** The lines of parts, by name; of several with one name, the first. */
  private readonly places = new Map<string, number>();
  /** The part whose row is reached by Tab. */
  private active: string | null = null;
  /** What the rows in the page show, to detect changes. */
  private readonly drawn = new Map<number, string>();
  /** The letters typed just now. */
  private typed = "";
  private typedAt = 0;
  /** Whether typed letters search the rows. They do not after a click into the list: then they are shortcuts. */
  private byKeys = true;

  /** `picked` is called with parts that are clicked. */
  constructor(private readonly state: State, private readonly picked: (part: string) => void) {
    const search = h("div", { class: "search", attributes: { role: "search" } }, this.query, this.clear);
    fill(this.element, h("h2", {}, "Parts", this.summary), search, this.unhide, this.list, this.empty);
    this.rows = new VirtualList(
      this.list,
      this.place,
      (at) => this.make(at),
      () => this.marks(),
    );
    this.list.addEventListener("pointerdown", () => (this.byKeys = false));
    this.list.addEventListener("click", (event) => this.click(event));
    this.list.addEventListener("keydown", (event) => this.key(event));
    this.list.addEventListener("pointerover", (event) => this.state.hover(this.nameAt(event.target)));
    this.list.addEventListener("pointerleave", () => this.state.hover(null));
    this.list.addEventListener("focusout", ({ relatedTarget }) => {
      if (!(relatedTarget instanceof Node && this.list.contains(relatedTarget))) this.byKeys = true;
    });
    this.query.addEventListener("input", () => this.search(this.query.value));
    this.query.addEventListener("keydown", (event) => this.keyInSearch(event));
    state.on("current", () => {
      this.folds.clear();
      this.active = null;
      this.query.value = "";
      this.words = [];
      this.list.scrollTop = 0;
      this.draw();
    });
    state.on("build", (drawing) => {
      if (drawing === state.current) this.draw();
    });
    state.on("selection", () => this.reveal(state.selected));
    state.on("light", () => this.reveal(state.lit));
    state.on("hover", () => this.marks());
    state.on(["hidden", "build", "current"], () => this.countHidden());
    state.on("hidden", () => this.marks());
  }

  focus(): void {
    const at = this.placeOf(this.active);
    if (at < 0) return this.query.focus();
    this.rows.reveal(at);
    this.rows.visible.get(at)?.focus({ preventScroll: true });
  }

  /** Goes to the field that searches the parts. */
  focusSearch(): void {
    this.query.focus();
    this.query.select();
  }

  private placeOf(name: string | null): number {
    return (name === null ? undefined : this.places.get(name)) ?? -1;
  }

  private draw(): void {
    const { parts } = this.state;
    const focused = this.list.contains(document.activeElement);
    this.lines = linesOf(parts, this.words, (part) => this.isOpen(part));
    this.places.clear();
    this.lines.forEach((line, at) => {
      if (isRow(line) && !this.places.has(line.part.name)) this.places.set(line.part.name, at);
    });
    if (this.placeOf(this.active) < 0) this.active = [this.state.selected, this.firstMatch()].find((name) => this.placeOf(name ?? null) >= 0) ?? null;
    this.rows.set(this.lines.length, this.placeOf(this.active), (at) => this.drawn.get(at) === this.contentOf(at));
    // Rows that changed were made anew.
    if (focused) this.focus();
    this.marks();

    const all = parts.shapes > 0 ? `${parts.main} and ${count(parts.shapes, "shape")}` : String(parts.main || "");
    const found = this.words.length > 0 ? this.lines.filter((line) => isRow(line) && isMatch(line.part, this.words)).length : null;
    this.summary.textContent = found === null ? all : `${found} of ${parts.all.length}`;
    this.element.dataset["searches"] = String(found !== null);
    this.clear.hidden = this.query.value === "";
    this.empty.hidden = this.lines.length > 0;
    const none = found === null ? (this.state.drawing?.build ? "The drawing has no parts yet." : "") : "No part matches.";
    if (this.empty.textContent !== none) this.empty.textContent = none;
  }

  /** The part whose row is the first that is not only there for what is below it. */
  private firstMatch(): string | null {
    const line = this.lines.find((line) => isRow(line) && (this.words.length === 0 || isMatch(line.part, this.words)));
    return isRow(line) ? line.part.name : null;
  }

  /** What a row shows, as one text. */
  private contentOf(at: number): string {
    const line = this.lines[at];
    if (!isRow(line)) return HEADING;
    const { part, level, open, place, among } = line;
    return JSON.stringify([part.name, part.kind, part.element, part.string?.text, part.string?.mayMean, part.namedBy, part.joint, level, open, place, among, this.words.length === 0 || isMatch(part, this.words)]);
  }

  private make(at: number): HTMLElement {
    const line = this.lines[at];
    this.drawn.set(at, this.contentOf(at));
    if (!isRow(line)) return h("div", { class: "tree-break", attributes: { role: "none" } }, "Not in the model");
    const { part, level, open, place, among } = line;
    const { name, kind } = part;
    const note = noteOf(part);
    const aside = isAside(part);
    return h(
      "div",
      {
        class: `tree-item ${kind}${isAutomatic(part) ? " automatic" : ""}${part.string?.mayMean ? " uncertain" : ""}${this.words.length > 0 && !isMatch(part, this.words) ? " above" : ""}`,
        title: describe(part),
        attributes: { role: "treeitem", "aria-level": level, "aria-posinset": place, "aria-setsize": among, "aria-expanded": open === null ? null : String(open), "data-part": name },
      },
      h("span", { class: "tree-indent", attributes: { "data-level": Math.min(level - 1, 12) } }),
      open === null ? h("span", { class: "tree-fold" }) : h("span", { class: "tree-fold", attributes: { "data-fold": true } }, icon(ChevronRight)),
      h("span", { class: "tree-name" }, titleOf(part)),
      note && h("span", { class: "tree-note" }, note),
      // For the pointer; keys hide parts by H. Other rows leave its space free.
      aside || kind === "sub" ? h("span", { class: "tree-eye" }) : h("span", { class: "tree-eye", title: "Hide or show (H)", attributes: { "data-eye": true, "aria-hidden": "true" } }, icon(Eye), icon(EyeOff)),
    );
  }

  private isOpen(part: Part): boolean {
    const { parts } = this.state;
    return this.folds.get(part.name) ?? (parts.main + parts.shapes <= FEW || parts.children(part.name).some(({ kind }) => kind !== "sub"));
  }

  private fold(name: string, open: boolean): void {
    // While there is a search, all that was found stays open.
    if (this.words.length > 0) return;
    this.folds.set(name, open);
    this.draw();
  }

  private search(query: string): void {
    this.words = wordsOf(query);
    this.draw();
    const at = this.placeOf(this.words.length > 0 ? this.firstMatch() : (this.state.selected ?? this.active));
    if (at >= 0) this.rows.reveal(at);
  }

  private countHidden(): void {
    const { hidden, parts } = this.state;
    const number = parts.all.filter((part) => hidden.has(part.name) && !isAside(part) && part.kind !== "sub").length;
    this.unhide.hidden = number === 0;
    this.unhide.textContent = `Show all: ${count(number, "part is", "parts are")} hidden`;
  }

  private showAll(): void {
    this.state.showAll();
    this.focus();
  }

  private stopSearch(): void {
    this.query.value = "";
    this.search("");
    this.query.focus();
  }

  private marks(): void {
    const { selected, hovered, lit } = this.state;
    for (const [at, row] of this.rows.visible) {
      const line = this.lines[at];
      if (!isRow(line)) continue;
      const { name } = line.part;
      const hidden = this.state.isHidden(name);
      row.tabIndex = name === this.active ? 0 : -1;
      row.setAttribute("aria-selected", String(name === selected));
      row.classList.toggle("hovered", name === hovered);
      row.classList.toggle("lit", name === lit);
      row.classList.toggle("hidden-part", hidden);
      if (hidden) row.setAttribute("aria-description", "hidden");
      else row.removeAttribute("aria-description");
    }
  }

  /** Expands the ancestors of a part and scrolls it into view. */
  private reveal(name: string | null): void {
    if (name !== null && this.state.parts.get(name)) {
      let opened = false;
      for (const above of this.state.parts.above(name)) {
        const part = this.state.parts.get(above);
        if (!part || this.isOpen(part)) continue;
        this.folds.set(above, true);
        opened = true;
      }
      if (opened) this.draw();
      this.activate(name);
    }
    this.marks();
  }

  /** Lets Tab reach this row, and scrolls the list to it. */
  private activate(name: string): void {
    const at = this.placeOf(name);
    if (at < 0) return;
    this.active = name;
    this.rows.keep(at);
    this.rows.reveal(at);
    this.marks();
  }

  private click(event: MouseEvent): void {
    const name = this.nameAt(event.target);
    if (name === null) return;
    this.activate(name);
    const line = this.lines[this.placeOf(name)];
    const target = event.target instanceof Element ? event.target : null;
    if (target?.closest("[data-eye]")) return this.state.setHidden(name, !this.state.isHidden(name));
    if (target?.closest("[data-fold]") && isRow(line)) return this.fold(name, !line.open);
    this.choose(name);
  }

  private choose(name: string): void {
    this.state.select(name);
    this.picked(name);
  }

  private go(to: number): void {
    const line = this.lines[to];
    if (!isRow(line)) return;
    this.activate(line.part.name);
    this.focus();
    this.state.hover(line.part.name);
  }

  /** The nearest row in a direction, from a place that may be a heading or beyond the end. */
  private rowFrom(at: number, step: 1 | -1): number {
    let next = Math.min(Math.max(at, 0), this.lines.length - 1);
    while (this.lines[next] === HEADING) next += step;
    return next;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const at = this.placeOf(this.active);
    const row = this.lines[at];
    if (!isRow(row)) return;
    const { name } = row.part;
    const page = this.rows.page;
    const keys: Record<string, () => void> = {
      ArrowDown: () => this.go(this.rowFrom(at + 1, 1)),
      ArrowUp: () => this.go(this.rowFrom(at - 1, -1)),
      PageDown: () => this.go(this.rowFrom(at + page, 1)),
      PageUp: () => this.go(this.rowFrom(at - page, -1)),
      Home: () => this.go(this.rowFrom(0, 1)),
      End: () => this.go(this.rowFrom(this.lines.length - 1, -1)),
      ArrowRight: () => (row.open === false ? this.fold(name, true) : row.open ? this.go(at + 1) : undefined),
      ArrowLeft: () => {
        const above = this.placeOf(row.part.parent);
        if (row.open && this.words.length === 0) this.fold(name, false);
        else if (above >= 0) this.go(above);
      },
      Enter: () => this.choose(name),
      " ": () => this.choose(name),
    };
    const act = keys[event.key] ?? (this.byKeys ? this.typeAhead(event, at) : undefined);
    if (!act) return;
    this.byKeys = true;
    event.preventDefault();
    event.stopPropagation();
    act();
  }

  /** Goes to the next row whose name begins with what is being typed. */
  private typeAhead({ key, timeStamp }: KeyboardEvent, at: number): (() => void) | undefined {
    if (!/^[\p{L}\p{N}_]$/u.test(key)) return undefined;
    return () => {
      this.typed = timeStamp - this.typedAt < TYPING ? this.typed + key : key;
      this.typedAt = timeStamp;
      const next = typedAhead(this.lines, at, this.typed);
      if (next !== null) this.go(next);
    };
  }

  private keyInSearch(event: KeyboardEvent): void {
    const first = this.firstMatch();
    const keys: Record<string, () => void> = {
      ArrowDown: () => this.go(this.placeOf(first)),
      Enter: () => first !== null && this.choose(first),
      Escape: () => (this.query.value === "" ? this.focus() : this.stopSearch()),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  private nameAt(target: EventTarget | null): string | null {
    const item = target instanceof Element ? target.closest<HTMLElement>("[data-part]") : null;
    return item?.dataset["part"] ?? null;
  }
}
