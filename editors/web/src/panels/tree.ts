// The hierarchy: an ARIA tree of the drawing's parts, followed by those that are not in the model.

import { ChevronRight } from "lucide";
import { count, fill, h, icon } from "../dom";
import { isAside, isAutomatic } from "../parts";
import type { Part } from "../protocol";
import type { State } from "../state";

/** In drawings with more parts, shapes that belong to a part are folded at first. */
const FEW = 80;

interface Row {
  readonly part: Part;
  readonly level: number;
  readonly open: boolean | null;
  readonly place: number;
  readonly among: number;
}

/** What a row says when it is pointed at. */
function describe({ element, string }: Part): string {
  if (!string) return `#${element} has no string`;
  return string.mayMean ? `${string.text}\nIt may also mean ${string.mayMean}.` : string.text;
}

export class Tree {
  readonly element = h("section", { class: "tree-panel", attributes: { "aria-label": "Parts" } });
  private readonly list = h("div", { class: "tree", attributes: { role: "tree", "aria-label": "Parts of the drawing" } });
  private readonly summary = h("span", { class: "muted" });
  /** Parts that the user opened or closed; others have their initial state. */
  private readonly folds = new Map<string, boolean>();
  private rows: Row[] = [];
  private items = new Map<string, HTMLElement>();
  private active: string | null = null;
  /** The content of the rows, to detect changes. */
  private drawn = "";

  /** `picked` is called with parts that are clicked. */
  constructor(private readonly state: State, private readonly picked: (part: string) => void) {
    fill(this.element, h("h2", {}, "Parts", this.summary), this.list);
    this.list.addEventListener("click", (event) => this.click(event));
    this.list.addEventListener("keydown", (event) => this.key(event));
    this.list.addEventListener("pointerover", (event) => this.state.hover(this.nameAt(event.target)));
    this.list.addEventListener("pointerleave", () => this.state.hover(null));
    state.on("current", () => {
      this.folds.clear();
      this.active = null;
      this.draw();
    });
    state.on("build", (drawing) => {
      if (drawing === state.current) this.draw();
    });
    state.on("selection", () => this.reveal(state.selected));
    state.on("light", () => this.reveal(state.lit));
    state.on("hover", () => this.marks());
  }

  focus(): void {
    this.items.get(this.active ?? "")?.focus();
  }

  private draw(): void {
    const { parts } = this.state;
    this.summary.textContent = parts.shapes > 0 ? `${parts.main} and ${count(parts.shapes, "shape")}` : String(parts.main || "");
    const rows: Row[] = [];
    const walk = (siblings: readonly Part[], level: number): void => {
      siblings.forEach((part, at) => {
        const below = parts.children(part.name);
        const open = below.length > 0 ? this.isOpen(part) : null;
        rows.push({ part, level, open, place: at + 1, among: siblings.length });
        if (open) walk(below, level + 1);
      });
    };
    walk(parts.children(null), 1);
    const inModel = rows.length;
    parts.aside.forEach((part, at) => rows.push({ part, level: 1, open: null, place: at + 1, among: parts.aside.length }));
    this.rows = rows;
    if (!rows.some(({ part }) => part.name === this.active)) this.active = this.state.selected ?? rows[0]?.part.name ?? null;
    if (!rows.some(({ part }) => part.name === this.active)) this.active = rows[0]?.part.name ?? null;

    // Most builds change no row, and rebuilding the rows takes longer than loading the model.
    const words = rows.map(({ part, level, open, place, among }) => [part.name, part.kind, part.element, part.string?.text, part.string?.mayMean, part.namedBy, part.joint, level, open, place, among]);
    const drawn = JSON.stringify([words, this.active, this.state.drawing?.build === null]);
    if (drawn === this.drawn) return this.marks();
    this.drawn = drawn;

    const focused = this.list.contains(document.activeElement);
    const scroll = this.list.scrollTop;
    this.items = new Map();
    const items = rows.map((row) => this.item(row));
    if (parts.aside.length > 0) items.splice(inModel, 0, h("div", { class: "tree-break", attributes: { role: "none" } }, "Not in the model"));
    fill(this.list, ...items, rows.length === 0 && h("p", { class: "muted pad" }, this.state.drawing?.build ? "The drawing has no parts yet." : ""));
    this.list.scrollTop = scroll;
    if (focused) this.focus();
    this.marks();
  }

