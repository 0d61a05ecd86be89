//! Terrain: the meaning of maps, their surfaces, and their appearance.

mod drawn;
mod letters;
mod rules;
mod surfaces;
mod worlds;
