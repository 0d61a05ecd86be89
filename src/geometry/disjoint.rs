//! A fast path for rings that clearly neither cross nor touch, as most drawn ones: they need no grid.
//!
//! The answers are conservative: what a bounded number of steps cannot decide is left to the overlay (`boolean.rs`).

use std::cell::RefCell;

use glam::DVec2;

use super::query::{is_inside, shoelace};
use super::{FillRule, Outline, Polygon, Ring};

/// Pairs of edges that are compared, per edge. Where more edges lie above each other the sweep would become slow.
const MAX_PAIRS_PER_EDGE: usize = 24;
/// The largest number of rings whose nesting is found by comparing all pairs.
pub(super) const MAX_NESTED_RINGS: usize = 64;

/// An edge with its bounding box.
#[derive(Clone, Copy)]
struct Edge {
    low: DVec2,
    high: DVec2,
    from: DVec2,
    to: DVec2,
    number: u32,
    /// The number of the following edge.
    next: u32,
}

thread_local! {
    static EDGES: RefCell<Vec<Edge>> = const { RefCell::new(Vec::new()) };
}

/// Whether all edges that do not follow each other are clearly more than `gap` apart: sweep and prune along x.
pub(super) fn are_disjoint(rings: &[Ring], gap: f64) -> bool {
    EDGES.with_borrow_mut(|edges| {
        edges.clear();
        for ring in rings {
            let first = edges.len();
            let mut from = ring[ring.len() - 1];
            for &to in ring {
                let (low, high) = (from.min(to), from.max(to));
                let number = edges.len() as u32;
                edges.push(Edge {
                    low,
                    high,
                    from,
                    to,
                    number,
                    next: number + 1,
                });
                from = to;
            }
            if let Some(last) = edges.last_mut() {
                last.next = first as u32;
            }
        }
        edges.sort_unstable_by(|a, b| a.low.x.total_cmp(&b.low.x));
        let mut pairs = MAX_PAIRS_PER_EDGE * edges.len();
        for (i, a) in edges.iter().enumerate() {
            for b in &edges[i + 1..] {
                if b.low.x > a.high.x + gap {
                    break;
                }
                if pairs == 0 {
                    return false;
                }
                pairs -= 1;
                let level = b.low.y <= a.high.y + gap && a.low.y <= b.high.y + gap;
                let follow = a.next == b.number || b.next == a.number;
                if level && !follow && !a.is_on_one_side(b, gap) && !b.is_on_one_side(a, gap) {
                    return false;
                }
            }
        }
        true
    })
}

impl Edge {
    /// Whether both ends of `other` lie on the same side of this edge's line, farther away than `gap`.
    fn is_on_one_side(&self, other: &Edge, gap: f64) -> bool {
        let along = self.to - self.from;
        let from = along.perp_dot(other.from - self.from);
        let to = along.perp_dot(other.to - self.from);
        let least = from.abs().min(to.abs());
        (from > 0.0) == (to > 0.0) && least * least > gap * gap * along.length_squared()
    }
}

/// The area that disjoint rings enclose. Takes time quadratic in their number.
pub(super) fn nest(mut rings: Vec<Ring>, rule: FillRule) -> Outline {
    let runs_down: Vec<bool> = rings.iter().map(|ring| shoelace(ring) > 0.0).collect();
    let around: Vec<Vec<usize>> = rings
        .iter()
        .enumerate()
        .map(|(inner, ring)| {
            let outer = (0..rings.len()).filter(|&outer| outer != inner);
            outer
                .filter(|&outer| is_inside(&rings[outer], ring[0]))
                .collect()
        })
        .collect();
    let turn = |ring: usize| if runs_down[ring] { 1 } else { -1 };
    let is_filled = |rings: &[usize], own: Option<usize>| {
        let all = rings.iter().copied().chain(own);
        match rule {
            FillRule::NonZero => all.map(turn).sum::<i32>() != 0,
            FillRule::EvenOdd => all.count() % 2 == 1,
        }
    };
    // Whether the inside and the outside of each ring are filled.
    let sides: Vec<[bool; 2]> = (0..rings.len())
        .map(|ring| {
            [
                is_filled(&around[ring], Some(ring)),
                is_filled(&around[ring], None),
            ]
        })
        .collect();
    let mut outline = Outline::default();
    let mut polygon_of = vec![0; rings.len()];
    for ring in (0..rings.len()).filter(|ring| sides[*ring] == [true, false]) {
        polygon_of[ring] = outline.polygons.len();
        outline.polygons.push(Polygon {
            rings: vec![take_ring(&mut rings[ring], runs_down[ring])],
        });
    }
    for ring in (0..rings.len()).filter(|ring| sides[*ring] == [false, true]) {
        // A hole belongs to the innermost border around it.
        let borders = around[ring]
            .iter()
            .filter(|outer| sides[**outer] == [true, false]);
        if let Some(border) = borders.max_by_key(|outer| around[**outer].len()) {
            let hole = take_ring(&mut rings[ring], !runs_down[ring]);
            outline.polygons[polygon_of[*border]].rings.push(hole);
        }
    }
    outline
}

/// Takes a ring out of its place, reversed if `turn` is set.
fn take_ring(ring: &mut Ring, turn: bool) -> Ring {
    if turn {
        ring.reverse();
    }
    std::mem::take(ring)
}
