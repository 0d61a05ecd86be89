//! okoshi turns one annotated 2D drawing into a moving 3D model.
//!
//! [`compile::compile`] is the whole of it: a pure function from an SVG drawing to a [`scene::Scene`], with
//! [`diagnostic::Diagnostic`]s beside it; [`export::write`] writes the scene. What the strings in a drawing
//! can say is one table, [`lang::keyword`].
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]
#![cfg_attr(
    not(feature = "cli"),
    allow(
        dead_code,
        unused_imports,
        reason = "what only the rim uses is unused without it"
    )
)]

mod anatomy;
pub mod assemble;
mod assignment;
pub mod billboard;
pub mod bind;
#[cfg(feature = "cli")]
pub mod cli;
pub mod clips;
pub mod compile;
pub mod crash;
pub mod diagnostic;
#[cfg(feature = "disk")]
pub mod disk;
pub mod export;
pub mod figure;
pub mod geometry;
pub mod ide;
pub mod import;
mod index;
pub mod labels;
pub mod lang;
pub mod limited;
#[cfg(feature = "render")]
pub mod look;
#[cfg(feature = "lsp")]
pub mod lsp;
pub mod mark_tracks;
pub mod memo;
pub mod mocap;
pub mod motion;
pub mod performance;
pub mod prepare;
#[cfg(feature = "preview")]
pub mod preview;
pub mod puppet;
mod regions;
#[cfg(feature = "render")]
pub mod render;
pub mod report;
pub mod resolver;
pub mod retarget;
pub mod rig;
pub mod scene;
mod smoothing;
pub mod solid;
pub mod source;
pub mod svg;
pub mod terrain;
pub mod texture;
mod threads;
#[cfg(feature = "tracking")]
pub mod tracking;
#[cfg(feature = "watch")]
pub mod watch;
