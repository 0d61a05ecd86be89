//! The region of the plane that an outline covers, by which triangles are divided.

use glam::DVec2;

use crate::geometry::{
    Outline, Polygon, Ring, bounds, contains, intersect, is_convex, shoelace, subtract,
};
use crate::solid::cap;
use crate::solid::cells::Cells;
use crate::solid::rings::Rings;

/// Cells a point of the outline.
const CELLS: f64 = 4.0;
/// How far around a triangle an outline matters for it, as a share of its extent.
const AROUND: f64 = 0.1;
/// Triangles that are lower than this, as a share of their longest side, are not divided.
const NEEDLE: f64 = 1e-6;
/// Convex outlines of at most so many points cut edge by edge. Others would leave too many narrow parts beside them.
const MAX_CONVEX: usize = 8;

/// A region of the plane.
#[derive(Debug)]
pub(super) struct Region {
    outline: Outline,
    pub(super) bounds: [DVec2; 2],
    cells: Cells,
    /// Per cell whether the border passes through it.
    is_border: Vec<bool>,
    /// The outline, counter-clockwise, if it is convex and has few points.
    convex: Option<Ring>,
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
            convex: convex(&outline),
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
        // What only touches it is not cut.
        let slack = NEEDLE * (high - low).max_element();
        if (low + slack).cmpgt(self.bounds[1]).any() || (high - slack).cmplt(self.bounds[0]).any() {
            return Division::Outside;
        }
        let is_border = |cell: usize| self.is_border[cell];
        if is_needle(triangle) || !self.cells.any_of_triangle(triangle, is_border) {
            return if contains(&self.outline, (a + b + c) / 3.0) {
                Division::Inside
            } else {
                Division::Outside
            };
        }
        if let Some(convex) = &self.convex {
            return divide_by_convex(triangle, convex);
        }
        let more = AROUND * (high - low).max_element();
        let near = self.near([low - more, high + more]);
        let whole = outline(triangle);
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

    /// The triangles that make up the part of a triangle outside of all of some regions, counter-clockwise; `None` for all of it.
    /// The borders of the regions all go around them the same way.
    pub(super) fn outside_all(regions: &[&Self], triangle: [DVec2; 3]) -> Option<Vec<[DVec2; 3]>> {
        let [a, b, c] = triangle;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if is_needle(triangle) {
            let middle = (a + b + c) / 3.0;
            let is_over = |region: &&Self| contains(&region.outline, middle);
            return regions.iter().any(is_over).then(Vec::new);
        }
        let more = AROUND * (high - low).max_element();
        let near = regions
            .iter()
            .map(|region| region.near([low - more, high + more]));
        let near = Outline {
            polygons: near.flat_map(|near| near.polygons).collect(),
        };
        let whole = outline(triangle);
        if intersect(&whole, &near).polygons.is_empty() {
            return None;
        }
        Some(triangles(&subtract(&whole, &near)))
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

/// The smallest area that is told from none in a triangle.
fn least_area([a, b, c]: [DVec2; 3]) -> f64 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    NEEDLE * longest * longest
}

fn is_needle(triangle: [DVec2; 3]) -> bool {
    let [a, b, c] = triangle;
    (b - a).perp_dot(c - a).abs() <= least_area(triangle)
}

fn outline(triangle: [DVec2; 3]) -> Outline {
    Outline {
        polygons: vec![Polygon {
            rings: vec![triangle.to_vec()],
        }],
    }
}

/// The only ring of an outline, counter-clockwise, if it is convex and has few points.
fn convex(outline: &Outline) -> Option<Ring> {
    let mut rings = outline.rings();
    let (Some(ring), None) = (rings.next(), rings.next()) else {
        return None;
    };
    if ring.len() > MAX_CONVEX || !is_convex(ring) {
        return None;
    }
    let mut ring = ring.clone();
    if shoelace(&ring) < 0.0 {
        ring.reverse();
    }
    Some(ring)
}

/// How a triangle lies in a convex polygon that is counter-clockwise.
fn divide_by_convex(triangle: [DVec2; 3], convex: &[DVec2]) -> Division {
    let least = least_area(triangle);
    let mut rest = triangle.to_vec();
    if shoelace(&rest) < 0.0 {
        rest.reverse();
    }
    let is_left_out = |ring: &[DVec2]| ring.len() < 3 || shoelace(ring) <= least;
    let mut outside = Vec::new();
    for (index, from) in convex.iter().enumerate() {
        let edge = convex[(index + 1) % convex.len()] - from;
        let inward = |point: DVec2| edge.perp_dot(point - from);
        let beside = half(&rest, |point| -inward(point));
        if !is_left_out(&beside) {
            outside.extend(fan(&beside));
            rest = half(&rest, inward);
            if is_left_out(&rest) {
                return Division::Outside;
            }
        }
    }
    if outside.is_empty() {
        return Division::Inside;
    }
    Division::Both([outside, fan(&rest).collect()])
}

/// The triangles of a convex polygon.
fn fan(polygon: &[DVec2]) -> impl Iterator<Item = [DVec2; 3]> + '_ {
    let pairs = polygon.windows(2).skip(1);
    pairs.map(|pair| [polygon[0], pair[0], pair[1]])
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
