//! Motion capture: read, matched with figures, retargeted to them, and turned into limited animation.
//!
//! Source: Kitamura, *Modeling and Animation of Pseudo-3D Objects*, chapter 5. Knows skeletons and abstract figures, no drawings
//! and no files. Frames and joints count from 0; angles in files are degrees, lengths are in the file's unit.

pub mod bvh;
pub mod chart;
pub mod clips;
pub mod edit;
pub mod figure;
pub mod key_times;
pub mod labels;
pub mod lead_in;
pub mod limited;
pub mod looping;
pub mod mark_tracks;
pub mod matching;
pub mod measured;
pub mod performance;
pub mod prepare;
pub mod resample;
pub mod retarget;
pub mod skeleton;
pub mod skeleton_model;
pub mod travel;
pub(crate) mod turns;
pub mod up;
