//! Outlines turned about their axis.
//!
//! The turned profile is the union of the outline's right half and the mirror image of its left half. So the solid covers the
//! whole drawing as seen from the front, and a small change of the drawing makes a small change of the solid. A turn of less
//! than 360° is centred on the viewer and closed by two flat faces.

use crate::math;
use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::Options;
use super::cap;
use super::crease::Crease;
use super::layers::steps_per_half_turn;
use super::rings::Rings;
use super::shade::shade;
use super::stack::PlacementTransform;
use crate::geometry::{Outline, Polygon, bounds, intersect, remove_collinear, union};
use crate::scene::Surface;

/// What is closer to the axis than this, relative to the extent, is cut off.
const ON_AXIS: f64 = 1e-6;
/// The rounding of cuts, relative to the extent.
const ROUNDING: f64 = 4e-6;
/// Points closer to each other than this, relative to the largest coordinate, are merged, because `f32` may not distinguish
/// them.
const SAME: f64 = 1e-6;
/// The range of turns, degrees.
const TURNS: std::ops::RangeInclusive<f64> = 0.01..=360.0;

/// The angle of a turn, clamped to the range, degrees.
pub(super) fn sweep_angle(degrees: f64) -> f64 {
    if degrees.is_finite() {
        degrees.clamp(*TURNS.start(), *TURNS.end())
    } else {
        *TURNS.end()
    }
}

/// The surface of an outline turned by an angle in degrees.
pub(super) fn lathe(outline: &Outline, degrees: f64, options: &Options) -> Surface {
    let degrees = sweep_angle(degrees);
    let whole = degrees >= 360.0;
    let half = steps_per_half_turn(options);
    let steps = ((degrees / 180.0 * f64::from(half)) - 1e-9).ceil().max(1.0) as usize;
    let sweep = degrees.to_radians();
    // Full turns begin in the drawing plane, so that the solid is as wide as the drawing.
    let first = if whole { 0.0 } else { FRAC_PI_2 - sweep / 2.0 };
    let transform = PlacementTransform::new(options);
    let Some((low, high)) = bounds(outline) else {
        return Surface::default();
    };
    let extent = low.abs().max(high.abs()).max_element();
    let same = SAME * (options.placement.translation.abs().max_element() + extent);
    let rings = turned_profile(outline, [extent, same], sweep / steps as f64, whole);
    if rings.len() < 3 {
        return Surface::default();
    }

    let rows = if whole { steps } else { steps + 1 };
    let turns: Vec<DVec2> = (0..rows)
        .map(|row| match 4 * row {
            // Exactly in the drawing plane.
            quarter if whole && quarter == 2 * steps => DVec2::NEG_X,
            _ => math::direction(first + sweep * row as f64 / steps as f64),
        })
        .collect();
    let mut written = Vec::with_capacity(rings.len() * rows);
    // The first position of each point of the profile; points on the axis have only one.
    let mut starts = Vec::with_capacity(rings.len());
    for point in &rings.points {
        starts.push(written.len() as u32);
        let count = if point.x == 0.0 { 1 } else { rows };
        for turn in &turns[..count] {
            let place = DVec3::new(point.x * turn.x, point.y, point.x * turn.y);
            written.push(transform.position(place));
        }
    }
    let on_axis = |i: usize| rings.points[i].x == 0.0;
    let place = |i: usize, row: usize| starts[i] + if on_axis(i) { 0 } else { (row % rows) as u32 };

    let mut triangles = Vec::with_capacity(2 * rings.len() * rows);
    for i in 0..rings.len() {
        let j = rings.next[i] as usize;
        for row in 0..steps {
            let [a, b] = [place(i, row), place(j, row)];
            let [c, d] = [place(j, row + 1), place(i, row + 1)];
            match [on_axis(i), on_axis(j)] {
                [true, true] => {}
                [true, false] => triangles.push([a, b, c]),
                [false, true] => triangles.push([a, b, d]),
                [false, false] => triangles.extend([[a, b, c], [a, c, d]]),
            }
        }
    }
    if !whole {
        let mut caps = cap::triangles(&rings);
        cap::flip_degenerate(&rings.points, &mut caps, same);
        for [a, b, c] in caps {
            // The first face is seen with the axis on its left, the last one from behind.
            triangles.push([a, c, b].map(|i| place(i as usize, 0)));
            triangles.push([a, b, c].map(|i| place(i as usize, steps)));
        }
        cap::flip_degenerate_in_space(&written, &mut triangles);
    }
    let tips: Vec<u32> = (0..rings.len())
        .filter(|i| on_axis(*i))
        .map(|i| starts[i])
        .collect();
    let is_tip = |i: u32| whole && tips.binary_search(&i).is_ok();
    shade(&written, &triangles, Crease::new(options.crease), is_tip)
}

