// A recording shown again: its pictures with the track, a slider, curves, and how to use it.

import { Play, Pause } from "lucide";
import { button, count, fill, h, icon } from "../dom";
import { Curves } from "./curves";
import { readTrack, type Track, type TrackedMark } from "./messages";
import type { Overlay, Place } from "./overlay";
import { nearest, type Pictures } from "./pictures";
import { fileName, strings } from "./strings";

/** The radius of rings around marks, as a part of the picture's width: the track has no sizes. */
const RADIUS = 0.025;

export class Replay {
  readonly element = h("section", { class: "camera-replay", hidden: true, attributes: { "aria-label": "Recording" } });
  private readonly play = button({ icon: Play, label: "Play", press: () => this.toggle() });
  private readonly slider = h("input", { class: "slider", attributes: { type: "range", min: 0, step: 1, "aria-label": "Frame" } });
  private readonly readout = h("p", { class: "camera-readout" });
  private readonly curves = new Curves((seconds) => this.go(nearest(this.track?.times ?? [], seconds)));
  private readonly file = h("input", { class: "camera-file", attributes: { type: "text", value: "hands.json", maxlength: 80, spellcheck: "false", autocomplete: "off" } });
  private readonly help = h("div", { class: "camera-help" });
  private track: Track | null = null;
  private text = "";
  private frame = 0;
  /** The animation frame that is asked for while the recording plays. */
  private running = 0;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly overlay: Overlay, private readonly pictures: Pictures, save: (name: string, text: string) => void, again: () => void) {
    this.slider.addEventListener("input", () => {
      this.pause();
      this.go(Number(this.slider.value));
    });
    this.file.addEventListener("input", () => this.explain());
    fill(
      this.element,
      h("div", { class: "camera-transport" }, this.play, this.slider),
      this.readout,
      h("div", { class: "camera-curves-place" }, this.curves.element),
      h("p", { class: "muted" }, "Solid: x. Dashed: y. Gaps: the mark was lost, or something else could be it."),
      h(
        "div",
        { class: "camera-row" },
        h("label", { class: "camera-label" }, "File ", this.file),
        button({ label: "Save", wide: true, class: "primary", press: () => save(fileName(this.file.value), this.text) }),
        button({ label: "Again", wide: true, press: again }),
      ),
      this.help,
    );
  }

  /** Shows a track, given as its file; at its beginning unless it was shown already. */
  show(text: string): Track {
    this.text = text;
    const isSame = this.track !== null;
    this.track = readTrack(text);
    this.slider.max = String(this.track.times.length - 1);
    this.curves.show(this.track);
    this.element.hidden = false;
    this.explain();
    this.go(isSame ? this.frame : 0);
    return this.track;
  }

  close(): void {
    this.pause();
    this.track = null;
    this.element.hidden = true;
  }

  /** In how many frames each mark is lost, in words. */
  states(): string[] {
    const frames = this.track?.times.length ?? 0;
    return (this.track?.marks ?? []).map(({ isLost, isAmbiguous }) => {
      const ambiguous = isAmbiguous.filter(Boolean).length;
      const lost = isLost.filter(Boolean).length - ambiguous;
      if (lost + ambiguous === 0) return "always seen";
      const parts = [lost > 0 ? `lost in ${lost}` : "", ambiguous > 0 ? `ambiguous in ${ambiguous}` : ""];
      return `${parts.filter(Boolean).join(", ")} of ${count(frames, "frame")}`;
    });
  }

  private toggle(): void {
    if (this.running) return this.pause();
    const { track } = this;
    if (!track) return;
    if (this.frame >= track.times.length - 1) this.go(0);
    const offset = track.times[this.frame]! * 1000 - performance.now();
    const step = (): void => {
      const seconds = (performance.now() + offset) / 1000;
      this.go(nearest(track.times, seconds));
      if (seconds >= (track.times.at(-1) ?? 0)) this.pause();
      else this.running = requestAnimationFrame(step);
    };
    this.running = requestAnimationFrame(step);
    this.label();
  }

  private pause(): void {
    cancelAnimationFrame(this.running);
    this.running = 0;
    this.label();
  }

  private label(): void {
    const label = this.running ? "Pause" : "Play";
    this.play.title = label;
    this.play.setAttribute("aria-label", label);
    fill(this.play, icon(this.running ? Pause : Play));
  }

  private go(frame: number): void {
    const { track } = this;
    if (!track) return;
    this.frame = Math.min(Math.max(frame, 0), track.times.length - 1);
    const seconds = track.times[this.frame] ?? 0;
    const [width, height] = track.size;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    void this.pictures.show(seconds, this.canvas);
    this.overlay.resize(width, height);
    this.overlay.showRings(
      track.marks.map((mark) => {
        const [x, y] = mark.points[this.frame] ?? [0, 0];
        return { mark, at: { x, y, radius: RADIUS * width }, isLost: mark.isLost[this.frame] === true, isAmbiguous: mark.isAmbiguous[this.frame] === true };
      }),
    );
    this.overlay.showTrails(track.marks.map((mark) => ({ mark, places: mark.points.slice(0, this.frame + 1).map((place, at): Place => (mark.isLost[at] ? null : place)) })));
    const named = (label: string, is: (mark: TrackedMark) => boolean): string => {
      const names = track.marks.filter(is).map(({ name }) => name);
      return names.length > 0 ? ` · ${label}: ${names.join(", ")}` : "";
    };
    const isAmbiguous = (mark: TrackedMark): boolean => mark.isAmbiguous[this.frame] === true;
    const lost = named("lost", (mark) => mark.isLost[this.frame] === true && !isAmbiguous(mark));
    const text = `Frame ${this.frame + 1} of ${track.times.length} · ${seconds.toFixed(2)} s${lost}${named("ambiguous", isAmbiguous)}`;
    this.readout.textContent = text;
    this.slider.value = String(this.frame);
    this.slider.setAttribute("aria-valuetext", text);
    this.curves.move(seconds);
  }

  /** Which strings the drawing needs. */
  private explain(): void {
    if (!this.track) return;
    const { perform, marks } = strings(fileName(this.file.value), this.track.marks, (name) => CSS.supports("color", name));
    const code = (text: string): HTMLElement => h("code", {}, text);
    fill(
      this.help,
      h("p", {}, "Put the saved file beside the drawing, and write ", code(perform), " into a string behind its ", code("Motion"), "."),
      h("p", {}, "The parts that the marks perform have ", ...marks.flatMap((mark, at) => [at === 0 ? "" : ", ", code(mark)]), "."),
    );
  }
}
