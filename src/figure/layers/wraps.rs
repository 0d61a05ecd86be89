//! Which shapes reach around others: a belt, a sleeve, a cap of hair.

use glam::DVec2;

use super::shapes::Shape;
use crate::budget::{self, Step};
use crate::geometry::{Bands, edges, perimeter, shoelace};

/// Points along the border of a shape.
const CHORDS: usize = 160;
/// The share of chords that begin in what wraps and also end there.
const SHARE: f64 = 0.5;
/// How far inside the border a chord begins and ends, as a share of its length.
const SLACK: f64 = 0.08;
/// How wide what wraps may be, in lengths of the chords.
const WIDE: f64 = 1.8;
/// How far the width is measured along a chord to either side, in lengths of the chord, and the number of points there.
const REACH: f64 = 2.0;
const ACROSS: usize = 25;
/// The number of chords along which the width is measured.
const MEASURED: usize = 15;

/// A line through a shape, from a point of its border along the inward normal to the opposite border.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chord {
    from: DVec2,
    /// From `from` to the other end.
    along: DVec2,
}

/// The chords of a shape.
pub(super) fn chords(shape: &Shape) -> Vec<Chord> {
    let outline = &shape.outline;
    let around = perimeter(outline);
    let apart = around / CHORDS as f64;
    let rings = outline.rings();
    let area: f64 = rings.map(|ring| shoelace(ring)).sum();
    let filled_side = if area < 0.0 { -1.0 } else { 1.0 };
    let mut chords = Vec::with_capacity(CHORDS);
    along(edges(outline), apart, |_, foot, direction| {
        let inward = direction.perp() * filled_side;
        let ends = edges(outline).filter_map(|edge| crossing(foot, inward, edge));
        let nearest = ends.filter(|end| *end > 1e-6 * around).reduce(f64::min);
        if let Some(nearest) = nearest {
            chords.push(Chord {
                from: foot,
                along: inward * nearest,
            });
        }
    });
    chords
}

/// Calls `each` for points at equal distances along edges that follow one another, with the number of the edge and its direction.
pub(super) fn along(
    edges: impl Iterator<Item = [DVec2; 2]>,
    apart: f64,
    mut each: impl FnMut(usize, DVec2, DVec2),
) {
    let mut next = apart / 2.0;
    for (index, [from, to]) in edges.enumerate() {
        let length = from.distance(to);
        while next < length {
            each(index, from.lerp(to, next / length), (to - from) / length);
            next += apart;
        }
        next -= length;
    }
}

/// How far along a ray it crosses an edge.
fn crossing(from: DVec2, direction: DVec2, [a, b]: [DVec2; 2]) -> Option<f64> {
    let edge = b - a;
    let across = direction.perp_dot(edge);
    let to = a - from;
    let place = to.perp_dot(direction) / across;
    ((0.0..=1.0).contains(&place)).then(|| to.perp_dot(edge) / across)
}

/// Whether a shape reaches around another one, whose chords these are. `bands` are those of the shape's outline.
pub(super) fn wraps(shape: &Shape, bands: &Bands, chords: &[Chord]) -> bool {
    budget::count(Step::Overlap, 1);
    let holds = |chord: &Chord, share: f64| {
        let point = chord.from + chord.along * share;
        let (low, high) = shape.bounds;
        point.clamp(low, high) == point && bands.contains(point)
    };
    let begin: Vec<&Chord> = chords.iter().filter(|chord| holds(chord, SLACK)).collect();
    if begin.len() < 2 {
        return false;
    }
    let through: Vec<&&Chord> = begin
        .iter()
        .filter(|chord| holds(chord, 1.0 - SLACK))
        .collect();
    if (through.len() as f64) < SHARE * begin.len() as f64 {
        return false;
    }
    let length = 1.0 + 2.0 * REACH;
    let width = |chord: &Chord| {
        let places = (0..ACROSS).map(|k| -REACH + length * (k as f64 + 0.5) / ACROSS as f64);
        let inside = places.filter(|share| holds(chord, *share)).count();
        length * inside as f64 / ACROSS as f64
    };
    let every = through.len().div_ceil(MEASURED);
    let mut widths: Vec<f64> = through
        .iter()
        .step_by(every)
        .map(|chord| width(chord))
        .collect();
    widths.sort_unstable_by(f64::total_cmp);
    widths[widths.len() / 2] <= WIDE
}
