// The diagnostics, over the last good model. The list opens when there are errors, and closes again when they are gone.

import { ChevronDown, CircleX, Lightbulb, TriangleAlert } from "lucide";
import { count, fill, h, icon } from "../dom";
import type { Finding, Severity } from "../protocol";
import type { State } from "../state";

const ICONS = { error: CircleX, warning: TriangleAlert, hint: Lightbulb } as const;
/** Further findings are only counted. */
const MOST = 200;
/** The number of characters of a longer line that are shown around the marked ones. */
const LINE = 110;

export class Findings {
  readonly element = h("section", { class: "findings", attributes: { "aria-label": "Diagnostics" } });
  private readonly list = h("ol", { class: "findings-list", attributes: { id: "findings-list", tabindex: -1 } });
  private readonly toggle = h("button", { class: "findings-head", attributes: { type: "button", "aria-controls": "findings-list" }, on: { click: () => this.set(!this.open, true) } });
  private readonly stale = h("p", { class: "stale", hidden: true, attributes: { role: "status" } });
  private open = false;
  /** The user opened it, so it does not close automatically. */
  private held = false;
  private errors = false;
  private shown = "";

  /** `go` is called with findings that are clicked. */
  constructor(private readonly state: State, private readonly go: (finding: Finding) => void) {
    fill(this.element, this.stale, this.toggle, this.list);
    state.on("current", () => {
      this.open = this.held = this.errors = false;
      this.draw();
    });
    state.on("build", (drawing) => {
      if (drawing === state.current) this.draw();
    });
    this.draw();
  }

  flip(): void {
    this.set(!this.open, true);
    if (this.open) this.list.querySelector<HTMLElement>("button")?.focus();
  }

  private set(open: boolean, byHand: boolean): void {
    this.open = open;
    this.held = byHand && open;
    this.marks();
  }

  private draw(): void {
    const build = this.state.drawing?.build;
    const findings = build?.findings ?? [];
    const errors = findings.some(({ severity }) => severity === "error");
    if (errors && !this.errors) this.open = true;
    if (!errors && this.errors && !this.held) this.open = false;
    this.errors = errors;

    this.element.hidden = !build;
    this.stale.hidden = !build?.stale && !build?.incomplete;
    this.stale.textContent = build?.incomplete
      ? "Incomplete: the drawing has errors, and this is what can be built."
      : build?.stale
        ? build.model === null
          ? "No model yet: the drawing has errors."
          : "The drawing has errors: this is the last good model."
        : "";
    fill(
      this.toggle,
      ...(["error", "warning", "hint"] as const).map((severity) => badge(severity, findings)),
      findings.length === 0 && h("span", { class: "muted" }, "No diagnostics"),
      h("span", { class: "findings-fold" }, findings.length > 0 && icon(ChevronDown)),
    );
    const key = JSON.stringify(findings);
    if (key !== this.shown) {
      this.shown = key;
      const items = sorted(findings).slice(0, MOST).map((finding) => this.item(finding));
      const more = findings.length - items.length;
      fill(this.list, ...items, more > 0 && h("li", { class: "muted pad" }, `and ${count(more, "more diagnostic")}`));
    }
    this.marks();
  }

  private marks(): void {
    const any = this.list.childElementCount > 0;
    const open = this.open && any;
    this.element.dataset["open"] = String(open);
    this.toggle.disabled = !any;
    this.toggle.setAttribute("aria-expanded", String(open));
    this.list.hidden = !open;
  }

  private item(finding: Finding): HTMLElement {
    const { severity, code, message, label, place, help, line, column } = finding;
    const { before, marked, after } = excerpt(finding);
    return h(
      "li",
      { class: `finding ${severity}` },
      h(
        "button",
        { class: "finding-main", attributes: { type: "button" }, on: { click: () => this.go(finding) } },
        icon(ICONS[severity]),
        h("span", { class: "finding-message" }, h("span", { class: "code", title: severity }, code), " ", ...inCode(message), place !== "" && h("span", { class: "muted" }, `, ${place}`)),
        h("span", { class: "place", title: `line ${line}, column ${column}` }, `${line}:${column}`),
        (before + marked + after).trim() !== "" && h("code", { class: "excerpt" }, before, h("mark", {}, marked || " "), after),
        label !== "" && h("span", { class: "finding-label" }, ...inCode(label)),
      ),
      ...help.map((one) => h("p", { class: "help" }, h("span", { class: "muted" }, "help: "), ...inCode(one))),
    );
  }
}

const ORDER: Readonly<Record<Severity, number>> = { error: 0, warning: 1, hint: 2 };

export function sorted(findings: readonly Finding[]): Finding[] {
  return [...findings].sort((a, b) => ORDER[a.severity] - ORDER[b.severity] || a.line - b.line || a.column - b.column);
}

export function badge(severity: Severity, findings: readonly Finding[]): HTMLElement | null {
  const number = findings.filter((one) => one.severity === severity).length;
  return number === 0 ? null : h("span", { class: `badge ${severity}`, attributes: { "data-count": number } }, icon(ICONS[severity]), count(number, severity));
}

/** The source line around its marked characters. Offsets count characters, not UTF-16 units. */
export function excerpt({ text, from, to }: Pick<Finding, "text" | "from" | "to">): { before: string; marked: string; after: string } {
  const all = Array.from(text);
  const blank = all.findIndex((one) => one.trim() !== "");
  let start = Math.min(Math.max(blank, 0), from);
  let end = all.length;
  if (end - start > LINE) {
    start = Math.max(start, from - Math.floor(LINE / 3));
    end = Math.min(end, Math.max(start + LINE, Math.min(to, from + LINE)));
  }
  const stop = Math.min(Math.max(to, from), end);
  const piece = (a: number, b: number): string => all.slice(a, b).join("");
  return { before: (start > blank && start > 0 ? "…" : "") + piece(start, from), marked: piece(from, stop), after: piece(stop, end).trimEnd() + (end < all.length ? "…" : "") };
}

/** Formats text between backticks as code. */
export function inCode(text: string): (Node | string)[] {
  return text.split("`").map((piece, at) => (at % 2 === 1 ? h("code", {}, piece) : piece));
}
