// The chart of a performance: how much the marks move, below it how much their joints move in the motion, and which frame of one stands
// in which of the other.

import { fill, h, svg } from "../dom";
import { describeEffect, describeFilming, describeTiming, PerformanceTimes, type Row, type Rows } from "../viewport/performance";
import type { ExposureSheet } from "../viewport/exposure-sheet";
import type { Viewer } from "../viewport/viewer";
import { ClipChart } from "./clip-chart";
import { APART, half, niceStep, round, word } from "./plot";
import type { TimeAxis } from "./time-axis";

/** Space above, below and between the rows in pixels: for titles, numbers, and the lines between the two. */
const SPACE = { top: 22, between: 48, below: 20 };
/** The same in a picture that is lower, in pixels, where there are neither titles nor numbers. */
const LOW = 130;
const LOW_SPACE = { top: 4, between: 14, below: 4 };
/** A table that is lower, in pixels, does not say which curve is which. */
const READABLE = 44;
/** Marks can be told apart without their colours, too. */
const DASHES = ["", "7 3", "2 3", "9 3 2 3"];
const ROWS: readonly Row[] = ["performance", "motion"];
const TITLES: Readonly<Record<Row, string>> = { performance: "marks of the performance", motion: "joints of the motion" };

export class PerformanceChart extends ClipChart {
  private readonly marks = h("tbody");
  /** The names of the curves, where there is no room for the table. The table has them for screen readers. */
  private readonly legend = h("div", { class: "performance-legend", hidden: true, attributes: { "aria-hidden": "true" } });
  private readonly table: HTMLElement;
  private readonly filming = h("p", { class: "muted" });
  private readonly head = svg("path", { class: "performance-head" });
  private times: PerformanceTimes | null = null;
  private rows: Rows = { left: 0, right: 1, performance: [0, 0], motion: [0, 0] };

  /** `changed` is called when the chart is opened or closed. */
  constructor(viewer: Viewer, private readonly time: TimeAxis, changed: () => void) {
    super(viewer, changed, { label: "Performance", classes: ["performance", "chart-picture performance-picture"], remembered: "okoshi.performance" });
    const head = h("thead", {}, h("tr", {}, ...["Mark", "Parts", "R", "Effect"].map((title) => h("th", { title: title === "R" ? "Its largest movement over that of the emphasised mark" : "", attributes: { scope: "col" } }, title))));
    this.table = h("div", { class: "performance-marks", attributes: { role: "group", "aria-label": "Marks", tabindex: 0 } }, h("table", {}, head, this.marks), this.filming);
    fill(
      this.element,
      h("header", { class: "chart-title" }, h("h2", {}, "Performance ", h("span", { class: "muted", title: "Movement per frame, as a ratio of the largest one" }, "movement, 0 to 1")), this.summary, this.file),
      h("div", { class: "performance-body" }, h("div", { class: "chart-place" }, this.picture, this.legend, this.tip), this.table),
    );
  }

  protected get sheet(): ExposureSheet | null {
    return this.viewer.playback.exposures.performed;
  }

  /** Whether the clip is performed. */
  get isPossible(): boolean {
    return this.sheet !== null;
  }

