//! How well characters turn, measured on drawings whose answers are known.

mod between;
mod labels;
