//! A motion by itself, without a figure: thinned out, performed, filmed, drawn as a chart, and as a model of its skeleton.
//!
//! This is what `okoshi motion` does. `rig` does the same for figures.

mod chart;
pub(crate) mod edit;
mod measured;
mod perform;
mod skeleton_model;

pub(crate) use chart::{Chart, chart};
pub use measured::PointChoice;
pub(crate) use perform::{JointChannel, PerformedClip, perform};
pub(crate) use skeleton_model::{add_camera, skeleton_model};
