//! okoshi turns one annotated 2D drawing into a moving 3D model.
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]

pub mod cli;
pub mod diagnostic;
pub mod disk;
pub mod geometry;
pub mod gltf;
pub mod lang;
pub mod resolver;
pub mod scene;
pub mod source;
