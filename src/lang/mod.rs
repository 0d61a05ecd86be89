//! The annotation language: what a person may write into a drawing.
//!
//! Invariant: this module knows strings, not drawings. [`parse`] never fails; what it cannot read
//! becomes a diagnostic, and everything else in the string still counts. One table, [`keyword`], is
//! the language.

pub mod ast;
pub mod keyword;
pub mod value;
