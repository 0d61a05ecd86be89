//! How well characters turn, measured on drawings whose answers are known: generated ones, the examples, and pictures by others.
#![allow(clippy::print_stdout, reason = "what was measured is told")]

mod between;
mod dirty;
mod labels;
mod manual;
mod named;
mod painted;
mod pairs;
mod traced;
