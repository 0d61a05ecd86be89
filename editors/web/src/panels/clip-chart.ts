// What the charts of a clip have in common: they open and close, follow the clip, and a frame can be pointed at and dragged to.

import { h, setHidden, svg } from "../dom";
import type { ExposureSheet } from "../viewport/exposure-sheet";
import type { Viewer } from "../viewport/viewer";
import { isRemembered, remember } from "./remembered";

/** A kind of chart. */
export interface ChartKind {
  /** Its name for screen readers. */
  readonly label: string;
  /** The class of its element, and that of its picture. */
  readonly classes: readonly [string, string];
  /** The key under which the browser stores whether it is open. */
  readonly remembered: string;
}

export abstract class ClipChart {
  readonly element: HTMLElement;
  protected readonly summary = h("p", { class: "chart-summary" });
  protected readonly file = h("span", { class: "chart-file muted" });
  protected readonly picture: SVGSVGElement;
  protected readonly tip = h("p", { class: "chart-tip", hidden: true });
  /** The frame that is pointed at. */
  protected readonly line = svg("path", { class: "chart-hover" });
  /** What the picture shows. */
  protected drawn: ExposureSheet | null = null;
  private drags = false;
  private wanted: boolean;

  /** `changed` is called when the chart is opened or closed. */
  protected constructor(protected readonly viewer: Viewer, private readonly changed: () => void, private readonly kind: ChartKind) {
    this.wanted = isRemembered(kind.remembered);
    this.element = h("section", { class: kind.classes[0], hidden: true, attributes: { "aria-label": kind.label } });
    this.picture = svg("svg", { class: kind.classes[1], role: "img" });
    new ResizeObserver(() => this.draw()).observe(this.picture);
    this.picture.addEventListener("pointermove", (event) => this.over(event));
    this.picture.addEventListener("pointerleave", () => this.leave());
    this.picture.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.drags = true;
      this.picture.setPointerCapture(event.pointerId);
      this.over(event);
      event.preventDefault();
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      this.picture.addEventListener(end, (event) => {
        this.drags = false;
        if (event.pointerType !== "mouse") this.leave();
      });
    }
    viewer.on(["model", "time"], () => this.follow());
  }

  /** What there is to draw now. */
  protected abstract get sheet(): ExposureSheet | null;

  /** Whether there is anything to draw. */
  abstract get isPossible(): boolean;

  /** Draws all of it. */
  abstract draw(): void;

  /** Moves the playhead to the time of the clip. */
  protected abstract move(): void;

  /** Shows the frame at a place, and goes there while the pointer drags. */
  protected abstract over(event: PointerEvent): void;

  get isOpen(): boolean {
    return this.wanted && this.isPossible;
  }

  toggle(): void {
    if (!this.isPossible) return;
    this.wanted = !this.wanted;
    remember(this.kind.remembered, this.wanted);
    this.follow();
    this.changed();
  }

  private follow(): void {
    setHidden(this.element, !this.isOpen, this.viewer.canvas);
    if (!this.isOpen) return;
    if (this.sheet !== this.drawn) this.draw();
    this.move();
  }

  /** Goes to a time in seconds while the pointer drags. */
  protected dragTo(time: number): void {
    if (!this.drags) return;
    this.viewer.playback.moved(() => {
      this.viewer.playback.player.play(false);
      this.viewer.playback.player.seek(time);
    });
  }

  /** Shows words beside the line at x, on the side with enough space. */
  protected tell(words: readonly string[], x: number, width: number): void {
    this.tip.textContent = words.join(" · ");
    this.tip.hidden = false;
    const wide = this.tip.offsetWidth;
    this.tip.style.transform = `translateX(${x + 10 + wide < width ? x + 10 : Math.max(x - 10 - wide, 0)}px)`;
  }

  private leave(): void {
    if (this.drags) return;
    this.tip.hidden = true;
    this.line.setAttribute("d", "");
  }
}
