// The properties of the selected part.

import { Eye, EyeOff, Focus, ScanEye } from "lucide";
import type { Commands } from "../commands";
import type { Editing } from "../editing/editing";
import { button, count, fill, h, icon, inCode } from "../dom";
import { depthOf, depthReasonOf, isAside, withUndo } from "../parts";
import type { ClipFacts, Part, Source } from "../protocol";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";

const BOUND: Readonly<Record<string, string>> = {
  group: "in one group with its shape",
  desc: "the shape's own description",
  leader: "a line leads to its shape",
  nearest: "its shape is the nearest",
  none: "bound to no shape",
};
const FROM: Readonly<Record<Source, string>> = { own: "its string", legend: "a legend", default: "defaults", builtin: "built in" };
const KIND: Readonly<Record<Part["kind"], string>> = { main: "part", sub: "shape of a part", legend: "legend", unused: "left out", terrain: "landscape", character: "character", region: "region of a character" };

/** What is said of a part that has no string. */
function withoutString({ kind, namedBy }: Part): string {
  if (kind !== "main") return "No string of its own.";
  switch (namedBy) {
    case "label":
      return "No string: its name is its label.";
    case "id":
      return "No string: its name is its id.";
    default:
      return "No string: its name and parent are automatic.";
  }
}

export class Inspector {
  readonly element = h("section", { class: "inspector", attributes: { "aria-label": "Selected part" } });
  private readonly title = h("h2", { class: "inspector-title" });
  private readonly actions = h("div", { class: "inspector-actions", attributes: { role: "group", "aria-label": "Selected part" } });
  private readonly hide: HTMLButtonElement;
  private readonly body = h("div", { attributes: { "aria-live": "polite" } });

  /** The clip that was shown when this was drawn. */
  private clip: string | undefined;

  /** `go` is called with parts that are clicked here. */
  constructor(private readonly state: State, private readonly viewer: Viewer, commands: Commands, private readonly editing: Editing, form: HTMLElement, private readonly go: (part: string) => void) {
    this.hide = button({ icon: EyeOff, label: "Hide", key: "H", press: () => commands.hide() });
    fill(
      this.actions,
      button({ icon: Focus, label: "Frame this part", key: "F", press: () => viewer.frameSelected() }),
      this.hide,
      button({ icon: ScanEye, label: "Show only this part", key: "Shift+H", press: () => commands.isolate() }),
    );
    // Head and buttons stay while the rest is drawn again, so that a pressed button keeps the focus.
    fill(this.element, h("header", { class: "inspector-head" }, this.title, this.actions), form, this.body);
    editing.listen(["mode"], () => this.draw());
    state.on(["hidden", "selection"], () => this.followHidden());
    state.on(["selection", "current"], () => this.draw());
    state.on("build", (drawing) => {
      if (drawing === state.current) this.draw();
    });
    // The clip can only change together with the time.
    viewer.on(["model", "time"], () => {
      if (viewer.playback.player.clip?.name !== this.clip) this.draw();
    });
    this.draw();
  }

  /** Draws all of it again. Who is on a link stays on the one in its place, so that Enter goes on to the parent of the parent. */
  private draw(): void {
    const at = [...this.body.querySelectorAll("button")].findIndex((one) => one === document.activeElement);
    this.fill();
    const links = this.body.querySelectorAll("button");
    if (at >= 0) (links[Math.min(at, links.length - 1)] ?? this.viewer.canvas).focus();
  }

  private fill(): void {
    const { selected, parts } = this.state;
    this.clip = this.viewer.playback.player.clip?.name;
    this.element.dataset["empty"] = String(selected === null);
    const part = parts.get(selected);
    this.actions.hidden = !part || isAside(part);
    this.followHidden();
    if (selected === null) {
      fill(this.title, "Part");
      return fill(this.body, h("p", { class: "muted pad" }, "Click a part, in the model or in the list, to see its string and attributes."));
    }
    if (!part) {
      fill(this.title, h("span", { class: "part-name" }, selected));
      return fill(this.body, h("p", { class: "muted pad" }, "The drawing has no part of this name at the moment."));
    }
    fill(this.title, h("span", { class: "part-name" }, part.name), h("span", { class: "muted" }, KIND[part.kind]));
    fill(this.body, this.string(part), this.facts(part), !this.editing.isOn && this.attributes(part));
  }

  private followHidden(): void {
    const { selected } = this.state;
    const hidden = selected !== null && this.state.isHidden(selected);
    const label = hidden ? "Show" : "Hide";
    if (this.hide.getAttribute("aria-label") === label) return;
    this.hide.setAttribute("aria-label", label);
    this.hide.title = `${label} (H)`;
    fill(this.hide, icon(hidden ? Eye : EyeOff));
  }

