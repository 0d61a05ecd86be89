// The clip bar: which clip plays, at what time and speed, and above it the chart.

import { ChartSpline, Columns2, Footprints, Hand, Pause, Play, Repeat, SkipBack, SkipForward, SquareStack, Video } from "lucide";
import type { AnimationClip } from "three";
import { button, fill, h, icon, setHidden, svg } from "../dom";
import { SMALL } from "../layout";
import { drawingAt } from "../viewport/clips";
import type { ExposureSheet } from "../viewport/exposure-sheet";
import type { Viewer } from "../viewport/viewer";
import { Chart } from "./chart";
import { more } from "./more";
import { PerformanceChart } from "./performance";
import { TimeAxis } from "./time-axis";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2];
/** More ticks could not be distinguished. */
const MAX_TICKS = 600;

/** A held drawing on the timeline, in seconds. */
interface Box {
  readonly from: number;
  readonly to: number;
}

export class Clips {
  readonly element = h("section", { class: "clips", attributes: { "aria-label": "Clips" } });
  /** The bar and the charts above it. */
  readonly panel = h("div", { class: "motion", hidden: true });
  readonly chart: Chart;
  readonly performance: PerformanceChart;
  private readonly choice = h("select", { class: "select clip-choice", attributes: { "aria-label": "Clip" } });
  private readonly figure = h("select", { class: "select figure-choice", title: "Figure whose drawings are counted", attributes: { "aria-label": "Figure" } });
  private readonly play = button({ icon: Play, label: "Play", key: "Space", press: () => this.toggle() });
  private readonly slider = h("input", { class: "slider", attributes: { type: "range", min: 0, step: 0.001, "aria-label": "Time" } });
  private readonly ticks = svg("svg", { class: "ticks", viewBox: "0 0 1000 10", preserveAspectRatio: "none", "aria-hidden": "true" });
  private readonly now = svg("path", { class: "now" });
  private readonly readout = h("output", { class: "readout" });
  private readonly loop = button({ icon: Repeat, label: "Loop", press: () => this.viewer.playback.moved(() => (this.player.loops = !this.player.loops)) });
  private readonly along = button({ icon: Footprints, label: "Follow the figure", key: "V", press: () => this.followTravel() });
  private readonly films = button({ icon: Video, label: "Camera", key: "M", press: () => this.film() });
  private readonly onion = button({ icon: SquareStack, label: "Onion skin: the drawings before and after", key: "N", press: () => this.onionSkin() });
  private readonly charts = button({ icon: ChartSpline, label: "Chart", key: "C", press: () => this.chart.toggle() });
  private readonly performances = button({ icon: Hand, label: "Performance", key: "I", press: () => this.performance.toggle() });
  private readonly compares = button({ icon: Columns2, label: "Full and limited side by side", key: "O", press: () => this.compare() });
  private readonly speed = h("select", { class: "select", attributes: { "aria-label": "Speed" } }, ...SPEEDS.map((speed) => h("option", { attributes: { value: speed } }, `${speed}×`)));
  private shown: AnimationClip | null = null;
  private exposure: ExposureSheet | null = null;
  private readonly looks = h("div", { class: "clip-looks" });
  private readonly timeline = h("div", { class: "timeline" }, this.ticks, this.slider);
  readonly axis = new TimeAxis(this.timeline);
  private boxes: readonly Box[] = [];

  constructor(private readonly viewer: Viewer) {
    this.chart = new Chart(viewer, this.axis, () => this.toggled(this.performance));
    this.performance = new PerformanceChart(viewer, this.axis, () => this.toggled(this.chart));
    SMALL.addEventListener("change", () => this.toggled(this.chart));
    fill(
      this.element,
      h("div", { class: "clip-names" }, this.choice, this.figure),
      h(
        "div",
        { class: "transport" },
        button({ icon: SkipBack, label: "Previous key", key: "J", press: () => this.step(-1) }),
        this.play,
        button({ icon: SkipForward, label: "Next key", key: "K", press: () => this.step(1) }),
      ),
      this.timeline,
      this.readout,
      this.looks,
    );
    fill(this.looks, this.charts, this.performances, ...more("More about the clip", [this.compares, this.onion, this.films, this.along, this.loop, this.speed]));
    fill(this.panel, this.performance.element, this.chart.element, this.element);
    this.speed.value = "1";
    this.choice.addEventListener("change", () => {
      const clip = this.player.clips[this.choice.selectedIndex];
      if (clip) viewer.playback.moved(() => this.player.choose(clip));
    });
    this.figure.addEventListener("change", () => viewer.playback.chooseFigure(this.figure.value));
    this.speed.addEventListener("change", () => (this.player.speed = Number(this.speed.value)));
    this.slider.addEventListener("input", () =>
      viewer.playback.moved(() => {
        this.player.play(false);
        this.player.seek(Number(this.slider.value));
      }),
    );
    viewer.on(["model"], () => this.list());
    viewer.on(["time", "sideBySide"], () => this.follow());
  }

