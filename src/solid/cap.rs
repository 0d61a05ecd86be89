//! Triangulates outlines without adding points.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;

use glam::{DVec2, DVec3, Vec3};
use i_triangle::i_overlay::core::fill_rule::FillRule;
use i_triangle::i_overlay::core::overlay::{ContourDirection, IntOverlayOptions};
use i_triangle::i_overlay::i_float::int::point::IntPoint;
use i_triangle::int::triangulation::IntTriangulation;
use i_triangle::int::triangulator::IntTriangulator;
use i_triangle::int::validation::Validation;

use super::ears;
use super::rings::Rings;
use crate::geometry::{bounds_of, is_convex, sweeps_better_along_y};

/// Polygons with more points than this are triangulated by a sweep, others by ear clipping.
const SWEEP: usize = 200;
/// Half the extent of a polygon in steps of the sweep's integer grid.
const GRID: f64 = (1u32 << 28) as f64;
/// How far points in the same place are moved apart, in these steps.
const APART: f64 = 16.0;

/// Triangles of all polygons, counter-clockwise. Their outer edges are the rings' edges.
pub(super) fn triangles(rings: &Rings) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(rings.len());
    for polygon in &rings.polygons {
        let polygon = &rings.rings[polygon.clone()];
        let count: usize = polygon.iter().map(Range::len).sum();
        match polygon {
            [ring] if is_convex(&rings.points[ring.clone()]) => strip(ring, &mut triangles),
            _ if count > SWEEP && sweep(&rings.points, polygon, &mut triangles) => {}
            _ => ears::clip(&rings.points, polygon, &mut triangles),
        }
    }
    triangles
}

/// A lower bound of the distances between points; 0 where none is easy to find.
pub(super) fn least_gap(rings: &Rings) -> f64 {
    let points = &rings.points;
    if rings.rings.len() != 1 || !is_convex(points) {
        return 0.0;
    }
    let edges = rings.next.iter().zip(points);
    let least = edges.map(|(next, p)| p.distance_squared(points[*next as usize]));
    least.fold(f64::INFINITY, f64::min).sqrt()
}

fn strip(ring: &Range<usize>, triangles: &mut Vec<[u32; 3]>) {
    let (mut low, mut high) = (ring.start as u32, ring.end as u32 - 1);
    while high - low > 1 {
        triangles.push([low, low + 1, high]);
        low += 1;
        if high - low > 1 {
            triangles.push([low, high - 1, high]);
            high -= 1;
        }
    }
}

thread_local! {
    static SWEEPER: RefCell<IntTriangulator<i32, u32>> = RefCell::new({
        let options = IntOverlayOptions {
            output_direction: ContourDirection::CounterClockwise,
            preserve_input_collinear: true,
            preserve_output_collinear: true,
            ..Default::default()
        };
        let validation = Validation { fill_rule: FillRule::NonZero, options };
        IntTriangulator::new(256, validation, Default::default())
    });
}

/// Triangulates a polygon in integer coordinates; `false`, with nothing added, if these are too coarse.
fn sweep(points: &[DVec2], polygon: &[Range<usize>], triangles: &mut Vec<[u32; 3]>) -> bool {
    let own = || polygon.iter().flat_map(|ring| &points[ring.clone()]);
    let Some((low, high)) = bounds_of(own().copied()) else {
        return false;
    };
    let middle = low.midpoint(high);
    let scale = GRID / (high - low).max_element();
    let is_turned = sweeps_better_along_y(polygon.iter().map(|ring| &points[ring.clone()]));
    let place = |p: &DVec2| {
        let p = ((*p - middle) * scale).round();
        let p = if is_turned { p.perp() } else { p };
        IntPoint::new(p.x as i32, p.y as i32)
    };
    let mut shape: Vec<Vec<_>> = polygon
        .iter()
        .map(|ring| points[ring.clone()].iter().map(place).collect())
        .collect();
    let moved = separate(&mut shape);
    let cut: IntTriangulation<i32, u32> =
        SWEEPER.with_borrow_mut(|sweeper| sweeper.triangulate_shape(&shape));
    let count: usize = polygon.iter().map(Range::len).sum();
    if cut.points.len() != count || cut.indices.len() != 3 * (count + 2 * polygon.len() - 4) {
        return false;
    }
    let mut sorted: Vec<(IntPoint<i32>, u32)> = Vec::with_capacity(count);
    for (ring, places) in polygon.iter().zip(&shape) {
        let ids = ring.clone().map(|i| i as u32);
        sorted.extend(places.iter().copied().zip(ids));
    }
    sorted.sort_unstable();
    if sorted.windows(2).any(|w| w[0].0 == w[1].0) {
        return false;
    }
    let find = |p: &IntPoint<i32>| {
        sorted
            .binary_search_by(|(q, _)| q.cmp(p))
            .map(|i| sorted[i].1)
    };
    let Ok(ids) = cut.points.iter().map(find).collect::<Result<Vec<u32>, _>>() else {
        return false;
    };
    let start = triangles.len();
    for corners in cut.indices.chunks_exact(3) {
        triangles.push([corners[0], corners[1], corners[2]].map(|i| ids[i as usize]));
    }
    // Points that are not on the grid may be in line, or in the same place.
    let off = if moved { APART } else { 1.0 } / scale;
    let is_whole = |t: &[u32; 3]| area(points, t) >= -off * longest(points, t);
    let whole = triangles[start..].iter().all(is_whole);
    if !whole {
        triangles.truncate(start);
    }
    whole
}

