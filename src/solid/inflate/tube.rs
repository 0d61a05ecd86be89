//! Lines blown up to tubes: over a point as far from the border as a disc of the line's width has it, the height is that of the
//! ball over that disc.
//!
//! The section is the same everywhere, so a mesh needs few points along the line, where that of a balloon has as many along its
//! border as across.

use glam::DVec2;
use rstar::RTree;
use rstar::primitives::Line;

use super::MIN_HEIGHT;
use super::mesh::Mesh;
use super::points::{Column, MAX_COLUMNS, Points, inside, thin};
use crate::geometry::{Outline, perimeter};
use crate::math;

/// The distance between points along straight stretches, in widths of the line.
const ALONG: f64 = 4.0;
/// The smallest distance between columns, in half widths of the line.
const CROWDED: f64 = 0.8;
/// Corners that turn left by more are ends of the line, or the outer side of a bend; radians.
const CORNER: f64 = 0.9;
/// The largest part of a half width that an inner point may come near the border on the other side.
const MIDDLE: f64 = 0.999;

/// Points for the outline of a line of this width, at the density of a rounding of so many layers per 180° across the line.
pub(in crate::solid) fn points(outline: &Outline, width: f64, segments: u32) -> Points {
    let mut all = Points {
        points: Vec::new(),
        edges: Vec::new(),
    };
    let radius = width / 2.0;
    let apart = apart(outline, width);
    let mut columns = Vec::new();
    for ring in outline.rings() {
        border(ring, radius, apart, &mut all, &mut columns);
    }
    let count = columns.len();
    let layers = thin(&mut columns, count, segments);
    inside(&columns, layers, radius, &mut all.points);
    all
}

/// The distance between points along the outline of a line of this width.
fn apart(outline: &Outline, width: f64) -> f64 {
    (ALONG * width).max(4.0 * perimeter(outline) / MAX_COLUMNS as f64)
}

/// About how many points there are between those of the outline of a line of this width.
pub(in crate::solid) fn points_between(outline: &Outline, width: f64) -> usize {
    (perimeter(outline) / apart(outline, width)) as usize
}

/// Adds the points of a ring, and the columns that stand on them.
fn border(ring: &[DVec2], radius: f64, apart: f64, all: &mut Points, columns: &mut Vec<Column>) {
    let n = ring.len();
    let directions: Vec<DVec2> = (0..n)
        .map(|i| (ring[(i + 1) % n] - ring[i]).normalize_or_zero())
        .collect();
    let turn = |i: usize| {
        let (before, after) = (directions[(i + n - 1) % n], directions[i]);
        math::atan2(before.perp_dot(after), before.dot(after))
    };
    let turns: Vec<f64> = (0..n).map(turn).collect();
    let column = |foot: DVec2, inward: DVec2| Column {
        foot,
        inward,
        radius: MIDDLE * radius,
    };
    let start = all.points.len();
    let mut last_foot = DVec2::INFINITY;
    for i in 0..n {
        let next = (i + 1) % n;
        let inward = directions[i].perp();
        all.points.push(ring[i]);
        if turns[i] < CORNER && ring[i].distance(last_foot) >= CROWDED * radius {
            last_foot = ring[i];
            let half = math::direction(turns[i] / 2.0);
            columns.push(column(
                ring[i],
                half.rotate(directions[(i + n - 1) % n]).perp(),
            ));
        }
        let length = ring[i].distance(ring[next]);
        // From a corner, where there is no column, the tube rises within half a width.
        let [before, after] = [i, next].map(|i| if turns[i] < CORNER { 0.0 } else { radius });
        let (first, last) = (before.min(length / 2.0), (length - after).max(length / 2.0));
        let count = ((last - first) / apart).ceil().max(1.0) as usize;
        let places = (0..=count).map(|k| first + (last - first) * k as f64 / count as f64);
        let mut at = 0.0;
        for place in places {
            // Ends are there already, and so is the middle of a short edge between two corners.
            if place <= at || place >= length {
                continue;
            }
            at = place;
            let foot = ring[i].lerp(ring[next], place / length);
            last_foot = foot;
            all.points.push(foot);
            columns.push(column(foot, inward));
        }
    }
    let end = all.points.len();
    let next = |i: usize| if i + 1 == end { start } else { i + 1 };
    all.edges.extend((start..end).map(|i| [i, next(i)]));
}

/// The heights over a mesh of the outline of a line of this width at its final place, model units. The highest points have the
/// given height, or half the width.
pub(in crate::solid) fn heights(mesh: &Mesh, width: f64, height: f64) -> Vec<f64> {
    let radius = width / 2.0;
    let place = |i: u32| mesh.points[i as usize].map(f64::from);
    let border = mesh.border().into_iter();
    let border = RTree::bulk_load(border.map(|[a, b]| Line::new(place(a), place(b))).collect());
    let least = MIN_HEIGHT * height;
    let points = mesh.points.iter().zip(&mesh.on_border);
    let heights = points.map(|(point, on_border)| {
        if *on_border {
            return 0.0;
        }
        let point = point.map(f64::from);
        let nearest = border.nearest_neighbor(point);
        let depth = nearest.map_or(0.0, |line| {
            rstar::PointDistance::distance_2(line, &point).sqrt()
        });
        let from_middle = 1.0 - (depth / radius).min(1.0);
        (height * (1.0 - from_middle * from_middle).max(0.0).sqrt()).max(least)
    });
    heights.collect()
}