  /** Adds what changes the drawings: in the timeline, and beside the charts. */
  addTools(strip: HTMLElement, tools: readonly HTMLElement[]): void {
    this.timeline.append(strip);
    this.looks.prepend(...tools);
  }

  toggle(): void {
    this.viewer.playback.moved(() => this.player.play(!this.player.playing));
  }

  /** Lets the view go along with a figure that travels, or stay. */
  followTravel(): void {
    this.viewer.playback.followTravel(!this.viewer.playback.travel.wanted);
  }

  /** Shows the drawings before and after that of a paused clip, or no longer. */
  onionSkin(): void {
    this.viewer.playback.showOnionSkin(!this.viewer.playback.onionSkin.wanted);
  }

  /** Looks through the camera that films the clip, or no longer. */
  film(): void {
    if (this.viewer.playback.isFilmable) this.viewer.playback.film(!this.viewer.playback.isFilming);
  }

  /** Goes to the previous or next drawing or key. */
  step(keys: 1 | -1): void {
    const { clip, time } = this.player;
    const exposure = this.viewer.playback.exposures.current;
    if (!clip) return;
    if (!exposure || exposure.runs.length === 0) return this.viewer.playback.moved(() => this.player.step(keys));
    const { runs } = exposure;
    const frame = exposure.frameAt(time);
    const at = exposure.drawingIn(frame);
    // From within a drawing, back goes to its beginning.
    const next = keys < 0 && frame > runs[at]!.start ? at : (at + keys + runs.length) % runs.length;
    this.viewer.playback.moved(() => {
      this.player.play(false);
      this.player.seek(exposure.timeOf(runs[next]!.from));
    });
  }

  compare(): void {
    this.viewer.playback.compare(!this.viewer.playback.comparison.wanted);
  }

  /** A chart was opened or closed. A small window has space for one. */
  private toggled(other: Chart | PerformanceChart): void {
    if (SMALL.matches && this.chart.isOpen && this.performance.isOpen) other.toggle();
    this.follow();
  }

  private get player() {
    return this.viewer.playback.player;
  }

  private list(): void {
    const { clips } = this.player;
    setHidden(this.panel, clips.length === 0, this.viewer.canvas);
    fill(this.choice, ...clips.map((clip, at) => h("option", {}, this.describe(clip, at))));
    this.shown = null;
    this.toggled(this.chart);
  }

  /** A short description of a clip. */
  private describe(clip: AnimationClip, at: number): string {
    const figures = this.viewer.playback.exposures.of(clip);
    const keys = this.player.keysIn(clip);
    const [only] = figures;
    const words = [clip.name || `clip ${at + 1}`, `${clip.duration.toFixed(1)} s`];
    if (figures.length > 1) words.push(`${figures.length} figures`);
    else if (only?.facts.limited || (!only && keys.held)) words.push(drawings(only?.facts.drawings ?? keys.times.length));
    return words.join(" · ");
  }

