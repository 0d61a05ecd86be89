//! The best drawings of a given number.

use glam::DVec3;

use super::exact;
use super::exposure::Exposure;
use super::ssd::Frames;
use super::stretches::{self, Stretches};

/// For how many frames a drawing stands at most where nothing is said.
pub const LONGEST: usize = 8;
/// The greatest such number; what is more is taken as this.
const MOST_LONGEST: usize = 64;

/// The best drawings, and how many there are.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// What is shown when.
    pub exposure: Exposure,
    /// How many drawings were asked for.
    pub asked: usize,
    /// How many drawings there are: what was asked for, or the nearest possible number.
    pub drawings: usize,
    /// With fewer drawings one would stand for too long.
    pub fewest: usize,
    /// With more drawings two neighbours would be equal.
    pub most: usize,
    /// Σ ‖p(t) − p(drawing)‖² over all frames, in the square of the positions' unit.
    pub cost: f64,
    /// What each choice of as many drawings costs at least. It is `cost`, up to rounding, but for very long motions in which very
    /// many choices are almost equally good.
    pub bound: f64,
}

/// The `count` drawings that come nearest to the motion: those of least Σ ‖p(t) − p(drawing)‖² over all frames t. `positions` are
/// `frames × joints`, one frame after the other.
///
/// A drawing is any frame of the stretch for which it stands, of equally good ones the first. A stretch is at most `longest`
/// frames long (1 to 64), but neighbours that are equal may stand for any time. Of fewer drawings than that allows, or more than
/// there are poses, the nearest possible number is made. The same motion always gives the same drawings; of equally good choices
/// some one.
pub fn drawings(positions: &[DVec3], joints: usize, count: usize, longest: usize) -> Drawn {
    let frames = Frames::new(positions, joints);
    let longest = longest.clamp(1, MOST_LONGEST);
    let stretches = Stretches::new(frames, longest);
    let (found, fewest) = exact::find(&stretches, count);
    let mut sources = Vec::with_capacity(frames.count());
    let mut start = 0;
    for end in &found.way.ends {
        let drawing = stretches::drawing(frames, start, *end, longest);
        sources.extend(std::iter::repeat_n(drawing as u32, end - start));
        start = *end;
    }
    Drawn {
        exposure: Exposure::new(sources),
        asked: count,
        drawings: found.way.count(),
        fewest,
        most: stretches.poses,
        cost: found.way.cost,
        bound: found.bound,
    }
}