/// Moves points apart that holes have in common with other rings, into their holes, so that the sweep can tell them apart. Returns
/// whether there were any.
fn separate(rings: &mut [Vec<IntPoint<i32>>]) -> bool {
    let rings_of = rings.iter().enumerate();
    let all = rings_of.flat_map(|(r, ring)| (0..ring.len()).map(move |i| (ring[i], r, i)));
    let mut all: Vec<(IntPoint<i32>, usize, usize)> = all.collect();
    all.sort_unstable();
    let again = all.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let again: Vec<(usize, usize)> = again.map(|pair| (pair[1].1, pair[1].2)).collect();
    let corners = again.iter().map(|(r, i)| {
        let ring = &rings[*r];
        let at = |i: usize| DVec2::new(f64::from(ring[i].x), f64::from(ring[i].y));
        let (before, after) = (
            at((i + ring.len() - 1) % ring.len()),
            at((i + 1) % ring.len()),
        );
        let sides = [at(*i) - before, after - at(*i)].map(DVec2::normalize_or_zero);
        // The filled side is on the left.
        let inward = -(sides[0] + sides[1]).perp();
        let place = at(*i) + (APART * inward.normalize_or(-sides[0])).round();
        IntPoint::new(place.x as i32, place.y as i32)
    });
    let corners: Vec<IntPoint<i32>> = corners.collect();
    for ((r, i), corner) in again.iter().zip(corners) {
        rings[*r][*i] = corner;
    }
    !again.is_empty()
}

/// Twice the signed area.
pub(super) fn area(points: &[DVec2], [a, b, c]: &[u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|i| points[*i as usize]);
    (b - a).perp_dot(c - a)
}

/// Flips edges so that no triangle is degenerate, or lower than `least` over its longest edge; returns those that remain.
/// The points are at their final positions, or `least` allows for the difference.
pub(super) fn flip_degenerate(
    points: &[DVec2],
    triangles: &mut [[u32; 3]],
    least: f64,
) -> Vec<[u32; 3]> {
    let is_empty =
        |triangle: &[u32; 3]| area(points, triangle) <= least * longest(points, triangle);
    let square = |a: u32, b: u32| points[a as usize].distance_squared(points[b as usize]);
    turn_edges(triangles, &is_empty, &square)
}

/// Flips edges of a closed surface so that no triangle is degenerate, also between a cap and a wall, where rounding may put a
/// point of the cap on their common edge.
pub(super) fn flip_degenerate_in_space(positions: &[[f32; 3]], triangles: &mut [[u32; 3]]) {
    let place = |i: u32| Vec3::from(positions[i as usize]).as_dvec3();
    let is_empty = |[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [*a, *b, *c].map(place);
        (b - a).cross(c - a) == DVec3::ZERO
    };
    let square = |a: u32, b: u32| place(a).distance_squared(place(b));
    turn_edges(triangles, &is_empty, &square);
}

/// Flips the longest edge of each degenerate triangle; returns the triangles that remain degenerate.
fn turn_edges(
    triangles: &mut [[u32; 3]],
    is_empty: &dyn Fn(&[u32; 3]) -> bool,
    square: &dyn Fn(u32, u32) -> f64,
) -> Vec<[u32; 3]> {
    let empty = |triangles: &[[u32; 3]]| -> Vec<usize> {
        let all = 0..triangles.len();
        all.filter(|i| is_empty(&triangles[*i])).collect()
    };
    let mut left = empty(triangles);
    let mut owner: HashMap<[u32; 2], usize> = HashMap::new();
    // Each flip fixes one triangle, so that a few rounds either suffice or nothing helps.
    for _ in 0..8 {
        if left.is_empty() {
            break;
        }
        owner.clear();
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            owner.extend([([*a, *b], i), ([*b, *c], i), ([*c, *a], i)]);
        }
        for i in left {
            turn(square, triangles, i, &mut owner);
        }
        left = empty(triangles);
    }
    left.into_iter().map(|i| triangles[i]).collect()
}

