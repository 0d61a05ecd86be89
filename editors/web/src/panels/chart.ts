// The chart of a clip: the movement between the frames of its source, omitted frames, and how long drawings are held.

import { fill, h, svg } from "../dom";
import { describeExposure, peaks, type ExposureSheet } from "../viewport/exposure-sheet";
import type { Viewer } from "../viewport/viewer";
import { ClipChart } from "./clip-chart";
import { APART, half, niceStep, round, word } from "./plot";

/** Space around the curve in pixels: for the numbers, and for the drawings below it. */
const LEFT = 50;
const RIGHT = 12;
const TOP = 14;
const BELOW = 38;
/** In a lower picture there are no numbers below the drawings, in pixels. */
const LOW = 112;
const BELOW_LOW = 20;
/** The height of the boxes of drawings, and their distance from the curve, in pixels. */
const BOX = 10;
const GAP = 5;
/** Narrower boxes have no gaps, in pixels. */
const NARROW = 4;

export class Chart extends ClipChart {
  private readonly head = svg("g", { class: "chart-head" });
  private readonly dot = svg("circle", { class: "chart-dot", r: 4 });
  private readonly stand = svg("path", { class: "chart-now" });
  private size = { width: 0, height: 0 };
  private scale = 1;

  /** `changed` is called when the chart is opened or closed. */
  constructor(viewer: Viewer, changed: () => void) {
    super(viewer, changed, { label: "Chart", classes: ["chart", "chart-picture"], remembered: "okoshi.chart" });
    fill(
      this.element,
      h(
        "header",
        { class: "chart-title" },
        h("h2", {}, "Movement per frame ", h("span", { class: "muted", title: "Sum of the squared distances of all joints to the frame before, in the motion file's unit" }, "SSD, unit²")),
        this.summary,
        this.file,
        h("span", { class: "chart-legend", attributes: { "aria-hidden": "true" } }, h("i", { class: "of-omitted" }), "omitted", h("i", { class: "of-held" }), "held", h("i", { class: "of-drawing" }), "drawing"),
      ),
      h("div", { class: "chart-place" }, this.picture, this.tip),
    );
  }

  protected get sheet(): ExposureSheet | null {
    return this.viewer.exposure;
  }

  get isPossible(): boolean {
    return (this.sheet?.facts.ssd.length ?? 0) > 0;
  }

  /** The x coordinate of a source frame, in pixels. */
  private at(source: number): number {
    return LEFT + ((this.size.width - LEFT - RIGHT) * source) / (this.drawn?.sources ?? 1);
  }

  /** The y coordinate of 0, in pixels. */
  private get bottom(): number {
    return this.size.height - (this.size.height < LOW ? BELOW_LOW : BELOW);
  }

  /** The y coordinate of a movement, in pixels. */
  private up(ssd: number): number {
    const { bottom } = this;
    return bottom - ((bottom - TOP) * ssd) / this.scale;
  }

