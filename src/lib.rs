//! okoshi turns one annotated 2D drawing into a moving 3D model.
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]

pub mod diagnostic;
pub mod geometry;
pub mod lang;
pub mod scene;
pub mod solid;
pub mod source;

/// stub
pub mod cli {
    /// stub
    pub fn run(_: std::env::ArgsOs) -> std::process::ExitCode {
        std::process::ExitCode::SUCCESS
    }
}
