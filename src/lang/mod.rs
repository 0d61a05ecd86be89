//! The annotation language: what a person may write into a drawing.
//!
//! Invariant: this module knows strings, not drawings. [`parse()`] never fails; what it cannot read
//! becomes a diagnostic, and everything else in the string still counts. One table, [`keyword`], is
//! the language.
//!
//! A string goes through three steps: [`parse()`] gives its syntax tree, [`Variables::collect`] reads
//! the `Let` of all `%` strings, and [`settings`] checks the attributes and computes their values.

pub mod ast;
pub mod keyword;
pub mod parse;
pub mod value;

mod folded;

pub use parse::{Place, looks_like_string, parse};
