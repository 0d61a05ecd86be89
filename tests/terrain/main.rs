//! Terrain: the meaning of maps, their surfaces, and their appearance.
#![cfg(feature = "cli")]
#![allow(clippy::print_stdout, reason = "what was measured is told")]

mod backs;
mod byhand;
mod drawn;
mod letters;
mod plain;
mod props;
mod rules;
mod surfaces;
mod worlds;