  protected draw(): void {
    const { sheet: exposure } = this;
    const { width, height } = this.picture.getBoundingClientRect();
    if (!exposure || width <= LEFT + RIGHT || height <= TOP + BELOW_LOW) return;
    this.drawn = exposure;
    this.size = { width, height };
    const { facts, runs, sources } = exposure;
    const most = facts.ssd.reduce((top, value) => Math.max(top, value), 0);
    this.scale = most > 0 ? niceAbove(most) : 1;
    this.picture.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const { bottom } = this;
    const right = width - RIGHT;

    const isLow = height < LOW;
    const grid = (isLow ? [0, 1] : [0, 0.5, 1]).map((part) => this.scale * part);
    const lines = svg("path", { class: "chart-grid", d: grid.map((value) => `M${LEFT} ${half(this.up(value))}H${right}`).join("") });
    const numbers = grid.map((value) => word(LEFT - 7, this.up(value) + 4, "end", figures(value)));
    const step = niceStep((sources * APART) / (right - LEFT));
    // Space for the last number; numbers count from 1, like the bar below.
    for (let frame = 0; !isLow && frame < sources; frame = frame === 0 ? step - 1 || 1 : frame + step) {
      const x = this.at(frame + 0.5);
      if (x < right - 8 || frame === 0) numbers.push(word(x, height - 6, "middle", String(frame + 1)));
    }

    const thinned = peaks(facts.ssd, right - LEFT);
    const points = thinned.values.map((value, at) => {
      const from = at * thinned.step * facts.ssdStep;
      const middle = Math.min(from + (thinned.step * facts.ssdStep) / 2, sources);
      return `${round(this.at(middle))} ${round(this.up(value))}`;
    });
    const curve = `M${points.join("L")}`;
    const ends = [points[0]!, points.at(-1)!].map((point) => point.split(" ")[0]!);

    const omitted = [...exposure.omitted].map((source) => ({ x: round(this.at(source + 0.5)), y: round(this.up(exposure.ssd(source) ?? 0)) }));
    const boxes = (held: boolean) => {
      const wanted = runs.filter(({ frames }) => frames > 1 === held);
      const d = wanted.map(({ from, to }) => {
        const [left, end] = [this.at(from), this.at(to)];
        const space = (right - LEFT) / runs.length < NARROW ? 0 : 1.5;
        return `M${round(left)} ${bottom + GAP}H${round(Math.max(end - space, left + 0.5))}V${bottom + GAP + BOX}H${round(left)}Z`;
      });
      return svg("path", { class: held ? "chart-held" : "chart-single", d: d.join(""), "data-marks": wanted.length });
    };
    fill(
      this.picture,
      lines,
      ...numbers,
      svg("path", { class: "chart-area", d: `${curve}L${ends[1]} ${bottom}L${ends[0]} ${bottom}Z` }),
      svg("path", { class: "chart-gone", d: omitted.map(({ x, y }) => `M${x} ${y}V${bottom}`).join(""), "data-marks": omitted.length }),
      svg("path", { class: "chart-curve", d: curve, "data-marks": points.length }),
      svg("path", { class: "chart-peak", d: omitted.map(({ x, y }) => `M${x - 3} ${y}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0`).join("") }),
      boxes(true),
      boxes(false),
      this.line,
      this.stand,
      this.head,
    );
    fill(this.head, svg("path", { d: `M0 ${TOP - 4}V${bottom + GAP + BOX + 2}` }), svg("path", { class: "chart-grip", d: `M-5 ${TOP - 10}H5V${TOP - 6}L0 ${TOP - 1}L-5 ${TOP - 6}Z` }), this.dot);
    this.element.classList.toggle("limited", facts.limited);
    const words = describeExposure(exposure);
    this.summary.textContent = words;
    this.file.textContent = facts.file;
    this.file.hidden = facts.file === "";
    const top = facts.ssd.indexOf(most) * facts.ssdStep;
    this.picture.setAttribute("aria-label", `How much the joints of ${facts.name || "the clip"} move from frame to frame: ${words}. ${most > 0 ? `The fastest is frame ${top + 1}, with an SSD of ${figures(most)}.` : "Nothing moves."}`);
    this.move();
  }

  protected move(): void {
    const { drawn } = this;
    if (!drawn) return;
    const { time } = this.viewer.player;
    const source = drawn.sourceAt(time);
    this.head.setAttribute("transform", `translate(${round(this.at(source + 0.5))} 0)`);
    this.dot.setAttribute("cy", String(round(this.up(drawn.ssd(source) ?? 0))));
    this.picture.dataset["source"] = String(source + 1);
    const run = drawn.runs[drawn.drawingIn(drawn.frameAt(time))];
    const { bottom } = this;
    this.stand.setAttribute("d", run ? `M${round(this.at(run.from))} ${bottom + GAP}H${round(this.at(run.to) - 1)}V${bottom + GAP + BOX}H${round(this.at(run.from))}Z` : "");
  }

  protected over(event: PointerEvent): void {
    const { drawn } = this;
    if (!drawn) return;
    const { left } = this.picture.getBoundingClientRect();
    const part = (event.clientX - left - LEFT) / (this.size.width - LEFT - RIGHT);
    const source = Math.min(Math.max(Math.floor(part * drawn.sources), 0), drawn.sources - 1);
    this.dragTo(drawn, source);
    const x = this.at(source + 0.5);
    this.line.setAttribute("d", `M${half(x)} ${TOP}V${this.bottom}`);
    const ssd = drawn.ssd(source);
    const run = drawn.runs[drawn.drawingFor(source)];
    const words = [`frame ${source + 1}`, ssd === null ? "" : `SSD ${figures(ssd)}`];
    if (drawn.omitted.has(source)) words.push("omitted");
    else if (run) words.push(`drawing ${drawn.drawingFor(source) + 1}`, run.frames > 1 ? `stands for ${run.frames} frames` : "");
    this.tell(words.filter(Boolean), x, this.size.width);
  }
}

const NUMBERS = new Intl.NumberFormat("en", { maximumSignificantDigits: 3 });
/** A number with three digits; very small ones in scientific notation. */
export function figures(value: number): string {
  return value !== 0 && Math.abs(value) < 1e-4 ? value.toExponential(1).replace("e-", "e−") : NUMBERS.format(value);
}

/** The smallest of 1, 2, 4, 5, 6 or 8 times a power of ten that is not below a number: half of it is a short number too. */
export function niceAbove(value: number): number {
  const ten = 10 ** Math.floor(Math.log10(value));
  for (const times of [1, 2, 4, 5, 6, 8]) if (value <= times * ten * (1 + 1e-9)) return times * ten;
  return 10 * ten;
}
