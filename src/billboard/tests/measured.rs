//! How well characters turn, measured on drawings whose answers are known: generated ones, the examples, and pictures by others.

mod between;
mod labels;
mod pairs;
mod traced;
