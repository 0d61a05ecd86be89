//! Limited animation: thins a motion out as if it were drawn by hand (Kitamura, chapter 5).
//!
//! The input is nothing but points in space, frame by frame; the output is an exposure sheet that gives the source frame of
//! each shown frame.
//! Knows no skeletons and no figures. A frame's identity is its source frame.

mod by_hand;
mod camera;
mod drawings;
mod error;
mod exact;
mod exposure;
mod hold;
mod key_times;
mod measured;
mod omit;
mod pose_list;
mod poses;
mod queue;
mod ranges;
mod segments;

#[cfg(test)]
mod tests;

pub(crate) use by_hand::{Chosen, Conflict, by_hand};
pub use camera::Camera;
pub use drawings::drawings;
pub(crate) use drawings::{BestDrawings, MAX_HOLD};
pub(crate) use error::Error;
pub use error::{Method, compare, error};
pub(crate) use exposure::every_through;
pub use exposure::{Drawing, Exposure, every};
pub(crate) use key_times::KeyTimes;
pub use measured::Measured;
pub use poses::{Poses, ssd};
pub(crate) use ranges::frame_ranges;

use pose_list::PoseList;

/// For how many frames a copied pose may be shown (5.2.2, 5.2.3).
pub(crate) const MAX_COPIED_FRAMES: u32 = 3;
/// Omitted poses by default (5.3: 4 to 6 look right).
pub(crate) const DEFAULT_OMITTED: usize = 4;
/// One of this many frames is held by default (5.3: a third of the frames).
pub(crate) const DEFAULT_HELD: usize = 3;
/// More omitted poses in a row than this tear a motion apart (5.3).
pub const MAX_OMITTED_RUN: usize = 6;

/// How much a motion is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// How many poses to omit (N_io).
    pub omit: usize,
    /// How many poses to replace by holding the one before (N_hf).
    pub hold: usize,
    /// Whether the clip keeps its length.
    pub length: Length,
}

impl Options {
    /// The defaults, right for most motions: 4 poses omitted, a third of the frames held, the length kept.
    pub fn recommended(frames: usize) -> Self {
        Self {
            omit: DEFAULT_OMITTED,
            hold: frames / DEFAULT_HELD,
            length: Length::Kept,
        }
    }
}

/// What happens to a clip's length when poses are omitted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Length {
    /// For each omitted pose another one is held for one frame more.
    #[default]
    Kept,
    /// The clip gets one frame shorter for each omitted pose.
    Shortened,
}

/// The result of [`limit`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cut {
    /// Which source frame each frame shows.
    pub exposure: Exposure,
    /// The omitted source frames, in the order in which they were chosen.
    pub omitted: Vec<u32>,
    /// The source frames that are shown for one frame more, one for each of `omitted`; empty if the length is not kept.
    pub duplicated: Vec<u32>,
    /// The holds, in the order in which they were chosen.
    pub held: Vec<Hold>,
    /// How many omissions were requested and done.
    pub omissions: Steps,
    /// How many holds were requested and done.
    pub holds: Steps,
    /// The most poses that were omitted in a row. More than [`MAX_OMITTED_RUN`] deserve a warning.
    pub omitted_run: usize,
}

/// A hold: a pose that is no longer shown because the one before is held in its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hold {
    /// The source frame that is covered.
    pub covered: u32,
    /// The source frame that is shown instead.
    pub by: u32,
}

/// How many steps were requested, and how many were possible.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Steps {
    /// Asked for.
    pub asked: usize,
    /// Done.
    pub done: usize,
}

impl Steps {
    /// How many requested steps were not possible.
    pub fn shortfall(self) -> usize {
        self.asked - self.done
    }
}

/// Omits the fastest poses, then holds the slowest (5.2, Algorithms 2 and 3).
/// A frame's identity is its source frame. Neighbouring source frames that are equal are one pose from the start; its source
/// frame is the first of them, and it may be shown for any time. Frames that become neighbours later remain two poses, and so do
/// frames whose [`ssd`] is 0 although something moves that has no point.
/// The speed of a pose is its [`ssd`] to the pose shown before it. Only poses that are shown for a single frame are omitted or
/// covered, and never the first one or the key pose ([`Poses::keeping`]).
///
/// - *Omission*: removes the fastest pose. To keep the length, the pose before the slowest one is then shown for one frame
///   more. Only poses shown for fewer than [`MAX_COPIED_FRAMES`] frames qualify, and never the last one, which has no
///   successor. The slowest pose is searched for after the fastest was removed, and may itself be shown for several frames. If
///   no pose qualifies, the omission is undone and omitting ends. What is omitted before the key pose is made up for before it,
///   and what is omitted after it from it on, so that the key pose stays in its frame; omitting ends on either side by itself.
/// - *Hold*: the slowest pose whose predecessor is shown for fewer than [`MAX_COPIED_FRAMES`] frames is covered by it, which
///   saves one drawing.
///
/// All searches resolve ties to the lowest source frame. Steps that are not possible are reported as shortfall.
///
/// Each step costs O(log frames), after O(frames · points) for the setup.
pub fn limit(poses: Poses<'_>, options: &Options) -> Cut {
    let mut list = PoseList::new(poses);
    let omit::Omitted {
        omitted,
        duplicated,
        omitted_run,
    } = omit::omit(&mut list, options.omit, options.length);
    let held = hold::hold(&mut list, options.hold);
    Cut {
        exposure: list.exposure(),
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
        omitted_run,
    }
}
