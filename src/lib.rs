//! okoshi turns one annotated 2D drawing into a moving 3D model.
//!
//! [`compile::compile`] is the whole of it: a pure function from an SVG drawing to a [`scene::Scene`], with
//! [`diagnostic::Diagnostic`]s beside it; [`export::write`] writes the scene. What the strings in a drawing
//! can say is one table, [`lang::keyword`].
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]

mod anatomy;
pub mod assemble;
mod assignment;
pub mod billboard;
pub mod bind;
pub mod cli;
pub mod compile;
pub mod crash;
pub mod diagnostic;
pub mod disk;
pub mod export;
pub mod figure;
pub mod geometry;
pub mod ide;
pub mod import;
mod index;
pub mod lang;
pub mod look;
pub mod lsp;
pub mod memo;
pub mod motion;
pub mod preview;
pub mod puppet;
mod regions;
pub mod render;
pub mod report;
pub mod resolver;
pub mod rig;
pub mod scene;
mod smoothing;
pub mod solid;
pub mod source;
pub mod svg;
pub mod terrain;
pub mod texture;
mod threads;
pub mod tracking;
pub mod watch;
