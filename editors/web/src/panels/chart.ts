// The chart of a clip: the movement between the frames of its source, omitted frames, and how long drawings are held.

import { fill, h, svg } from "../dom";
import { describeExposure, peaks, type ExposureSheet } from "../viewport/exposure-sheet";
import type { Viewer } from "../viewport/viewer";
import { ClipChart } from "./clip-chart";
import { APART, half, niceStep, round, word } from "./plot";
import type { TimeAxis } from "./time-axis";

/** Space above and below the curve in pixels: for the playhead's grip, and for the drawings and numbers. */
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
  /** Where the first frame begins, and how wide a frame is, in pixels. */
  private axis = { left: 0, frame: 1 };
  private scale = 1;

  /** `changed` is called when the chart is opened or closed. */
  constructor(viewer: Viewer, private readonly time: TimeAxis, changed: () => void) {
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
    return this.viewer.playback.exposures.current;
  }

  get isPossible(): boolean {
    return (this.sheet?.facts.ssd.length ?? 0) > 0;
  }

  /** The x coordinate where a frame begins, of the clip or of its source, in pixels. */
  private at(frame: number): number {
    return this.axis.left + this.axis.frame * frame;
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

  draw(): void {
    const { sheet: exposure } = this;
    const { width, height } = this.picture.getBoundingClientRect();
    if (!exposure || width === 0 || height <= TOP + BELOW_LOW) return;
    this.drawn = exposure;
    this.size = { width, height };
    const { left, right } = this.time.within(this.picture);
    this.axis = { left, frame: (right - left) / Math.max(this.time.seconds * exposure.fps, 1) };
    const { facts, runs, sources } = exposure;
    const most = facts.ssd.reduce((top, value) => Math.max(top, value), 0);
    this.scale = most > 0 ? niceAbove(most) : 1;
    this.picture.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const { bottom } = this;

    const isLow = height < LOW;
    const grid = (isLow ? [0, 1] : [0, 0.5, 1]).map((part) => this.scale * part);
    const lines = svg("path", { class: "chart-grid", d: grid.map((value) => `M${left} ${half(this.up(value))}H${right}`).join("") });
    const numbers = grid.map((value) => word(left - 7, this.up(value) + 4, "end", figures(value)));
    const step = niceStep(APART / this.axis.frame);
    // Space for the last number; numbers count from 1, like the bar below.
    for (let frame = 0; !isLow && frame < sources; frame = frame === 0 ? step - 1 || 1 : frame + step) {
      const x = this.at(frame);
      if (x < right - 8 || frame === 0) numbers.push(word(x, height - 6, "middle", String(frame + 1)));
    }

    const thinned = peaks(facts.ssd, right - left);
    const points = thinned.values.map((value, at) => {
      const from = at * thinned.step * facts.ssdStep;
      const middle = Math.min(from + (thinned.step * facts.ssdStep - 1) / 2, sources - 1);
      return `${round(this.at(middle))} ${round(this.up(value))}`;
    });
    const curve = `M${points.join("L")}`;
    const ends = [points[0]!, points.at(-1)!].map((point) => point.split(" ")[0]!);

    const omitted = [...exposure.omitted].map((source) => ({ x: round(this.at(source)), y: round(this.up(exposure.ssd(source) ?? 0)) }));
    const boxes = (held: boolean) => {
      const wanted = runs.filter(({ frames }) => frames > 1 === held);
      const d = wanted.map(({ start, frames }) => {
        const [begin, end] = [this.at(start), this.at(start + frames)];
        const space = (right - left) / runs.length < NARROW ? 0 : 1.5;
        return `M${round(begin)} ${bottom + GAP}H${round(Math.max(end - space, begin + 0.5))}V${bottom + GAP + BOX}H${round(begin)}Z`;
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
      this.dot,
    );
    fill(this.head, svg("path", { d: `M0 ${TOP - 4}V${bottom + GAP + BOX + 2}` }), svg("path", { class: "chart-grip", d: `M-5 ${TOP - 10}H5V${TOP - 6}L0 ${TOP - 1}L-5 ${TOP - 6}Z` }));
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
    const { time } = this.viewer.playback.player;
    // The playhead is where the slider is; the dot is on the frame of the source that is shown then.
    this.head.setAttribute("transform", `translate(${round(this.at(time * drawn.fps))} 0)`);
    const source = drawn.sourceAt(time);
    this.dot.setAttribute("cx", String(round(this.at(source))));
    this.dot.setAttribute("cy", String(round(this.up(drawn.ssd(source) ?? 0))));
    this.picture.dataset["source"] = String(source + 1);
    const run = drawn.runs[drawn.drawingIn(drawn.frameAt(time))];
    const { bottom } = this;
    this.stand.setAttribute("d", run ? `M${round(this.at(run.start))} ${bottom + GAP}H${round(this.at(run.start + run.frames) - 1)}V${bottom + GAP + BOX}H${round(this.at(run.start))}Z` : "");
  }

  protected over(event: PointerEvent): void {
    const { drawn } = this;
    if (!drawn) return;
    const { left } = this.picture.getBoundingClientRect();
    const frame = Math.min(Math.max(Math.floor((event.clientX - left - this.axis.left) / this.axis.frame), 0), drawn.sources - 1);
    this.dragTo(drawn.timeOfFrame(frame));
    const x = this.at(frame);
    this.line.setAttribute("d", `M${half(x)} ${TOP}V${this.bottom}`);
    const ssd = drawn.ssd(frame);
    const drawing = frame < drawn.frames ? drawn.drawingIn(frame) : -1;
    const run = drawn.runs[drawing];
    const words = [`frame ${frame + 1}`, ssd === null ? "" : `SSD ${figures(ssd)}`, drawn.omitted.has(frame) ? "omitted" : ""];
    if (run) words.push(`drawing ${drawing + 1}`, run.frames > 1 ? `held for ${run.frames} frames` : "");
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
