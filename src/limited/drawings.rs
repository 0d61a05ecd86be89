//! The best drawings of a given number (ours, not in the thesis).

use super::exact;
use super::exposure::Exposure;
use super::poses::Poses;
use super::segments::{self, Segments};

/// For how many frames a drawing is held at most, by default.
pub(crate) const MAX_HOLD: usize = 8;
/// The largest value of that limit; larger ones are reduced to it.
const MAX_HOLD_LIMIT: usize = 64;

/// The best drawings, and how many there are.
#[derive(Debug, Clone, PartialEq)]
pub struct BestDrawings {
    /// Which source frame each frame shows.
    pub exposure: Exposure,
    /// The requested number of drawings.
    pub asked: usize,
    /// The number of drawings: the requested one, or the nearest possible.
    pub drawings: usize,
    /// With fewer drawings, one would be held for too long.
    pub fewest: usize,
    /// With more drawings, two neighbours would be equal.
    pub most: usize,
    /// Σ ‖p(t) − p(drawing)‖² over all frames, in the square of the positions' unit.
    pub cost: f64,
    /// A lower bound of that cost for as many drawings. Up to rounding it equals `cost`, except in very long motions in which
    /// very many choices are almost equally good.
    pub bound: f64,
}

/// The `count` drawings that approximate the motion best: those with the least Σ ‖p(t) − p(drawing)‖² over all frames t.
///
/// A drawing is one of the frames of the segment for which it is held: the one that must stay ([`Poses::keeping`]), of equally good
/// ones the first. A segment is at most
/// `max_hold` frames long (1 to 64), but equal neighbours may be held for any time. If `count` is below what that allows, or
/// above the number of poses, the nearest possible number is used. The same motion always gives the same drawings; of equally
/// good choices, any one.
pub fn drawings(frames: Poses<'_>, count: usize, max_hold: usize) -> BestDrawings {
    let max_hold = max_hold.clamp(1, MAX_HOLD_LIMIT);
    let segments = Segments::new(frames, max_hold);
    let (found, fewest) = exact::find(&segments, count);
    let mut sources = Vec::with_capacity(frames.count());
    let mut start = 0;
    for end in &found.segmentation.ends {
        let drawing = segments::drawing(frames, start, *end, max_hold);
        sources.extend(std::iter::repeat_n(drawing as u32, end - start));
        start = *end;
    }
    BestDrawings {
        exposure: Exposure::new(sources),
        asked: count,
        drawings: found.segmentation.count(),
        fewest,
        most: segments.poses,
        cost: found.segmentation.cost,
        bound: found.bound,
    }
}