  private string(part: Part): HTMLElement {
    if (!part.string) {
      return h("p", { class: "muted pad" }, withoutString(part));
    }
    return h("p", { class: "string" }, h("code", {}, part.string.text));
  }

  private facts(part: Part): HTMLElement {
    const rows: [string, Node | string][] = [];
    if (part.string) rows.push(["Bound", BOUND[part.string.boundBy] ?? part.string.boundBy], ["Line", `${part.string.line}, column ${part.string.column}`]);
    if (part.string?.mayMean) rows.push(["Uncertain", `it may also mean ${part.string.mayMean}`]);
    if (!isAside(part)) rows.push(["Parent", part.parent === null ? "the root" : this.link(part.parent)]);
    const children = this.state.parts.children(part.name).filter(({ kind }) => kind !== "sub");
    const shapes = this.state.parts.children(part.name).length - children.length;
    if (children.length > 0) rows.push(["Children", this.links(children)]);
    if (shapes > 0) rows.push(["Shapes", count(shapes, "more shape")]);
    const driven = drivenBy(part.name, this.state.drawing?.build?.clips ?? [], this.clip);
    if (driven) rows.push(["Driven by", driven]);
    else if (part.joint !== null) rows.push(["Joint", part.joint]);
    const depth = depthOf(part);
    if (depth !== null) rows.push(["Depth", withUndo(`${depth} — ${depthReasonOf(part)}`, part.undo.depth)]);
    if (part.form !== null) rows.push(["Form", withUndo(part.form, part.undo.form)]);
    if (part.back !== null) rows.push(["From behind", withUndo(part.back, part.undo.back)]);
    rows.push(["Element", `#${part.element}`]);
    return h("dl", { class: "facts" }, ...rows.flatMap(([term, value]) => [h("dt", {}, term), h("dd", {}, ...(typeof value === "string" ? inCode(value) : [value]))]));
  }

  private attributes({ attributes }: Part): HTMLElement | null {
    if (attributes.length === 0) return null;
    const rows = attributes.map(({ name, value, from }) =>
      h("tr", {}, h("th", { attributes: { scope: "row" } }, name), h("td", {}, this.swatch(name, value), value || "on"), h("td", { class: `from ${from}` }, FROM[from])),
    );
    const head = h("thead", {}, h("tr", {}, ...["Attribute", "Value", "From"].map((title) => h("th", { attributes: { scope: "col" } }, title))));
    return h("table", { class: "attributes" }, head, h("tbody", {}, ...rows));
  }

  private swatch(name: string, value: string): HTMLElement | null {
    const color = name === "Color" ? cssColor(value) : null;
    if (color === null) return null;
    const swatch = h("span", { class: "swatch", attributes: { "aria-hidden": "true" } });
    swatch.style.backgroundColor = color;
    return swatch;
  }

  private link(name: string): HTMLElement {
    return h("button", { class: "link", attributes: { type: "button" }, on: { click: () => this.go(name) } }, name);
  }

  private links(parts: readonly Part[]): HTMLElement {
    return h("span", { class: "links" }, ...parts.map(({ name }) => this.link(name)));
  }
}

/**
 * The joint that drives a part, and why, in words; null for a part that belongs to no clip's figure. If clips differ, `shown` counts,
 * otherwise the first.
 */
export function drivenBy(part: string, clips: readonly Pick<ClipFacts, "name" | "joints" | "unmatched">[], shown?: string): string | null {
  const those = clips.filter(({ joints, unmatched }) => joints.has(part) || unmatched.includes(part));
  const clip = those.find(({ name }) => name === shown) ?? those[0];
  if (!clip) return null;
  const driven = clip.joints.get(part);
  if (!driven) return "no joint: it follows its parent";
  return driven.why ? `${driven.joint} — ${driven.why}` : driven.joint;
}

/** A colour as CSS: `r g b [a]` with numbers from 0 to 1 is converted, names and `#rrggbb` are kept, anything else is null. */
export function cssColor(value: string): string | null {
  const numbers = value.trim().split(/\s+/).map(Number);
  if ((numbers.length === 3 || numbers.length === 4) && numbers.every(Number.isFinite)) {
    const [r, g, b, a = 1] = numbers as [number, number, number, number?];
    return `rgb(${r * 255} ${g * 255} ${b * 255} / ${a})`;
  }
  return /^(#[0-9a-f]{3,8}|[a-z]+)$/i.test(value) ? value : null;
}