/// The turned profile: x from the axis, y along it. In full turns, points on the axis have x = 0; in others, the smallest x
/// that separates the two flat faces, which would share edges otherwise. `extent` is the outline's largest distance from its
/// centre, `same` the distance below which points are merged.
fn turned_profile(outline: &Outline, [extent, same]: [f64; 2], step: f64, whole: bool) -> Rings {
    // Boolean operations expect y down.
    let axis = (ON_AXIS * extent).max(same / step.min(1.0));
    // What is nearer to the axis is cut off, and not moved: rings that were apart could touch.
    let right = half(outline, DVec2::new(1.0, -1.0), [axis, extent]);
    let left = half(outline, DVec2::new(-1.0, -1.0), [axis, extent]);
    let both = union(&[right, left]);
    let least = if whole { 0.0 } else { axis };
    let is_cut = |p: &DVec2| p.x < axis + ROUNDING * extent;
    let snap = |p: &DVec2| DVec2::new(if is_cut(p) { least } else { p.x }, -p.y);
    let ring = |ring: &Vec<DVec2>| {
        let mut ring: Vec<DVec2> = ring.iter().map(snap).collect();
        // Of a run on the axis only the ends are kept; slivers beside it may have collapsed onto it.
        let n = ring.len();
        let on_axis: Vec<bool> = ring.iter().map(|p| p.x == least).collect();
        let mut place = 0;
        ring.retain(|_| {
            place += 1;
            let i = place - 1;
            !(on_axis[(i + n - 1) % n] && on_axis[i] && on_axis[(i + 1) % n])
        });
        remove_collinear(&mut ring, same);
        ring
    };
    let polygon = |polygon: &Polygon| {
        let mut rings: Vec<Vec<DVec2>> = polygon.rings.iter().map(ring).collect();
        if rings.first().is_some_and(|border| border.len() < 3) {
            rings.clear();
        }
        Polygon { rings }
    };
    let mut rings = Rings::of(&Outline {
        polygons: both.polygons.iter().map(polygon).collect(),
    });
    keep_apart(&mut rings.points, least, same);
    rings
}

/// Spreads points on the axis to a minimum distance: parts of the outline that meet in a point on the axis would share
/// edges there.
fn keep_apart(points: &mut [DVec2], axis: f64, distance: f64) {
    let mut on_axis: Vec<usize> = (0..points.len()).filter(|i| points[*i].x == axis).collect();
    on_axis.sort_by(|a, b| points[*a].y.total_cmp(&points[*b].y));
    for pair in on_axis.windows(2) {
        points[pair[1]].y = points[pair[1]].y.max(points[pair[0]].y + distance);
    }
}

/// The half of an outline beyond x = `axis`, after its coordinates were multiplied by ±1.
fn half(outline: &Outline, signs: DVec2, [axis, extent]: [f64; 2]) -> Outline {
    let turned = signs.x * signs.y > 0.0;
    let ring = |ring: &Vec<DVec2>| {
        let mut ring: Vec<DVec2> = ring.iter().map(|p| *p * signs).collect();
        if turned {
            ring.reverse();
        }
        ring
    };
    let outline = outline.map_rings(ring);
    let reach = 2.0 * extent;
    let corners = [
        (axis, -reach),
        (axis, reach),
        (reach, reach),
        (reach, -reach),
    ];
    let side = Polygon {
        rings: vec![corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect()],
    };
    let side = Outline {
        polygons: vec![side],
    };
    intersect(&outline, &side)
}

#[cfg(test)]
#[path = "lathe_tests.rs"]
mod tests;
