// The curves of a recorded track: x and y of each mark over time.

import { fill, svg } from "../dom";
import { trailPath, type Place } from "./overlay";
import type { Track } from "./messages";

/** The size of the drawing's coordinates; it is stretched to its place. */
const WIDTH = 1000;
const HEIGHT = 100;

export class Curves {
  readonly element = svg("svg", { class: "camera-curves", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", role: "img" });
  private readonly now = svg("path", { class: "camera-now" });

  /** `chosen` is called with a time in seconds that was clicked. */
  constructor(chosen: (seconds: number) => void) {
    const seek = (event: PointerEvent): void => {
      const { left, width } = this.element.getBoundingClientRect();
      chosen(Math.min(Math.max((event.clientX - left) / width, 0), 1) * this.seconds);
    };
    this.element.addEventListener("pointerdown", (event) => {
      this.element.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.element.addEventListener("pointermove", (event) => this.element.hasPointerCapture(event.pointerId) && seek(event));
  }

  private seconds = 0;

  show(track: Track): void {
    this.seconds = track.times.at(-1) ?? 0;
    this.element.setAttribute("aria-label", `x and y of ${track.marks.map(({ name }) => name).join(", ")} over ${this.seconds.toFixed(1)} seconds`);
    fill(
      this.element,
      ...track.marks.flatMap((mark) =>
        ([0, 1] as const).map((axis) => svg("path", { d: trailPath(curve(track, mark, axis)), class: axis === 0 ? "camera-curve" : "camera-curve of-y", stroke: mark.color })),
      ),
      this.now,
    );
  }

  /** Shows the current time in seconds. */
  move(seconds: number): void {
    const x = this.seconds > 0 ? (seconds / this.seconds) * WIDTH : 0;
    this.now.setAttribute("d", `M${x.toFixed(1)} 0V${HEIGHT}`);
  }
}

/** A coordinate of a mark over time, as a line on the chart. */
export function curve({ size, times }: Pick<Track, "size" | "times">, { points, isLost }: Pick<Track["marks"][number], "points" | "isLost">, axis: 0 | 1): Place[] {
  const seconds = times.at(-1) || 1;
  return points.map((point, frame) => (isLost[frame] ? null : [(times[frame]! / seconds) * WIDTH, (point[axis] / size[axis]) * HEIGHT]));
}
