//! Tests of characters as a whole. Those of one step are beside it.

mod fading;
pub(in crate::billboard) mod generated;
mod measured;
mod paints;
