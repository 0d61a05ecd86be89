//! A performance: a motion as the marks of a puppet tell it (docs/performance.md).
//!
//! Source: Manya & Matsuda, *An Effective Expression Input Method to Characteristic Joint for Various 3D Character*. What the paper
//! leaves open (how movement is measured, what happens at the ends of clips, how rotations are damped) is defined here. A
//! *characteristic joint* is a joint or part that a mark performs; they are called channels, and numbered, and so are their marks.

mod camerawork;
mod emphasis;
mod filmed;
mod information;
mod marks;
mod plan;

pub(crate) use emphasis::{Limbs, ratios};
pub(crate) use filmed::Filmed;
pub(crate) use information::{Information, joint_steps};
pub(crate) use marks::mark_movements;
pub use plan::Filming;
pub(crate) use plan::{Effects, Finding, Plan, Request, plan};
