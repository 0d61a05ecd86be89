//! The tracker on clips whose marks are known, and on one that was filmed.
//!
//! `cargo test --test tracking -- --nocapture` prints how well the marks are found.
#![cfg(feature = "cli")]
#![allow(clippy::print_stderr, reason = "what was measured is told")]

#[path = "../common/mod.rs"]
mod common;

mod accuracy;
mod ambiguous;
mod cli;
mod filmed;
mod passing;
mod random;
mod synthetic;
