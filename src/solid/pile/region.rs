//! The region of the plane that an outline covers, by which triangles are divided.

use glam::DVec2;

use crate::geometry::{Outline, Polygon, bounds, contains, intersect, shoelace, subtract};
use crate::solid::cap;
use crate::solid::cells::Cells;
use crate::solid::rings::Rings;

/// Cells a point of the outline.
const CELLS: f64 = 4.0;
/// How far around a triangle an outline matters for it, as a share of its extent.
const AROUND: f64 = 0.1;
/// Triangles that are lower than this, as a share of their longest side, are not divided.
const NEEDLE: f64 = 1e-6;

/// A region of the plane.
#[derive(Debug)]
pub(super) struct Region {
    outline: Outline,
    pub(super) bounds: [DVec2; 2],
    cells: Cells,
    /// Per cell whether the border passes through it.
    is_border: Vec<bool>,
}

/// How a triangle lies in a region.
pub(super) enum Division {
    Outside,
    Inside,
    /// The triangles that make up the part outside and the part inside, counter-clockwise.
    Both([Vec<[DVec2; 3]>; 2]),
}

impl Region {
    /// The region of an outline; `None` for an empty one.
    pub(super) fn new(outline: Outline) -> Option<Self> {
        let bounds = bounds(&outline)?;
        let bounds = [bounds.0, bounds.1];
        let rings = || outline.rings();
        let count = outline.point_count();
        let cells = Cells::over(bounds, CELLS * count as f64);
        let mut is_border = vec![false; cells.count()];
        for ring in rings() {
            for (index, from) in ring.iter().enumerate() {
                let to = ring[(index + 1) % ring.len()];
                cells.of_triangle([*from, to, *from], |cell| is_border[cell] = true);
            }
        }
        Some(Self {
            outline,
            bounds,
            cells,
            is_border,
        })
    }

    /// How a triangle lies in it.
    pub(super) fn divide(&self, triangle: [DVec2; 3]) -> Division {
        let [a, b, c] = triangle;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if low.cmpgt(self.bounds[1]).any() || high.cmplt(self.bounds[0]).any() {
            return Division::Outside;
        }
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let is_needle = (b - a).perp_dot(c - a).abs() <= NEEDLE * longest * longest;
        let is_border = |cell: usize| self.is_border[cell];
        if is_needle || !self.cells.any_of_triangle(triangle, is_border) {
            return if contains(&self.outline, (a + b + c) / 3.0) {
                Division::Inside
            } else {
                Division::Outside
            };
        }
        let more = AROUND * (high - low).max_element();
        let near = self.near([low - more, high + more]);
        let whole = Outline {
            polygons: vec![Polygon {
                rings: vec![vec![a, b, c]],
            }],
        };
        let inside = intersect(&whole, &near);
        if inside.polygons.is_empty() {
            return Division::Outside;
        }
        let outside = subtract(&whole, &near);
        if outside.polygons.is_empty() {
            return Division::Inside;
        }
        Division::Both([triangles(&outside), triangles(&inside)])
    }

    /// The part of the outline in a box, with sides of the box where it goes out of that.
    fn near(&self, [low, high]: [DVec2; 2]) -> Outline {
        let sides: [(DVec2, f64); 4] = [
            (DVec2::X, -low.x),
            (-DVec2::X, high.x),
            (DVec2::Y, -low.y),
            (-DVec2::Y, high.y),
        ];
        let within = |ring: &Vec<DVec2>| {
            sides.iter().fold(ring.clone(), |ring, (inward, offset)| {
                half(&ring, |point| point.dot(*inward) + offset)
            })
        };
        let mut near = self.outline.map_rings(within);
        for polygon in &mut near.polygons {
            polygon.rings.retain(|ring| ring.len() > 2);
        }
        near.polygons.retain(|polygon| !polygon.rings.is_empty());
        near
    }
}

/// The part of a ring where a linear function is not negative.
fn half(ring: &[DVec2], value: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(ring.len());
    for (index, from) in ring.iter().enumerate() {
        let to = ring[(index + 1) % ring.len()];
        let (here, there) = (value(*from), value(to));
        if here >= 0.0 {
            kept.push(*from);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(from.lerp(to, here / (here - there)));
        }
    }
    kept
}

/// Counter-clockwise triangles of an outline.
fn triangles(outline: &Outline) -> Vec<[DVec2; 3]> {
    let borders = || {
        outline
            .polygons
            .iter()
            .filter_map(|polygon| polygon.rings.first())
    };
    let is_turned = borders().any(|ring| shoelace(ring) < 0.0);
    let rings = Rings::of(&outline.map_rings(|ring| {
        let mut ring = ring.clone();
        if is_turned {
            ring.reverse();
        }
        ring
    }));
    let triangles = cap::triangles(&rings).into_iter();
    let place = |triangle: [u32; 3]| triangle.map(|index| rings.points[index as usize]);
    triangles.map(place).collect()
}
