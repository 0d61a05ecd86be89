//! Coloured marks found in the frames of a clip (docs/tracking.md).
//!
//! A [`Learner`] looks at some frames and learns what each mark looks like, and what else in the picture does; a [`Tracker`] then finds the
//! marks in one frame after the other. A [`Follower`] also judges at the end of the clip which of all things that look like a mark is the
//! mark, and where that is ambiguous. Knows pixels, no files. Positions are pixels from the top left corner of the picture, x to the
//! right, y down; the middle of the first pixel is at (0, 0). Hues are degrees from 0 to 360, saturation and chroma are from 0 to 1.

mod appearance;
mod clutter;
mod color;
mod components;
mod follower;
mod frame;
mod judge;
mod learn;
mod lookup;
mod mark;
mod pieces;
mod samples;
mod still;
mod traces;
mod track;

pub(crate) use color::hue_name;
pub use follower::Follower;
pub use frame::Frame;
pub use learn::Learner;
pub(crate) use learn::{LearnError, Learned};
pub use mark::Mark;
pub(crate) use track::Sighting;
pub use track::Tracker;