/// The length of a triangle's longest edge.
fn longest(points: &[DVec2], [a, b, c]: &[u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|i| points[*i as usize]);
    let squares = [
        a.distance_squared(b),
        b.distance_squared(c),
        c.distance_squared(a),
    ];
    squares.into_iter().fold(0.0, f64::max).sqrt()
}

/// Replaces the longest edge of a triangle by the other diagonal with its neighbour.
fn turn(
    square: &dyn Fn(u32, u32) -> f64,
    triangles: &mut [[u32; 3]],
    i: usize,
    owner: &mut HashMap<[u32; 2], usize>,
) {
    let t = triangles[i];
    let length = |k: usize| square(t[k], t[(k + 1) % 3]);
    let longest = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b)));
    let longest = longest.unwrap_or(0);
    let [a, b, c] = [t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]];
    let Some(&j) = owner.get(&[b, a]) else { return };
    let Some(&d) = triangles[j].iter().find(|p| **p != a && **p != b) else {
        return;
    };
    if owner.contains_key(&[c, d]) || owner.contains_key(&[d, c]) {
        return;
    }
    (triangles[i], triangles[j]) = ([a, d, c], [d, b, c]);
    owner.remove(&[a, b]);
    owner.remove(&[b, a]);
    owner.extend([([a, d], i), ([d, c], i), ([c, a], i)]);
    owner.extend([([d, b], j), ([b, c], j), ([c, d], j)]);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of `size` tiles with holes, diamonds or tilted squares, which touch at their corners if they reach this far: 0.5.
    fn lattice(size: usize, tilt: f64, reach: f64) -> (Vec<DVec2>, Vec<Range<usize>>) {
        let n = size as f64;
        let square = [(0.0, 0.0), (n, 0.0), (n, n), (0.0, n)];
        let mut points: Vec<DVec2> = square.map(DVec2::from).to_vec();
        let mut rings: Vec<Range<usize>> = std::iter::once(0..4).collect();
        for tile in 0..(size - 2) * (size - 2) {
            let (x, y) = (tile % (size - 2) + 1, tile / (size - 2) + 1);
            let corner = |x: f64, y: f64| {
                let bend = tilt * DVec2::new((3.0 * y).sin(), (2.0 * x).cos());
                DVec2::new(x, y) + bend
            };
            let (x, y) = (x as f64, y as f64);
            let start = points.len();
            let diamond = [(-reach, 0.0), (0.0, reach), (reach, 0.0), (0.0, -reach)];
            points.extend(diamond.map(|(right, up)| corner(x + 0.5 + right, y + 0.5 + up)));
            rings.push(start..points.len());
        }
        (points, rings)
    }

    #[test]
    fn holes_that_touch_are_swept() {
        for (size, tilt) in [(10, 0.0), (10, 0.07), (60, 0.0), (60, 0.03)] {
            let (points, rings) = lattice(size, tilt, 0.5);
            let mut triangles = Vec::new();
            assert!(sweep(&points, &rings, &mut triangles), "{size} {tilt}");
            assert_covers(&points, &rings, &triangles);
        }
    }

    #[test]
    fn ears_are_clipped_in_a_grid_as_without() {
        // With few corners there is no grid. Searching all corners for each of 20,000 holes would take minutes.
        for size in [5, 20, 143] {
            let (points, rings) = lattice(size, 0.02, 0.4);
            let mut triangles = Vec::new();
            ears::clip(&points, &rings, &mut triangles);
            let count: usize = rings.iter().map(Range::len).sum();
            assert_eq!(triangles.len(), count + 2 * rings.len() - 4);
            assert_covers(&points, &rings, &triangles);
            let least = triangles.iter().map(|t| area(&points, t));
            let least = least.fold(f64::INFINITY, f64::min);
            assert!(least > -1e-9, "a triangle of {least}");
        }
    }

    /// Checks that the area of triangles is that of a polygon.
    fn assert_covers(points: &[DVec2], rings: &[Range<usize>], triangles: &[[u32; 3]]) {
        let covered: f64 = triangles.iter().map(|t| area(points, t) / 2.0).sum();
        let shoelace = |ring: &Range<usize>| -> f64 {
            let ring = &points[ring.clone()];
            let edges = (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()]));
            edges.sum::<f64>() / 2.0
        };
        let whole: f64 = rings.iter().map(shoelace).sum();
        assert!((covered / whole - 1.0).abs() < 1e-5, "{covered} of {whole}");
    }
}