  private follow(): void {
    const { clip, keys, time, end, playing, loops } = this.player;
    if (!clip) return;
    const { exposures, comparison } = this.viewer.playback;
    const exposure = exposures.current;
    const seconds = this.longest(end);
    if (this.shown !== clip || this.exposure !== exposure || this.axis.seconds !== seconds) {
      this.shown = clip;
      this.exposure = exposure;
      this.axis.seconds = seconds;
      this.choice.selectedIndex = this.player.clips.indexOf(clip);
      this.slider.max = String(seconds);
      for (const chart of [this.chart, this.performance]) if (chart.isOpen) chart.draw();
      const figures = this.viewer.playback.exposures.of(clip).map(({ facts }) => facts.figure);
      this.figure.hidden = figures.length < 2;
      fill(this.figure, ...figures.map((name) => h("option", { attributes: { value: name } }, name)));
      if (exposure) this.figure.value = exposure.facts.figure;
      this.draw(clip, keys.times, keys.held);
    }
    this.slider.value = String(time);
    const words = this.words(time);
    this.readout.textContent = words;
    this.readout.title = `${time.toFixed(2)} s of ${end.toFixed(2)} s`;
    this.slider.setAttribute("aria-valuetext", words);
    const box = this.boxes[this.boxes.findLastIndex(({ from }) => from <= time + 1e-4)];
    this.now.setAttribute("d", box ? outline(box, seconds) : "");
    this.element.dataset["playing"] = String(playing);
    this.loop.setAttribute("aria-pressed", String(loops));
    this.along.setAttribute("aria-pressed", String(this.viewer.playback.travel.wanted));
    this.onion.setAttribute("aria-pressed", String(this.viewer.playback.onionSkin.wanted));
    this.films.hidden = !this.viewer.playback.isFilmable;
    this.films.setAttribute("aria-pressed", String(this.viewer.playback.isFilming));
    this.charts.hidden = !this.chart.isPossible;
    this.charts.setAttribute("aria-pressed", String(this.chart.isOpen));
    this.performances.hidden = !this.performance.isPossible;
    this.performances.setAttribute("aria-pressed", String(this.performance.isOpen));
    this.compares.hidden = !comparison.isPossible;
    this.compares.setAttribute("aria-pressed", String(comparison.wanted));
    this.compares.setAttribute("aria-busy", String(comparison.isComing));
    const compares = this.viewer.playback.exposures.performed ? "Performed and original side by side" : "Full and limited side by side";
    if (this.compares.getAttribute("aria-label") !== compares) {
      this.compares.setAttribute("aria-label", compares);
      this.compares.title = `${compares} (O)`;
    }
    if (this.play.dataset["playing"] !== String(playing)) {
      this.play.dataset["playing"] = String(playing);
      this.play.setAttribute("aria-label", playing ? "Pause" : "Play");
      this.play.title = playing ? "Pause (Space)" : "Play (Space)";
      fill(this.play, icon(playing ? Pause : Play));
    }
  }

  /** The length of the axis of time in seconds: the clip's, unless there is a longer chart. */
  private longest(end: number): number {
    const { current: exposure, performed } = this.viewer.playback.exposures;
    const sources = this.chart.isOpen && exposure ? exposure.sources / exposure.fps : 0;
    const facts = this.performance.isOpen ? performed?.facts.performance : undefined;
    const rows = facts && performed ? Math.max(facts.frames.performance, facts.frames.motion) / performed.fps : 0;
    // A file has times in single precision: a difference of less than a frame is none.
    return Math.max(sources, rows) > end * (1 + 1e-3) ? Math.max(sources, rows) : end;
  }

  /** The position in the clip, in words. */
  private words(time: number): string {
    const { clip, keys } = this.player;
    const exposure = this.viewer.playback.exposures.current;
    const seconds = `${time.toFixed(2)} s`;
    if (exposure) {
      const frame = exposure.frameAt(time);
      const words = [`frame ${frame + 1} of ${exposure.frames}`, seconds];
      return (exposure.runs.length > 0 ? [`drawing ${exposure.drawingIn(frame) + 1} of ${exposure.runs.length}`, ...words] : words).join(" · ");
    }
    return keys.held ? `drawing ${drawingAt(keys, time)} of ${keys.times.length} · ${seconds}` : `${time.toFixed(2)} of ${clip?.duration.toFixed(2)} s`;
  }

  /** Draws a tick for each key, or a box for each held drawing. */
  private draw(clip: AnimationClip, times: readonly number[], held: boolean): void {
    const exposure = this.viewer.playback.exposures.current;
    const { duration } = clip;
    const { seconds } = this.axis;
    if (exposure && exposure.runs.length > 0) this.boxes = exposure.runs.map(({ start, frames }) => ({ from: start / exposure.fps, to: Math.min((start + frames) / exposure.fps, duration) }));
    else this.boxes = held ? times.map((from, at) => ({ from, to: times[at + 1] ?? duration })) : [];
    const every = Math.ceil((this.boxes.length || times.length) / MAX_TICKS);
    const drawn =
      this.boxes.length > 0
        ? this.boxes.filter((_, at) => at % every === 0).map((box) => outline(box, seconds))
        : times.filter((_, at) => at % every === 0).map((time) => `M${across(time, seconds)} 2V8`);
    this.ticks.dataset["keys"] = String(this.boxes.length || times.length);
    fill(this.ticks, svg("path", { class: this.boxes.length > 0 ? "held" : "keys", d: drawn.join("") }), this.now);
  }
}

const drawings = (number: number): string => `${number} ${number === 1 ? "drawing" : "drawings"}`;

/** The position of a time on the timeline, in thousandths. */
const across = (time: number, duration: number): number => (duration > 0 ? Math.round((time / duration) * 1e5) / 100 : 0);

/** A box on the timeline, with a gap before the next. */
function outline({ from, to }: Box, duration: number): string {
  const left = across(from, duration);
  return `M${left} 0H${Math.max(across(to, duration) - 2, left + 0.5)}V10H${left}Z`;
}
