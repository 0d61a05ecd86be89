// What is wrong with the drawing, over the last good model: a count in the corner, and a list that opens when problems stay, and closes again
// when they are gone.

import { ChevronDown, CircleX, Lightbulb, TriangleAlert } from "lucide";
import { count, fill, h, icon, inCode } from "../dom";
import type { Build, Finding, Severity } from "../protocol";
import type { State } from "../state";

const ICONS = { error: CircleX, warning: TriangleAlert, hint: Lightbulb } as const;
/** What people call them. */
const NAMES: Readonly<Record<Severity, string>> = { error: "Problem", warning: "Warning", hint: "Hint" };
const SEVERITIES = ["error", "warning", "hint"] as const;
/** Further findings are only counted. */
const MOST = 200;
/** The number of characters of a longer line that are shown around the marked ones. */
const LINE = 110;
/** Problems that are gone sooner are those of a word that is being typed, in milliseconds. */
const SETTLED = 600;

/** The list opens by itself, or only the count is shown because the host is an editor that shows the rest. */
export type Opening = "byItself" | "byHand";

export interface FindingsOptions {
  readonly opening: Opening;
  /** Called with findings that are clicked. */
  readonly go: (finding: Finding) => void;
  /** Called when the element with the focus is hidden. */
  readonly unfocused: () => void;
}

export class Findings {
  readonly element = h("section", { class: "findings", attributes: { "aria-label": "Problems and hints" } });
  private readonly list = h("ol", { class: "findings-list", attributes: { id: "findings-list", tabindex: -1 } });
  private readonly toggle = h("button", { class: "findings-head", attributes: { type: "button", "aria-controls": "findings-list" }, on: { click: () => this.set(!this.open) } });
  private readonly stale = h("p", { class: "stale", hidden: true, attributes: { role: "status" } });
  private open = false;
  /** The user opened it, so it does not close automatically. */
  private held = false;
  private errors = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private shown = "";

  constructor(private readonly state: State, private readonly options: FindingsOptions) {
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
    this.set(!this.open);
    if (this.open) this.list.querySelector<HTMLElement>("button")?.focus();
  }

  private set(open: boolean): void {
    this.open = this.held = open;
    this.marks();
  }

  private draw(): void {
    const build = this.state.drawing?.build;
    const findings = build?.findings ?? [];
    const errors = findings.some(({ severity }) => severity === "error");
    if (errors !== this.errors) this.follow(errors);

    const focused = this.element.contains(document.activeElement);
    const within = [...this.list.querySelectorAll("button")].findIndex((one) => one === document.activeElement);
    const stale = build ? staleness(build) : null;
    this.element.hidden = findings.length === 0 && stale === null;
    this.stale.hidden = stale === null;
    this.stale.textContent = stale?.whole ?? "";
    fill(
      this.toggle,
      ...SEVERITIES.map((severity) => badge(severity, findings)),
      stale && h("span", { class: "stale-short muted", title: stale.whole }, stale.short),
      h("span", { class: "findings-fold" }, findings.length > 0 && icon(ChevronDown)),
    );
    const key = JSON.stringify(findings);
    if (key !== this.shown) {
      this.shown = key;
      const items = sorted(findings).slice(0, MOST).map((finding) => this.item(finding));
      const more = findings.length - items.length;
      fill(this.list, ...items, more > 0 && h("li", { class: "muted pad" }, `and ${more.toLocaleString("en")} more`));
      const buttons = this.list.querySelectorAll("button");
      if (within >= 0) buttons[Math.min(within, buttons.length - 1)]?.focus();
    }
    this.marks();
    if (focused && this.element.hidden) this.options.unfocused();
  }

  /** Opens the list when there have been errors for a while, and closes it when they are gone. */
  private follow(errors: boolean): void {
    this.errors = errors;
    clearTimeout(this.timer);
    if (!errors && !this.held) this.open = false;
    if (!errors || this.options.opening === "byHand") return;
    this.timer = setTimeout(() => {
      this.open = true;
      this.marks();
    }, SETTLED);
  }

  private marks(): void {
    const any = this.list.childElementCount > 0;
    const open = this.open && any;
    if (!open && this.list.contains(document.activeElement)) this.toggle.focus();
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
        { class: "finding-main", attributes: { type: "button" }, on: { click: () => this.options.go(finding) } },
        icon(ICONS[severity]),
        h("span", { class: "finding-message" }, h("span", { class: "finding-name" }, `${NAMES[severity]}:`), " ", ...inCode(message), ...(place === "" ? [] : [", ", ...inCode(place)])),
        h("span", { class: "place", title: `line ${line}, column ${column}` }, `line ${line}`, code !== "" && h("span", { class: "code" }, code)),
        (before + marked + after).trim() !== "" && h("code", { class: "excerpt" }, before, h("mark", {}, marked || " "), after),
        label !== "" && h("span", { class: "finding-label" }, ...inCode(label)),
      ),
      ...help.map((one) => h("p", { class: "help" }, ...inCode(one))),
    );
  }
}

/** Which model is shown of a drawing with errors; null without errors. */
function staleness({ incomplete, stale, model }: Build): { readonly short: string; readonly whole: string } | null {
  if (incomplete) return { short: "incomplete", whole: "Incomplete: the drawing has problems, and this is what can be built." };
  if (!stale) return null;
  return model === null ? { short: "no model yet", whole: "No model yet: the drawing has problems." } : { short: "last good model", whole: "The drawing has problems: this is the last good model." };
}

const ORDER: Readonly<Record<Severity, number>> = { error: 0, warning: 1, hint: 2 };

export function sorted(findings: readonly Finding[]): Finding[] {
  return [...findings].sort((a, b) => ORDER[a.severity] - ORDER[b.severity] || a.line - b.line || a.column - b.column);
}

export function badge(severity: Severity, findings: readonly Finding[]): HTMLElement | null {
  const number = findings.filter((one) => one.severity === severity).length;
  return number === 0 ? null : h("span", { class: `badge ${severity}`, attributes: { "data-count": number } }, icon(ICONS[severity]), count(number, NAMES[severity].toLowerCase()));
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
