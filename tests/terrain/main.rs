//! Terrain: the meaning of maps, their surfaces, and their appearance.
#![cfg(feature = "cli")]

mod drawn;
mod letters;
mod rules;
mod surfaces;
mod worlds;
