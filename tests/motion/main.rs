//! Motion capture from file to figure.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/dice.rs"]
mod dice;

mod carry;
mod cli;
mod limited;
mod model;