  draw(): void {
    const { sheet: performed } = this;
    const { width, height } = this.picture.getBoundingClientRect();
    if (!performed?.facts.performance || width === 0) return;
    const isLow = height < LOW;
    const { top: above, between, below } = isLow ? LOW_SPACE : SPACE;
    const high = (height - above - between - below) / 2;
    if (high <= 0) return;
    this.drawn = performed;
    const facts = performed.facts.performance;
    const times = (this.times = new PerformanceTimes(facts));
    const rows: Rows = (this.rows = { ...this.ends(performed, times), performance: [above, above + high], motion: [height - below - high, height - below] });
    this.picture.setAttribute("viewBox", `0 0 ${width} ${height}`);

    const parts: SVGElement[] = [];
    const numbers: SVGElement[] = [];
    for (const row of ROWS) {
      const [top, bottom] = rows[row];
      const last = times.at(Math.max(facts.frames[row] - 1, 0), rows);
      parts.push(svg("path", { class: "chart-grid", d: [top, bottom].map((y) => `M${round(rows.left)} ${half(y)}H${round(last)}`).join("") }));
      if (!isLow) parts.push(word(rows.left, top - 6, "start", TITLES[row]));
      const step = niceStep((times.frames * APART) / (rows.right - rows.left));
      for (let frame = 0; !isLow && frame < facts.frames[row]; frame = frame === 0 ? step - 1 || 1 : frame + step) numbers.push(word(times.at(frame, rows), bottom + 14, frame === 0 ? "start" : "middle", String(frame + 1)));
      const key = facts.keys?.[row];
      if (key !== undefined) parts.push(svg("path", { class: "performance-key", "data-frame": key + 1, d: `M${round(times.at(key, rows))} ${top}V${bottom}` }));
    }
    for (const { from, to, isKey } of times.links(rows)) parts.push(svg("path", { class: isKey ? "performance-link of-key" : "performance-link", d: `M${round(from[0])} ${round(from[1])}L${round(to[0])} ${round(to[1])}` }));
    for (const row of ROWS) {
      facts.marks.forEach((mark, at) => {
        const points = times.curve(row, at, rows).map(([x, y]) => `${round(x)} ${round(y)}`);
        if (points.length === 0) return;
        parts.push(colored(svg("path", { class: mark.emphasized ? "performance-curve emphasized" : "performance-curve", "data-row": row, "data-mark": mark.name, "stroke-dasharray": dashes(at), d: `M${points.join("L")}` }), mark.color));
      });
    }
    fill(this.picture, ...parts, ...numbers, this.line, this.head);

    const sample = ({ emphasized, color }: { readonly emphasized: boolean; readonly color: string }, at: number): SVGElement => {
      const sample = svg("svg", { class: "performance-sample", viewBox: "0 0 26 10", "aria-hidden": "true" });
      sample.append(colored(svg("path", { class: emphasized ? "performance-curve emphasized" : "performance-curve", "stroke-dasharray": dashes(at), d: "M1 5H25" }), color));
      return sample;
    };
    fill(this.legend, ...facts.marks.map((mark, at) => h("span", {}, sample(mark, at), mark.name)));
    this.legend.hidden = this.table.clientHeight >= READABLE;
    this.table.classList.toggle("squeezed", !this.legend.hidden);
    fill(this.marks, ...facts.marks.map((mark, at) => {
      const name = h("th", { attributes: { scope: "row" } }, sample(mark, at), mark.name);
      return h("tr", {}, name, h("td", {}, mark.parts.join(", ")), h("td", { class: "number" }, mark.ratio.toFixed(2)), h("td", {}, describeEffect(mark)));
    }));
    const timing = describeTiming(facts);
    this.summary.textContent = timing;
    this.file.textContent = facts.track;
    this.filming.textContent = describeFilming(facts);
    const keys = facts.keys ? `The marks move most in frame ${facts.keys.performance + 1} of ${facts.frames.performance}, the joints in frame ${facts.keys.motion + 1} of ${facts.frames.motion}` : "Not both of them move";
    this.picture.setAttribute("aria-label", `How much the marks of ${facts.track} move, and the joints of ${performed.facts.file}. ${keys}: ${timing}.`);
    this.move();
  }

  /** Where the first and the last frame of the longer row are, on the axis that all charts share. */
  private ends({ fps }: ExposureSheet, { frames }: PerformanceTimes): { readonly left: number; readonly right: number } {
    const { left, right } = this.time.within(this.picture);
    return { left, right: left + ((right - left) * (frames - 1)) / Math.max(this.time.seconds * fps, frames - 1) };
  }

  /** The frame of the performance that is shown. */
  private get frame(): number {
    return this.drawn?.sourceAt(this.viewer.playback.player.time) ?? 0;
  }

  protected move(): void {
    const { times, frame } = this;
    if (!times) return;
    const motion = times.motionAt(frame);
    // Above it is where the slider is.
    this.head.setAttribute("d", this.through(this.viewer.playback.player.time * (this.drawn?.fps ?? 0), motion));
    this.picture.dataset["frame"] = String(frame + 1);
    this.picture.dataset["motion"] = String(round(motion + 1));
  }

  /** A line through both rows at a frame of the performance and one of the motion, and from one to the other between them. */
  private through(performance: number, motion: number): string {
    const { rows, times } = this;
    if (!times) return "";
    const [above, below] = [performance, motion].map((frame) => round(times.at(frame, rows)));
    return `M${above} ${rows.performance[0]}V${rows.performance[1]}L${below} ${rows.motion[0]}V${rows.motion[1]}`;
  }

  protected over(event: PointerEvent): void {
    const { drawn, times, rows } = this;
    if (!drawn || !times) return;
    const { facts } = times;
    const box = this.picture.getBoundingClientRect();
    const row: Row = event.clientY - box.top > (rows.performance[1] + rows.motion[0]) / 2 ? "motion" : "performance";
    const own = times.frameAt(row, event.clientX - box.left, rows);
    const frame = row === "motion" ? Math.round(times.performanceAt(own)) : own;
    this.dragTo(row === "motion" ? drawn.timeOf(frame) : drawn.timeOfFrame(frame));
    const x = times.at(own, rows);
    this.line.setAttribute("d", this.through(frame, times.motionAt(frame)));
    const words = [row === "motion" ? `frame ${own + 1} of the motion` : `frame ${own + 1}`];
    facts.marks.forEach(({ name }, mark) => {
      const ratio = times.ratio(row, mark, own);
      if (ratio !== null) words.push(`${name} ${ratio.toFixed(2)}`);
    });
    this.tell(words, x, box.width);
  }
}

const dashes = (mark: number): string => DASHES[mark % DASHES.length]!;

/** A curve in the colour of its mark, as far as that stands out from the panel. */
function colored<E extends SVGElement>(element: E, color: string): E {
  if (color !== "") element.style.setProperty("--mark", color);
  return element;
}
