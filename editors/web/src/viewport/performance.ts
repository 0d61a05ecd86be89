// The times of a performed clip: which frame of the motion is shown in which frame of the performance, and how its curves are drawn.

import type { PerformanceFacts } from "../protocol";
import { peaks } from "./exposure-sheet";

/** The curves above are those of the performance, the ones below those of the motion. */
export type Row = "performance" | "motion";

/** Where two rows of curves are, in pixels. Both have the same scale of time. */
export interface Rows {
  readonly left: number;
  readonly right: number;
  /** The heights of 1 and of 0 in each row. */
  readonly performance: readonly [top: number, bottom: number];
  readonly motion: readonly [top: number, bottom: number];
}

export class PerformanceTimes {
  /** The number of frames of the longer of the two. */
  readonly frames: number;

  constructor(readonly facts: PerformanceFacts) {
    this.frames = Math.max(facts.frames.performance, facts.frames.motion, 2);
  }

  /** The frame of the motion in a frame of the performance, which may lie between two. */
  motionAt(frame: number): number {
    return interpolate(this.facts.timing, frame, 0);
  }

  /** The first frame of the performance in which a frame of the motion is shown, which may lie between two. */
  performanceAt(frame: number): number {
    return interpolate(this.facts.timing, frame, 1);
  }

  /** The frame of a row that stands in a frame of the performance. */
  inRow(row: Row, frame: number): number {
    return row === "motion" ? this.motionAt(frame) : frame;
  }

  /** The x coordinate of a frame, in pixels. */
  at(frame: number, { left, right }: Rows): number {
    return left + ((right - left) * frame) / (this.frames - 1);
  }

  /** The frame of a row at an x coordinate. */
  frameAt(row: Row, x: number, { left, right }: Rows): number {
    const frame = Math.round(((x - left) / (right - left)) * (this.frames - 1));
    return Math.min(Math.max(frame, 0), Math.max(this.facts.frames[row] - 1, 0));
  }

  /** How much a mark, or its joint, moves in a frame: 0 to 1, or null beyond the end. */
  ratio(row: Row, mark: number, frame: number): number | null {
    const [curves, step] = row === "motion" ? [this.facts.motion, this.facts.motionStep] : [this.facts.input, this.facts.inputStep];
    return curves[mark]?.[Math.floor(frame / step)] ?? null;
  }

  /** The curve of a mark or of its joint, as points in pixels. */
  curve(row: Row, mark: number, rows: Rows): readonly (readonly [x: number, y: number])[] {
    const [curves, step] = row === "motion" ? [this.facts.motion, this.facts.motionStep] : [this.facts.input, this.facts.inputStep];
    const [top, bottom] = rows[row];
    const thinned = peaks(curves[mark] ?? [], rows.right - rows.left);
    const width = thinned.step * step;
    const last = this.facts.frames[row] - 1;
    return thinned.values.map((value, at) => [this.at(Math.min(at * width + (width - 1) / 2, last), rows), bottom - (bottom - top) * value]);
  }

  /** Per point of the timing the line that connects its two frames, between the rows; the key is marked. */
  links(rows: Rows): readonly { readonly from: readonly [number, number]; readonly to: readonly [number, number]; readonly isKey: boolean }[] {
    const { keys, timing } = this.facts;
    return timing.map(([performance, motion]) => ({
      from: [this.at(performance, rows), rows.performance[1]],
      to: [this.at(motion, rows), rows.motion[0]],
      isKey: performance === keys?.performance && motion === keys.motion,
    }));
  }
}

/** What a performance does to the timing, in words. */
export function describeTiming({ keys, shown, timed, frames }: PerformanceFacts): string {
  if (!keys || !timed) return "the motion keeps its timing";
  const stands = `frame ${keys.motion + 1} of the motion stands in frame ${keys.performance + 1} of ${frames.performance}`;
  return shown === null || shown === keys.performance ? stands : `${stands}, shown in frame ${shown + 1}`;
}

/** How it is filmed, in words. */
export function describeFilming({ filming, nearest }: PerformanceFacts): string {
  if (filming === "none" || nearest === null) return "not filmed";
  return filming === "camera" ? `filmed by a camera that is nearest in frame ${nearest + 1}` : `filmed by moving the figure, which is nearest to the viewer in frame ${nearest + 1}`;
}

/** What a mark does to its parts, in words. */
export function describeEffect({ emphasized, damped }: PerformanceFacts["marks"][number]): string {
  return emphasized ? "emphasised" : damped ? "damped" : "not damped";
}

/** The value on one side of a polyline through points with ascending coordinates, for a value on the other side. Without points both are equal. */
function interpolate(points: PerformanceFacts["timing"], value: number, side: 0 | 1): number {
  const [first, last] = [points[0], points.at(-1)];
  if (!first || !last) return value;
  const other = side === 0 ? 1 : 0;
  if (value <= first[side]) return first[other];
  for (let at = 1; at < points.length; at++) {
    const [a, b] = [points[at - 1]!, points[at]!];
    if (value <= b[side]) return a[other] + ((b[other] - a[other]) * (value - a[side])) / (b[side] - a[side]);
  }
  return last[other];
}