  private item({ part, level, open, place, among }: Row): HTMLElement {
    const { name, kind } = part;
    const note =
      kind === "legend" ? "legend" : kind === "unused" ? "left out" : kind === "sub" ? "shape" : kind === "terrain" ? "landscape" : kind === "character" ? "character" : kind === "region" ? "region" : isAutomatic(part) ? "automatic" : part.string?.mayMean ? "uncertain" : part.joint;
    const item = h(
      "div",
      {
        class: `tree-item ${kind}${isAutomatic(part) ? " automatic" : ""}${part.string?.mayMean ? " uncertain" : ""}`,
        title: describe(part),
        attributes: {
          role: "treeitem",
          "aria-level": level,
          "aria-posinset": place,
          "aria-setsize": among,
          "aria-expanded": open === null ? null : String(open),
          tabindex: name === this.active ? 0 : -1,
          "data-part": name,
        },
      },
      h("span", { class: "tree-indent", attributes: { "data-level": Math.min(level - 1, 12) } }),
      open === null ? h("span", { class: "tree-fold" }) : h("span", { class: "tree-fold", attributes: { "data-fold": true } }, icon(ChevronRight)),
      // Legends have no names: their text identifies them.
      h("span", { class: "tree-name" }, isAside(part) && part.string ? part.string.text : name),
      note && h("span", { class: "tree-note" }, note),
    );
    if (!this.items.has(name)) this.items.set(name, item);
    return item;
  }

  private isOpen(part: Part): boolean {
    const { parts } = this.state;
    return this.folds.get(part.name) ?? (parts.main + parts.shapes <= FEW || parts.children(part.name).some(({ kind }) => kind !== "sub"));
  }

  private fold(name: string, open: boolean): void {
    this.folds.set(name, open);
    this.draw();
  }

  private marks(): void {
    const { selected, hovered, lit } = this.state;
    for (const [name, item] of this.items) {
      item.setAttribute("aria-selected", String(name === selected));
      item.classList.toggle("hovered", name === hovered);
      item.classList.toggle("lit", name === lit);
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
      // Scrolls the list only, not the page.
      this.items.get(name)?.scrollIntoView({ block: "nearest" });
    }
    this.marks();
  }

  private activate(name: string): void {
    if (!this.items.has(name)) return;
    this.items.get(this.active ?? "")?.setAttribute("tabindex", "-1");
    this.active = name;
    this.items.get(name)?.setAttribute("tabindex", "0");
  }

  private click(event: MouseEvent): void {
    const name = this.nameAt(event.target);
    if (name === null) return;
    this.activate(name);
    const row = this.rows.find(({ part }) => part.name === name);
    if (event.target instanceof Element && event.target.closest("[data-fold]") && row) return this.fold(name, !row.open);
    this.choose(name);
  }

  private choose(name: string): void {
    this.state.select(name);
    this.picked(name);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const at = this.rows.findIndex(({ part }) => part.name === this.active);
    const row = this.rows[at];
    if (!row) return;
    const { name } = row.part;
    const go = (to: number): void => {
      const next = this.rows[Math.min(Math.max(to, 0), this.rows.length - 1)];
      if (!next) return;
      this.activate(next.part.name);
      this.focus();
      this.state.hover(next.part.name);
    };
    const keys: Record<string, () => void> = {
      ArrowDown: () => go(at + 1),
      ArrowUp: () => go(at - 1),
      Home: () => go(0),
      End: () => go(this.rows.length - 1),
      ArrowRight: () => (row.open === false ? this.fold(name, true) : row.open ? go(at + 1) : undefined),
      ArrowLeft: () => {
        const above = this.rows.findIndex(({ part }) => part.name === row.part.parent);
        if (row.open) this.fold(name, false);
        else if (above >= 0) go(above);
      },
      Enter: () => this.choose(name),
      " ": () => this.choose(name),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }

  private nameAt(target: EventTarget | null): string | null {
    const item = target instanceof Element ? target.closest<HTMLElement>("[data-part]") : null;
    return item?.dataset["part"] ?? null;
  }
}
