// The clips' bar: which plays, where in it one is, how fast.

import { Pause, Play, Repeat, SkipBack, SkipForward } from "lucide";
import { button, fill, h, icon } from "../dom";
import { drawingAt } from "../stage/clips";
import type { Viewer } from "../stage/viewer";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2];
/** More ticks than this cannot be told apart. */
const MOST_TICKS = 600;
const SPACE = "http://www.w3.org/2000/svg";

export class Clips {
  readonly element = h("section", { class: "clips", hidden: true, attributes: { "aria-label": "Clips" } });
  private readonly choice = h("select", { class: "select", attributes: { "aria-label": "Clip" } });
  private readonly play = button({ icon: Play, label: "Play", key: "Space", press: () => this.toggle() });
  private readonly slider = h("input", { class: "slider", attributes: { type: "range", min: 0, step: 0.001, "aria-label": "Time" } });
  private readonly ticks = document.createElementNS(SPACE, "svg");
  private readonly readout = h("output", { class: "readout" });
  private readonly speed = h("select", { class: "select", attributes: { "aria-label": "Speed" } }, ...SPEEDS.map((speed) => h("option", { attributes: { value: speed } }, `${speed}×`)));
  private readonly loop = button({ icon: Repeat, label: "Play again and again", press: () => this.viewer.moved(() => (this.player.loops = !this.player.loops)) });
  private shown: unknown = null;

  constructor(private readonly viewer: Viewer) {
    this.ticks.setAttribute("class", "ticks");
    this.ticks.setAttribute("viewBox", "0 0 1000 10");
    this.ticks.setAttribute("preserveAspectRatio", "none");
    this.ticks.setAttribute("aria-hidden", "true");
    fill(
      this.element,
      this.choice,
      button({ icon: SkipBack, label: "Key before", key: "J", press: () => this.step(-1) }),
      this.play,
      button({ icon: SkipForward, label: "Next key", key: "K", press: () => this.step(1) }),
      h("div", { class: "timeline" }, this.ticks, this.slider),
      this.readout,
      this.speed,
      this.loop,
    );
    this.speed.value = "1";
    this.choice.addEventListener("change", () => {
      const clip = this.player.clips[this.choice.selectedIndex];
      if (clip) viewer.moved(() => this.player.choose(clip));
    });
    this.speed.addEventListener("change", () => (this.player.speed = Number(this.speed.value)));
    this.slider.addEventListener("input", () =>
      viewer.moved(() => {
        this.player.play(false);
        this.player.seek(Number(this.slider.value));
      }),
    );
    viewer.on(["model"], () => this.list());
    viewer.on(["time"], () => this.follow());
  }

  toggle(): void {
    this.viewer.moved(() => this.player.play(!this.player.playing));
  }

  step(keys: 1 | -1): void {
    if (this.player.clip) this.viewer.moved(() => this.player.step(keys));
  }

  private get player() {
    return this.viewer.player;
  }

  private list(): void {
    const { clips } = this.player;
    this.element.hidden = clips.length === 0;
    fill(this.choice, ...clips.map(({ name }, at) => h("option", {}, name || `clip ${at + 1}`)));
    this.shown = null;
    this.follow();
  }

  private follow(): void {
    const { clip, keys, time, playing, loops } = this.player;
    if (!clip) return;
    if (this.shown !== clip) {
      this.shown = clip;
      this.choice.selectedIndex = this.player.clips.indexOf(clip);
      this.slider.max = String(clip.duration);
      this.draw(keys.times, clip.duration, keys.held);
    }
    this.slider.value = String(time);
    const seconds = `${time.toFixed(2)} s of ${clip.duration.toFixed(2)} s`;
    const words = keys.held ? `drawing ${drawingAt(keys, time)} of ${keys.times.length}` : seconds;
    this.readout.textContent = words;
    this.readout.title = seconds;
    this.slider.setAttribute("aria-valuetext", words);
    this.element.dataset["playing"] = String(playing);
    this.loop.setAttribute("aria-pressed", String(loops));
    if (this.play.dataset["playing"] !== String(playing)) {
      this.play.dataset["playing"] = String(playing);
      this.play.setAttribute("aria-label", playing ? "Pause" : "Play");
      this.play.title = playing ? "Pause (Space)" : "Play (Space)";
      fill(this.play, icon(playing ? Pause : Play));
    }
  }

  /** A tick at each key; drawings that are held are boxes. */
  private draw(times: readonly number[], duration: number, held: boolean): void {
    const every = Math.ceil(times.length / MOST_TICKS);
    const at = (time: number): number => (duration > 0 ? (time / duration) * 1000 : 0);
    const path = document.createElementNS(SPACE, "path");
    const starts = times.filter((_, index) => index % every === 0).map(at);
    path.setAttribute("d", starts.map((x, index) => (held ? `M${x} 0H${Math.max((starts[index + 1] ?? 1000) - 2, x + 0.5)}V10H${x}Z` : `M${x} 0V10`)).join(""));
    path.setAttribute("class", held ? "held" : "keys");
    this.ticks.dataset["keys"] = String(times.length);
    fill(this.ticks, path);
  }
}
