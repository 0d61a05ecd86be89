//! Rings that touch in a point are pulled apart there.
//!
//! The solid over two squares that share a corner would have four faces on the edge above that
//! corner. A gap too small to be seen keeps every edge between exactly two faces.

use glam::DVec2;

use super::Polygon;
use super::clean::GridShapes;

/// How far a point is moved, relative to the outline's extent.
const GAP: f64 = 1e-4;
/// The most that a point is moved, relative to the shorter edge beside it.
const MOST: f64 = 0.25;
/// Rounds of pulling: each frees the outermost rings of those that touch in one point.
const ROUNDS: usize = 8;

/// A point of a ring that another one lies on.
#[derive(Clone, Copy)]
struct Corner {
    polygon: usize,
    ring: usize,
    index: usize,
    /// Towards the ring's previous point; the filled angle lies counter-clockwise, as numbers go,
    /// from here
    from: DVec2,
    /// to the direction of its next point.
    to: DVec2,
}

/// Pulls points of clean polygons that coincide on the grid apart: into their own area where no
/// other ring leads there, else out of it. `shapes` are the same rings on the grid.
pub(super) fn pull_apart(shapes: &GridShapes, polygons: &mut [Polygon], extent: f64) {
    let mut places: Vec<([i64; 2], [u32; 3])> = Vec::new();
    for (s, shape) in shapes.iter().enumerate() {
        for (r, ring) in shape.iter().enumerate() {
            let place = |(i, p): (usize, &[i64; 2])| (*p, [s as u32, r as u32, i as u32]);
            places.extend(ring.iter().enumerate().map(place));
        }
    }
    places.sort_unstable();
    let mut start = 0;
    while start < places.len() {
        let mut end = start + 1;
        while end < places.len() && places[end].0 == places[start].0 {
            end += 1;
        }
        if end - start > 1 {
            let corners = places[start..end].iter().map(|(_, [s, r, i])| {
                let [polygon, ring, index] = [*s as usize, *r as usize, *i as usize];
                let points = &shapes[polygon][ring];
                let n = points.len();
                let direction = |other: [i64; 2]| {
                    let [x, y] = points[index];
                    DVec2::new((other[0] - x) as f64, (other[1] - y) as f64)
                };
                Corner {
                    polygon,
                    ring,
                    index,
                    from: direction(points[(index + n - 1) % n]),
                    to: direction(points[(index + 1) % n]),
                }
            });
            pull(corners.collect(), polygons, extent);
        }
        start = end;
    }
}

fn pull(mut corners: Vec<Corner>, polygons: &mut [Polygon], extent: f64) {
    for round in 1..=ROUNDS {
        if corners.len() < 2 {
            return;
        }
        let mut left = Vec::new();
        for (i, corner) in corners.iter().enumerate() {
            let others = || {
                let others = corners.iter().enumerate().filter(|(j, _)| *j != i);
                others.flat_map(|(_, c)| [c.from, c.to])
            };
            let inner = |d: DVec2| turn(corner.from, d) < turn(corner.from, corner.to);
            let outer = |d: DVec2| turn(corner.from, d) > turn(corner.from, corner.to);
            let way = if !others().any(inner) {
                1.0
            } else if !others().any(outer) {
                -1.0
            } else {
                left.push(*corner);
                continue;
            };
            let ring = &mut polygons[corner.polygon].rings[corner.ring];
            let n = ring.len();
            let here = ring[corner.index];
            let before = (ring[(corner.index + n - 1) % n] - here).length();
            let after = (ring[(corner.index + 1) % n] - here).length();
            let gap = (GAP * extent / round as f64).min(MOST * before.min(after));
            ring[corner.index] += inward(corner) * (way * gap);
        }
        if left.len() == corners.len() {
            return;
        }
        corners = left;
    }
}

/// The angle from one direction to another, counter-clockwise as numbers go, 0 to 2π.
fn turn(from: DVec2, to: DVec2) -> f64 {
    let angle = from.perp_dot(to).atan2(from.dot(to));
    angle.rem_euclid(std::f64::consts::TAU)
}

/// The unit vector that halves the filled angle of a corner.
fn inward(corner: &Corner) -> DVec2 {
    let half = turn(corner.from, corner.to) / 2.0;
    DVec2::from_angle(half)
        .rotate(corner.from)
        .normalize_or(DVec2::X)
}
