// Lines that are drawn by hand, as borders of shapes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { freehand } from "../src/drawing/freehand";

interface Place {
  readonly x: number;
  readonly y: number;
}

/** A line around a point, as a hand draws it that trembles by up to a pixel. */
function around(radius: (angle: number) => number, from = 0, to = 2 * Math.PI, unit = 1): Place[] {
  const count = 140;
  let seed = 7;
  const trembling = (): number => {
    seed = (seed * 16807) % 2147483647;
    return (2 * seed) / 2147483647 - 1;
  };
  return Array.from({ length: count }, (_, at) => {
    const angle = from + ((to - from) * at) / (count - 1);
    const r = radius(angle);
    return { x: unit * (300 + r * Math.cos(angle) + trembling()), y: unit * (200 + r * Math.sin(angle) + trembling()) };
  });
}

/** The curves of path data, each with four points. */
function curvesOf(path: string): Place[][] {
  assert.match(path, /^M [-\d. ]+( C [-\d. ]+)+ Z$/);
  const numbers = (path.match(/-?[\d.]+/g) ?? []).map(Number);
  const points = Array.from({ length: numbers.length / 2 }, (_, at) => ({ x: numbers[2 * at]!, y: numbers[2 * at + 1]! }));
  return Array.from({ length: (points.length - 1) / 3 }, (_, at) => points.slice(3 * at, 3 * at + 4));
}

function along([a, b, c, d]: readonly Place[], t: number): Place {
  const mix = (of: (place: Place) => number): number => (1 - t) ** 3 * of(a!) + 3 * (1 - t) ** 2 * t * of(b!) + 3 * (1 - t) * t ** 2 * of(c!) + t ** 3 * of(d!);
  return { x: mix(({ x }) => x), y: mix(({ y }) => y) };
}

for (const [name, radius] of [["a disc", () => 100], ["a bean", (angle: number) => 100 + 25 * Math.sin(2 * angle)], ["a cloud", (angle: number) => 90 + 14 * Math.sin(5 * angle)]] as const) {
  test(`${name} of 200 pixels has few nodes, and its border is where it was drawn`, () => {
    for (const unit of [1, 0.02, 40]) {
      const points = around(radius, 0.4, 0.4 + 2 * Math.PI - 0.06, unit);
      const curves = curvesOf(freehand(points, unit)!);
        assert.ok(curves.length >= 4 && curves.length <= 20, `${curves.length} nodes`);
      const border = curves.flatMap((curve) => Array.from({ length: 40 }, (_, at) => along(curve, at / 40)));
      for (const { x, y } of points) {
        const off = Math.min(...border.map((place) => Math.hypot(place.x - x, place.y - y)));
        assert.ok(off < 5 * unit, `${off / unit} pixels beside the line`);
      }
      // It is smooth also where the line began.
      const [first, last] = [curves[0]!, curves.at(-1)!];
      assert.deepEqual(last[3], first[0]);
      const way = (from: Place, to: Place) => Math.atan2(to.y - from.y, to.x - from.x);
      const bend = Math.abs(way(last[2]!, last[3]!) - way(first[0]!, first[1]!)) % (2 * Math.PI);
      assert.ok(Math.min(bend, 2 * Math.PI - bend) < 0.02, `it bends by ${bend}`);
    }
  });
}

test("a line with distant ends is closed by a straight one", () => {
  const points = around(() => 100, 0, Math.PI);
  const curves = curvesOf(freehand(points, 1)!);
  assert.ok(curves.length <= 6);
  const [from, to] = [curves[0]![0]!, curves.at(-1)![3]!];
  assert.ok(Math.hypot(from.x - points[0]!.x, from.y - points[0]!.y) < 1e-3 && Math.abs(to.x - 200) < 3 && Math.abs(to.y - 200) < 3);
});

test("what is too small is no shape", () => {
  assert.equal(freehand([], 1), null);
  assert.equal(freehand([{ x: 5, y: 5 }], 1), null);
  assert.equal(freehand(around(() => 2), 1), null);
  assert.notEqual(freehand(around(() => 2), 0.1), null, "on a page that is seen from near it is");
  assert.equal(freehand([{ x: 0, y: 0 }, { x: 90, y: 0 }], 1), null);
});

test("also few points make a shape", () => {
  for (let count = 3; count < 12; count++) {
    const points = Array.from({ length: count }, (_, at) => ({ x: 50 * Math.cos((2 * Math.PI * at) / count), y: 50 * Math.sin((2 * Math.PI * at) / count) }));
    curvesOf(freehand(points, 1)!).flat().forEach(({ x, y }) => assert.ok(Math.hypot(x, y) < 120, `${count} points`));
  }
});
