//! Finds the trunk of a figure without a face: what is seen most, and what the others touch.

use super::shapes::{Shape, Shapes};
use super::{Certainty, Guesses};
use crate::anatomy::Noun;

/// A trunk is touched by at least this many others.
const FEWEST: usize = 3;
/// From how many on it does not count that there are more.
const ENOUGH: usize = 6;
/// A trunk that is at least this share of its width high is upright, with a head on top of it.
const UPRIGHT: f64 = 0.8;
/// The upper half of a body is at least this share of the lower one.
const HALF: f64 = 0.35;
/// The lower half of a body that is this much higher than wide is a leg.
const LEG: f64 = 1.8;
/// A head is at least and at most this share of the trunk.
const HEADS: std::ops::RangeInclusive<f64> = 0.03..=1.5;

/// Names the trunk and, if it is upright, the head above it, unless that is known.
pub(super) fn find(shapes: &Shapes, known: Option<usize>, guesses: &mut Guesses) {
    let touching = |index: usize, shape: &Shape| {
        let others = shapes.iter().filter(|(other, _)| *other != index);
        others
            .filter(|(_, other)| shape.mask.touches(&other.mask))
            .count()
    };
    let named = guesses.find(Noun::Body);
    let trunk = shapes
        .iter()
        .filter(|(index, _)| named.map_or(Some(*index) != known, |body| *index == body))
        .map(|(index, shape)| (index, shape, touching(index, shape)))
        .filter(|(.., touched)| named.is_some() || *touched >= FEWEST)
        .max_by(|a, b| worth(a.1, a.2).total_cmp(&worth(b.1, b.2)));
    let Some((mut body, mut trunk, _)) = trunk else {
        return;
    };
    let mut head = above(shapes, [Some(body), known], trunk);
    // What carries the head and is as large as a body is the upper half of one.
    if named.is_none()
        && let Some((upper, chest)) = head
        && chest.cells >= HALF * trunk.cells
        && touching(upper, chest) >= FEWEST
        && let top = known.or(above(shapes, [Some(upper), None], chest).map(|(top, _)| top))
        && let Some(top) = top.and_then(|top| Some((top, shapes.get(top)?)))
    {
        // The near leg of somebody in profile hides the far one, and is found where limbs are.
        let size = trunk.size();
        if size.y < LEG * size.x {
            let why = "it is below the body, and as large";
            guesses.add(body, Noun::Hips, Certainty::Likely, why);
        }
        (body, trunk) = (upper, chest);
        head = Some(top);
    }
    let why = "it is what is seen most of all that others touch";
    guesses.add(body, Noun::Body, Certainty::Likely, why);
    let size = trunk.size();
    if known.is_some() || size.y < UPRIGHT * size.x {
        return;
    }
    if let Some((head, _)) = head {
        let why = "it is the largest shape above an upright body";
        guesses.add(head, Noun::Head, Certainty::Likely, why);
    }
}

/// The largest shape above another one, if it may be its head.
fn above<'a>(
    shapes: &'a Shapes,
    but: [Option<usize>; 2],
    trunk: &Shape,
) -> Option<(usize, &'a Shape)> {
    let size = trunk.size();
    let is_head = |shape: &Shape| {
        let off = (shape.middle() - trunk.middle()).abs();
        shape.middle().y < trunk.bounds.low.y + 0.2 * size.y
            && off.x <= 0.35 * size.x
            && HEADS.contains(&(shape.cells / trunk.cells))
    };
    shapes
        .iter()
        .filter(|(index, shape)| !but.contains(&Some(*index)) && is_head(shape))
        .max_by(|a, b| a.1.cells.total_cmp(&b.1.cells))
}

fn worth(shape: &Shape, touched: usize) -> f64 {
    shape.seen * touched.min(ENOUGH) as f64
}
