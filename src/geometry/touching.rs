//! Separates rings that touch in a point.
//!
//! The solid over two squares that share a corner would have four faces on the edge above that corner. An invisibly
//! small gap keeps every edge between exactly two faces. Corners are cut rather than moved, so that edges stay on their
//! lines and cannot cross others.

use glam::DVec2;

use super::Polygon;
use super::boolean::GridShapes;

/// How far from its tip a corner is cut, relative to the outline's extent.
const GAP: f64 = 1e-4;
/// The largest share of an edge that may be cut off at each end.
const MAX_CUT: f64 = 0.25;
/// By how much less the next corner in the same place is cut, relative to the first: edges may leave a place in almost
/// the same direction.
const CUT_DECREASE: f64 = 0.1;

/// A point of a ring that coincides with another one of the same or another ring.
#[derive(Clone, Copy)]
struct Corner {
    /// Polygon, ring and point.
    place: [usize; 3],
    /// Towards the ring's previous point.
    back: DVec2,
    /// Towards its next point.
    on: DVec2,
}

/// Separates points of polygons that coincide on the grid. `shapes` are the same rings on the grid. Returns whether
/// there were any.
pub(super) fn separate(shapes: &GridShapes, polygons: &mut [Polygon], extent: f64) -> bool {
    let places = places(shapes);
    let mut cuts: Vec<([usize; 3], f64)> = Vec::new();
    for shared in places.chunk_by(|a, b| a.0 == b.0).filter(|c| c.len() > 1) {
        let corners = shared.iter().map(|(_, place)| {
            let ring = &shapes[place[0]][place[1]];
            let (n, i) = (ring.len(), place[2]);
            let towards = |j: usize| {
                let ([x, y], [u, v]) = (ring[i], ring[j % n]);
                DVec2::new((u - x) as f64, (v - y) as f64)
            };
            Corner {
                place: *place,
                back: towards(i + n - 1),
                on: towards(i + 1),
            }
        });
        let first = cuts.len();
        choose(corners.collect(), &mut cuts);
        for (k, cut) in cuts[first..].iter_mut().enumerate() {
            cut.1 = (1.0 - CUT_DECREASE).powi(k as i32);
        }
    }
    cuts.sort_unstable_by_key(|cut| cut.0);
    for cuts in cuts.chunk_by(|a, b| a.0[..2] == b.0[..2]) {
        let [polygon, ring, _] = cuts[0].0;
        let ring = &mut polygons[polygon].rings[ring];
        let n = ring.len();
        let mut cuts = cuts.iter().peekable();
        let mut cut = Vec::with_capacity(n + cuts.len());
        for i in 0..n {
            if let Some((_, share)) = cuts.next_if(|cut| cut.0[2] == i) {
                for end in [ring[(i + n - 1) % n], ring[(i + 1) % n]] {
                    let edge = end - ring[i];
                    let part = share * (GAP * extent / edge.length()).min(MAX_CUT);
                    cut.push(ring[i] + edge * part);
                }
            } else {
                cut.push(ring[i]);
            }
        }
        *ring = cut;
    }
    !cuts.is_empty()
}

/// Whether any points coincide.
pub(super) fn touches(shapes: &GridShapes) -> bool {
    places(shapes).windows(2).any(|w| w[0].0 == w[1].0)
}

/// All points, sorted, each with the indices of its polygon, ring and point.
fn places(shapes: &GridShapes) -> Vec<([i64; 2], [usize; 3])> {
    let mut places = Vec::new();
    for (s, shape) in shapes.iter().enumerate() {
        for (r, ring) in shape.iter().enumerate() {
            places.extend(ring.iter().enumerate().map(|(i, p)| (*p, [s, r, i])));
        }
    }
    places.sort_unstable();
    places
}

/// Chooses which of the corners in one place are cut: repeatedly those into whose convex side no other corner reaches,
/// until one is left.
fn choose(mut corners: Vec<Corner>, cuts: &mut Vec<([usize; 3], f64)>) {
    while corners.len() > 1 {
        let free = |i: usize| {
            let Corner { back, on, .. } = corners[i];
            let (from, to) = if back.perp_dot(on) > 0.0 {
                (back, on)
            } else {
                (on, back)
            };
            let within = |d: DVec2| from.perp_dot(d) > 0.0 && d.perp_dot(to) > 0.0;
            let mut others = corners.iter().enumerate().filter(|(j, _)| *j != i);
            !others.any(|(_, c)| within(c.back) || within(c.on))
        };
        let free: Vec<bool> = (0..corners.len()).map(free).collect();
        if !free.contains(&true) {
            return;
        }
        let mut free = free.into_iter();
        let mut kept = None;
        corners.retain(|corner| {
            let cut = free.next() == Some(true);
            // The last corner can stay.
            if cut {
                cuts.extend(kept.replace((corner.place, 1.0)));
            }
            !cut
        });
        if !corners.is_empty() {
            cuts.extend(kept);
        }
    }
}
