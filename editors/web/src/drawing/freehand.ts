// A line that is drawn by hand, as the smooth border of a shape.

import { createTangent, fitCubic } from "fit-curve";
import type { Point } from "../protocol";

/** What is smaller than this both ways is a slip of the hand, in pixels. */
const LEAST = 8;
/** How far the border may lie from what was drawn, in pixels: less than hands tremble. */
const OFF = 2;
/** Points that are closer than this say nothing about the border, in pixels. */
const APART = 1.5;
/** If the ends are closer than this share of the line's length, the border goes on smoothly from one to the other. */
const MEETS = 0.12;
/** From how many points away a direction is taken. */
const REACH = 3;

type Pair = [number, number];

/** The path data of the shape inside of a line; `unit` is the length of a pixel. Null if the line is too small to be one. */
export function freehand(points: readonly Point[], unit: number): string | null {
  const kept = apart(points, APART * unit);
  const size = (of: (point: Pair) => number): number => Math.max(...kept.map(of)) - Math.min(...kept.map(of));
  if (kept.length < 3 || Math.max(size(([x]) => x), size(([, y]) => y)) < LEAST * unit) return null;
  const [first, last] = [kept[0]!, kept.at(-1)!];
  const length = kept.reduce((sum, point, at) => sum + (at === 0 ? 0 : between(point, kept[at - 1]!)), 0);
  const isClosed = between(first, last) < Math.max(MEETS * length, LEAST * unit);
  const line = isClosed ? [...kept, first] : kept;
  const reach = Math.min(REACH, Math.floor((kept.length - 1) / 2));
  // A border without ends has one direction where the line began and ended.
  const seam = createTangent(kept[reach]!, kept.at(-reach)!);
  const [left, right]: [Pair, Pair] = isClosed ? [seam, [-seam[0], -seam[1]]] : [createTangent(line[reach]!, first), createTangent(line.at(-1 - reach)!, last)];
  const curves = fitCubic(line, left, right, (OFF * unit) ** 2);
  const place = ([x, y]: Pair): string => `${number(x)} ${number(y)}`;
  return `M ${place(first)} ${curves.map(([, one, other, end]) => `C ${place(one)} ${place(other)} ${place(end)}`).join(" ")} Z`;
}

/** The points of a line that are so far apart. */
function apart(points: readonly Point[], distance: number): Pair[] {
  const kept: Pair[] = [];
  for (const { x, y } of points) {
    const last = kept.at(-1);
    if (!last || between(last, [x, y]) >= distance) kept.push([x, y]);
  }
  return kept;
}

const between = ([a, b]: Pair, [c, d]: Pair): number => Math.hypot(a - c, b - d);

/** More digits than the program keeps, and no powers of ten. */
export const number = (value: number): string => String(Number(value.toFixed(6)));
