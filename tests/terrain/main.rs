//! Terrain: what maps mean, what is made of them, and what that looks like.

mod drawn;
mod letters;
mod rules;
mod surfaces;
mod worlds;
