//! Terrain: what maps mean, what is made of them, and what that looks like.

#[path = "../common/dice.rs"]
mod dice;
mod drawn;
mod letters;
mod rules;
mod surfaces;
mod worlds;
