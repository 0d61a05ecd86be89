//! Motion capture from file to figure.
//!
//! `cargo test --test motion -- --nocapture` prints how well its laws hold.
#![cfg(feature = "cli")]
#![allow(clippy::print_stderr, reason = "what was measured is told")]

#[path = "../common/mod.rs"]
mod common;

mod cli;
mod figures;
mod limited;
mod measured;
mod model;
mod performance;
mod performed;
mod retarget;
mod walking;
