//! Finds the corners of rectangles on the sides of others, so that neighbours share all points of their common sides (no
//! T-junctions).

use rayon::prelude::*;
use rustc_hash::FxHashSet;

use super::super::constraints::STRIPE;
use super::greedy::Rect;

/// The corners of all rectangles, stripe by stripe.
#[derive(Debug)]
pub(super) struct Corners {
    stripes: Vec<FxHashSet<u64>>,
}

/// A point in one number, its column relative to its stripe. Depths and steps of heights are below 2²⁷: heights are sums of rows
/// of a map of 2²⁶ cells, depths the sum of a row and a height.
fn packed(stripe: usize, [x, y, z]: [i32; 3]) -> u64 {
    const HALF: i64 = 1 << 27;
    let x = (i64::from(x) - (stripe * STRIPE) as i64) as u64;
    let [y, z] = [y, z].map(|value| (i64::from(value) + HALF) as u64);
    x << 56 | y << 28 | z
}

impl Corners {
    /// Collects the corners of rectangles, stripe by stripe, and the points in `more`.
    pub(super) fn new(rects: &[Vec<Rect>], squares: &[Vec<Rect>], more: &[[i32; 3]]) -> Self {
        let stripe_of = |x: i32| (x as usize / STRIPE).min(rects.len() - 1);
        let mut extra: Vec<Vec<[i32; 3]>> = vec![vec![]; rects.len()];
        for point in more {
            extra[stripe_of(point[0])].push(*point);
        }
        let all = |stripe: usize| {
            let squares = squares.get(stripe).into_iter().flatten();
            rects[stripe].iter().chain(squares).flat_map(Rect::corners)
        };
        let border = |stripe: usize| (stripe * STRIPE) as i32;
        let stripes = (0..rects.len()).into_par_iter().map(|stripe| {
            let mut points = FxHashSet::default();
            points.extend(all(stripe).map(|point| packed(stripe, point)));
            // Both stripes have all corners on their common border.
            let mut from = |other: usize, x: i32| {
                let corners = all(other).chain(extra[other].iter().copied());
                let here = corners.filter(|point| point[0] == x);
                points.extend(here.map(|point| packed(stripe, point)));
            };
            if let Some(before) = stripe.checked_sub(1) {
                from(before, border(stripe));
            }
            if stripe + 1 < rects.len() {
                from(stripe + 1, border(stripe + 1));
            }
            points.extend(extra[stripe].iter().map(|point| packed(stripe, *point)));
            points
        });
        Self {
            stripes: stripes.collect(),
        }
    }

    /// Whether a stripe has a corner at a point.
    pub(super) fn has(&self, stripe: usize, point: [i32; 3]) -> bool {
        self.stripes[stripe].contains(&packed(stripe, point))
    }

    /// The corners between two points on a line along an axis, in order.
    pub(super) fn between(
        &self,
        stripe: Option<usize>,
        from: [i32; 3],
        to: [i32; 3],
        mut each: impl FnMut([i32; 3]),
    ) {
        let Some(axis) = (0..3).find(|axis| from[*axis] != to[*axis]) else {
            return;
        };
        let step = (to[axis] - from[axis]).signum();
        let mut point = from;
        loop {
            point[axis] += step;
            if point[axis] == to[axis] {
                return;
            }
            let home = (point[0].max(0) as usize / STRIPE).min(self.stripes.len() - 1);
            if self.has(stripe.unwrap_or(home), point) {
                each(point);
            }
        }
    }
}
