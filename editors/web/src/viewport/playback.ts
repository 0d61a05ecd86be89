// The clip that is shown: its time, the original beside it, the drawings around it, and what the view does meanwhile.

import type { PerspectiveCamera } from "three";
import { prefersReducedMotion } from "../dom";
import { Player, drawingAt } from "./clips";
import { Comparison, type ComparisonHost } from "./comparison";
import type { ViewerEvents } from "./events";
import { Exposures } from "./exposures";
import type { Wanted } from "./loading";
import type { Model } from "./model";
import { OnionSkin } from "./onion-skin";
import type { Pose } from "./pose";
import type { RenderLoop } from "./render-loop";
import { SideBySide } from "./side-by-side";
import { Travel } from "./travel";
import type { View } from "./view";

/** What plays. */
interface Shown {
  readonly model: Model | null;
  readonly pose: Pose;
  /** The names of the hidden parts. */
  readonly hidden: ReadonlySet<string>;
}

export class Playback {
  readonly player = new Player();
  readonly exposures = new Exposures(this.player);
  readonly sideBySide: SideBySide;
  readonly comparison: Comparison;
  readonly travel = new Travel();
  readonly onionSkin: OnionSkin;
  /** Whether the page looks through the cameras of clips. */
  private films = false;

  constructor(private readonly shown: Shown, readonly view: View, private readonly renderLoop: RenderLoop, private readonly events: ViewerEvents, comparisonHost: ComparisonHost) {
    this.sideBySide = new SideBySide(renderLoop.scene);
    this.onionSkin = new OnionSkin(renderLoop.scene, this);
    this.comparison = new Comparison(this.sideBySide, this, comparisonHost);
    view.leftFilm = () => {
      this.films = false;
      events.notify("time");
    };
    events.on(["time", "model"], () => this.followOnionSkin());
  }

  get model(): Model | null {
    return this.shown.model;
  }

  /** Limbs turned by hand, on top of the clip. */
  get pose(): Pose {
    return this.shown.pose;
  }

  /** Continues in a model that replaces the last one. */
  take(model: Model, clips: Wanted["clips"]): void {
    this.exposures.take(clips);
    // A performed clip is what the drawing is about; the motion that it was made of may stand before it.
    this.player.take(model, !prefersReducedMotion(), (clip) => this.exposures.of(clip).some(({ facts }) => facts.performance !== null));
    this.pose.apply();
  }

  /** The model changes in place: gives all nodes back what the clip moved, until it is taken. */
  release(): void {
    this.player.release();
    this.onionSkin.clear();
  }

  /** The model was removed. */
  clear(): void {
    this.player.clear();
    this.goAlong();
  }

  /** The user stopped, started or moved the clip. */
  moved(change: () => void): void {
    this.pose.release();
    change();
    this.comparison.follow();
    this.goAlong();
    this.pose.apply();
    this.renderLoop.moved();
    this.events.notify("time");
  }

  /** Called before each frame with the seconds since the last one. True while the clip plays. */
  step(seconds: number): boolean {
    if (!this.player.playing) return false;
    const { keys, time } = this.player;
    this.pose.release();
    const more = this.player.advance(seconds);
    this.comparison.follow();
    this.goAlong();
    this.pose.apply();
    // A held drawing is not drawn again.
    if (this.sideBySide.copy || !keys.held || drawingAt(keys, time) !== drawingAt(keys, this.player.time)) this.renderLoop.moved();
    this.events.notify("time");
    return more;
  }

  /** Counts the drawings of a figure, if a clip moves several. */
  chooseFigure(figure: string): void {
    this.exposures.choose(figure);
    this.events.notify("time");
  }

  /** Switches the comparison with the original clip on or off. */
  compare(on: boolean): void {
    this.comparison.want(on);
    this.events.notify("sideBySide");
  }

  /** Shows the drawings before and after that of a paused clip, or no longer. */
  showOnionSkin(on: boolean): void {
    this.onionSkin.wanted = on;
    this.events.notify("time");
  }

  followOnionSkin(): void {
    if (this.onionSkin.follow(this.shown.hidden)) this.renderLoop.invalidate();
    this.renderLoop.canvas.dataset["onionSkin"] = String(this.onionSkin.count);
  }

  /** Lets the view go along with a figure that travels, or no longer. */
  followTravel(on: boolean): void {
    this.travel.wanted = on;
    this.travel.restart();
    this.goAlong();
    this.events.notify("time");
  }

  /** The camera that films the clip. */
  private get clipCamera(): PerspectiveCamera | null {
    const { clip } = this.player;
    return (clip && this.model?.cameraOf(clip)) ?? null;
  }

  /** Whether a camera films the clip. */
  get isFilmable(): boolean {
    return this.clipCamera !== null;
  }

  /** Whether the page looks through the camera of the clip. */
  get isFilming(): boolean {
    return this.films && this.isFilmable;
  }

  /** Looks through the cameras of clips, or no longer. */
  film(on: boolean): void {
    this.films = on;
    this.travel.restart();
    this.goAlong();
    this.events.notify("time");
  }

  /** Moves the view with the clip's camera, or with a figure that travels. */
  goAlong(): void {
    const camera = this.films ? this.clipCamera : null;
    this.view.film(camera);
    if (!camera && this.travel.wanted) this.view.shift(this.travel.since(this.model, this.player.clip));
  }
}
