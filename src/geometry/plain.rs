//! Rings that plainly neither cross nor touch, which most drawn ones do not, without the grid.
//!
//! Everything here errs on one side: what is not plain to see in a bounded number of steps is left to the overlay.

use std::cell::RefCell;

use glam::DVec2;

use super::query::{is_inside, shoelace};
use super::{FillRule, Outline, Polygon, Ring};

/// Pairs of edges that are looked at, per edge: where more lie above each other, sweeping from left to right is no
/// quick way.
const MOST_PAIRS: usize = 24;
/// Rings of a path whose nesting is found by looking at all pairs.
pub(super) const MOST_RINGS: usize = 64;

/// An edge and the interval that it covers across.
#[derive(Clone, Copy)]
struct Edge {
    low: DVec2,
    high: DVec2,
    from: DVec2,
    to: DVec2,
    number: u32,
    /// The number of the edge that begins where this one ends.
    next: u32,
}

thread_local! {
    static EDGES: RefCell<Vec<Edge>> = const { RefCell::new(Vec::new()) };
}

/// Whether edges that do not follow each other plainly keep more than `gap` apart.
pub(super) fn keep_apart(rings: &[Ring], gap: f64) -> bool {
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
        let mut pairs = MOST_PAIRS * edges.len();
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
                if level && !follow && !a.is_beside(b, gap) && !b.is_beside(a, gap) {
                    return false;
                }
            }
        }
        true
    })
}

impl Edge {
    /// Whether both ends of `other` lie on one side of this edge's line, further away than `gap`.
    fn is_beside(&self, other: &Edge, gap: f64) -> bool {
        let along = self.to - self.from;
        let from = along.perp_dot(other.from - self.from);
        let to = along.perp_dot(other.to - self.from);
        let least = from.abs().min(to.abs());
        (from > 0.0) == (to > 0.0) && least * least > gap * gap * along.length_squared()
    }
}

/// The area that rings enclose which keep apart. Takes the square of their number.
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
    // What is filled inside and outside of each ring.
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
            rings: vec![turned(&mut rings[ring], runs_down[ring])],
        });
    }
    for ring in (0..rings.len()).filter(|ring| sides[*ring] == [false, true]) {
        // The innermost border around a hole is its own.
        let borders = around[ring]
            .iter()
            .filter(|outer| sides[**outer] == [true, false]);
        if let Some(border) = borders.max_by_key(|outer| around[**outer].len()) {
            let hole = turned(&mut rings[ring], !runs_down[ring]);
            outline.polygons[polygon_of[*border]].rings.push(hole);
        }
    }
    outline
}

/// Takes a ring, turned round where that is asked for.
fn turned(ring: &mut Ring, turn: bool) -> Ring {
    if turn {
        ring.reverse();
    }
    std::mem::take(ring)
}
