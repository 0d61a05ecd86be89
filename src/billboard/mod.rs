//! Characters that turn although they are only drawn from a few sides.
//!
//! Invariants: outlines are in drawing units, y down; places are in the character's space, x its left, y up, z its front, in heights
//! of its first view. At each drawn view the model looks like the drawing.
//!
//! Source: Kitamura, *Modeling and Animation of Pseudo-3D Objects*, chapter 4.

mod backing;
mod character;
mod diagnostics;
mod drawn;
mod features;
mod keys;
mod matching;
mod names;
mod nodes;
mod paints;
mod pieces;
mod place;
mod region;
mod shape;
mod shapes;
mod sides;
#[doc(hidden)]
pub mod stages;
mod stops;
#[cfg(test)]
mod tests;
mod turn;

pub use character::Character;
pub(crate) use character::{RegionModel, read};
pub(crate) use matching::{Candidate, Pair, Reason, RegionInView, Track, TrackId, Unmatched};
pub(crate) use nodes::{RegionMaterials, add};
pub use region::RegionId;
pub(crate) use region::{Looks, View};
pub(crate) use sides::Side;

pub use crate::scene::ViewId;
