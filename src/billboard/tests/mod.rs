//! Tests of characters as a whole. Those of one step are beside it.

pub(in crate::billboard) mod generated;
mod measured;
mod paints;
