//! The drawings of the benchmarks.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use kurbo::{BezPath, Circle, Ellipse, Point, Rect, Shape};

/// Side of the cell that each part has to itself, drawing units.
const CELL: f64 = 40.0;

/// A drawing of so many parts in groups, each part in a cell of its own, and the area of all of them.
pub(crate) fn drawing(parts: usize) -> (String, f64) {
    let mut random = Random(1);
    let columns = (parts as f64).sqrt().ceil();
    let side = columns * CELL;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{side}\" height=\"{side}\" viewBox=\"0 0 {side} {side}\">\n\
         <text x=\"2\" y=\"4\" font-size=\"4\">%Shape default -15 15</text>\n"
    );
    let mut total = 0.0;
    let mut left = 0;
    let mut named = Vec::new();
    for index in 0..parts {
        if left == 0 {
            if index > 0 {
                svg.push_str("</g>\n");
            }
            let _ = writeln!(svg, "<g id=\"g{index}\">");
            left = 4 + random.below(20);
        }
        left -= 1;
        let center = Point::new(
            (index as f64 % columns + 0.5) * CELL,
            ((index as f64 / columns).floor() + 0.5) * CELL,
        );
        total += part(&mut svg, &mut random, center);
        if random.below(3) == 0 {
            let parent = match named.len() {
                0 => String::new(),
                count => format!("@P{}", named[count - 1 - random.below(count.min(12))]),
            };
            let shape = if random.below(2) == 0 {
                "$Shape default -8 8"
            } else {
                ""
            };
            let (x, y) = (center.x, center.y);
            let _ = writeln!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"3\">P{index}{parent}{shape}</text>"
            );
            named.push(index);
        }
    }
    svg.push_str("</g>\n</svg>\n");
    (svg, total)
}

/// Appends a part of a random kind and returns its area.
fn part(svg: &mut String, random: &mut Random, center: Point) -> f64 {
    const FILLS: [&str; 6] = [
        "#c83737", "#2a7fff", "#37c871", "#ffcc00", "#8d5fd3", "#ff7f2a",
    ];
    let radius = (9.0 + 8.0 * random.unit()).round();
    let fill = FILLS[random.below(FILLS.len())];
    let (Point { x, y }, r) = (center, radius);
    match random.below(20) {
        0..5 => {
            let rect = Rect::from_center_size(center, (1.2 * r, r));
            let (x, y, w, h) = (rect.x0, rect.y0, rect.width(), rect.height());
            let _ = writeln!(
                svg,
                "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{fill}\"/>"
            );
            rect.area()
        }
        5..8 => {
            let _ = writeln!(
                svg,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{fill}\"/>"
            );
            Circle::new(center, r).area()
        }
        8..11 => {
            let _ = writeln!(
                svg,
                "<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{r}\" ry=\"{}\" fill=\"{fill}\"/>",
                0.6 * r
            );
            Ellipse::new(center, (r, 0.6 * r), 0.0).area()
        }
        11..15 => {
            let corners = 3 + random.below(14);
            let mut path = BezPath::new();
            for corner in 0..corners {
                let reach = r * if corner % 2 == 0 { 1.0 } else { 0.6 };
                let angle = TAU * corner as f64 / corners as f64;
                let point = center + reach * kurbo::Vec2::from_angle(angle);
                if corner == 0 {
                    path.move_to(point)
                } else {
                    path.line_to(point)
                }
            }
            path.close_path();
            let _ = writeln!(svg, "<path d=\"{}\" fill=\"{fill}\"/>", path.to_svg());
            path.area().abs()
        }
        _ => {
            let mut path = blob(random, center, r);
            for hole in 0..random.below(3) {
                let aside = kurbo::Vec2::new(r * 0.3 * (hole as f64 * 2.0 - 1.0), 0.0);
                path.extend(blob(random, center + aside, r * 0.2).reverse_subpaths());
            }
            let _ = writeln!(svg, "<path d=\"{}\" fill=\"{fill}\"/>", path.to_svg());
            path.area().abs()
        }
    }
}

/// A smooth closed curve about a point.
fn blob(random: &mut Random, center: Point, radius: f64) -> BezPath {
    let count = 5 + random.below(8);
    let knots: Vec<Point> = (0..count)
        .map(|knot| {
            let reach = radius * (0.72 + 0.28 * random.unit());
            center + reach * kurbo::Vec2::from_angle(TAU * knot as f64 / count as f64)
        })
        .collect();
    let knot = |index: usize| knots[index % count];
    let mut path = BezPath::new();
    path.move_to(knots[0]);
    for index in 0..count {
        let (before, from, to, after) = (
            knot(index + count - 1),
            knot(index),
            knot(index + 1),
            knot(index + 2),
        );
        path.curve_to(from + (to - before) / 6.0, to - (after - from) / 6.0, to);
    }
    path.close_path();
    path
}

/// A linear congruential generator (Knuth's MMIX constants), kept by hand: a library may change its numbers, and figures measured earlier are of these drawings.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (self.unit() * limit as f64) as usize
    }
}
