//! okoshi turns one annotated 2D drawing into a moving 3D model.
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]

pub mod bind;
pub mod compile;
pub mod diagnostic;
pub mod disk;
pub mod figure;
pub mod geometry;
pub mod gltf;
pub mod lang;
pub mod resolver;
pub mod scene;
pub mod solid;
pub mod source;
pub mod svg;

/// stub
pub mod cli {
    /// stub
    pub fn run(_: std::env::ArgsOs) -> std::process::ExitCode {
        std::process::ExitCode::SUCCESS
    }
}
