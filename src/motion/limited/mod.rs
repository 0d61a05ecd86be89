//! Limited animation: a motion cut as if it were drawn by hand (Kitamura, chapter 5).
//!
//! Sees nothing but where the joints are, frame by frame, and answers with an exposure sheet: per shown frame the source frame
//! that it shows.

mod camera;
mod drawings;
mod error;
mod exact;
mod exposure;
mod hold;
mod omit;
mod queue;
mod ssd;
mod stretches;
mod strip;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub use camera::Camera;
pub use drawings::{Drawn, LONGEST, drawings};
pub use error::{Error, Method, compare, error};
pub use exposure::{Drawing, Exposure, every};
pub use ssd::{speeds, ssd};

use ssd::Frames;
use strip::Strip;

/// For how many frames a pose may stand that is shown by copying (5.2.2, 5.2.3).
pub const LONGEST_COPIED: u32 = 3;
/// How many poses are omitted where nothing is said (5.3: 4 to 6 are right).
pub const OMITTED: usize = 4;
/// Of how many frames one is held where nothing is said (5.3: a third of the frames).
pub const HELD: usize = 3;
/// More poses omitted in one place than this tear a motion apart (5.3).
pub const MOST_GATHERED: usize = 6;

/// How much is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// How many poses are omitted (N_io).
    pub omit: usize,
    /// How many poses are covered by the one before (N_hf).
    pub hold: usize,
    /// What becomes of the clip's length.
    pub length: Length,
}

impl Options {
    /// What is right for most motions of so many frames: 4 poses omitted, a third of the frames held, the length kept.
    pub fn usual(frames: usize) -> Self {
        Self {
            omit: OMITTED,
            hold: frames / HELD,
            length: Length::Kept,
        }
    }
}

/// What becomes of a clip's length when poses are omitted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Length {
    /// For each pose that is omitted another stands for one frame more.
    #[default]
    Kept,
    /// The clip gets shorter by one frame for each pose that is omitted.
    Shortened,
}

/// What [`limit`] made of a motion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cut {
    /// What is shown when.
    pub exposure: Exposure,
    /// The source frames that were omitted, in the order in which it was done.
    pub omitted: Vec<u32>,
    /// The source frames that stand for one frame more each, one for each of `omitted`; empty where the length is not kept.
    pub duplicated: Vec<u32>,
    /// What was held, in the order in which it was done.
    pub held: Vec<Held>,
    /// How many omissions were asked for and done.
    pub omissions: Steps,
    /// How many holds were asked for and done.
    pub holds: Steps,
    /// The most poses that were omitted in one place. More than [`MOST_GATHERED`] are worth a warning.
    pub gathered: usize,
}

/// A hold: a pose that is not shown any more, since another stands in its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Held {
    /// The source frame that was covered.
    pub covered: u32,
    /// The source frame that stands in its place.
    pub by: u32,
}

/// How many steps were asked for, and how many were possible.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Steps {
    /// Asked for.
    pub asked: usize,
    /// Done.
    pub done: usize,
}

impl Steps {
    /// How many were asked for in vain.
    pub fn shortfall(self) -> usize {
        self.asked - self.done
    }
}

/// Omits what is fast, then holds what is slow (5.2, Algorithms 2 and 3). `positions` are `frames × joints`, one frame after the
/// other, in any unit; positions that fill no frame are left out, and more than 2³² − 2 frames are.
///
/// A frame's identity is its source frame. Neighbours in the source whose [`ssd`] is 0 are one pose from the start, with the first
/// of them as its source frame, and may stand for any time; frames that become neighbours later stay two poses. The speed of a
/// pose is its [`ssd`] to the pose shown before it. Only poses that are shown for one frame are omitted or covered, never the
/// first.
///
/// - *Omission*: the fastest pose is taken out. Then, where the length is kept, the pose before the slowest one stands for one
///   frame more; only poses that stand for less than [`LONGEST_COPIED`] frames do, and the last, which has none after it, never.
///   The slowest is sought after the fastest was taken out, and it may stand for several frames itself. Where there is no such
///   place, the omission is not done and there is no further one.
/// - *Hold*: the slowest pose whose predecessor stands for less than [`LONGEST_COPIED`] frames is covered by it: one drawing less.
///
/// Of equally fast poses the one of the lowest source frame is taken, in all searches. What cannot be done is told as shortfall.
///
/// Each step costs O(log frames), after O(frames · joints) at the start.
pub fn limit(positions: &[DVec3], joints: usize, options: &Options) -> Cut {
    let mut strip = Strip::new(Frames::new(positions, joints));
    let omit::Omitted {
        omitted,
        duplicated,
        gathered,
    } = omit::omit(&mut strip, options.omit, options.length);
    let held = hold::hold(&mut strip, options.hold);
    Cut {
        exposure: strip.exposure(),
        omissions: Steps {
            asked: options.omit,
            done: omitted.len(),
        },
        holds: Steps {
            asked: options.hold,
            done: held.len(),
        },
        omitted,
        duplicated,
        held,
        gathered,
    }
}
