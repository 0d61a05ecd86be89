//! Motion capture by itself: skeletons, clips of their motion, BVH files, and what can be done to a clip without knowing what moves.
//!
//! Knows no figures, no drawings and no files on disk. Frames and joints count from 0; angles in files are degrees, lengths are in
//! the file's unit.

pub(crate) mod bvh;
pub(crate) mod in_turn;
pub(crate) mod resample;
mod skeleton;
pub(crate) mod travel;
pub(crate) mod turns;
mod up;

pub(crate) use skeleton::height;
pub use skeleton::{Axis, Channel, Clip, Joint, JointId, Pose, Skeleton, Transform};
pub(crate) use up::UpAxis;
