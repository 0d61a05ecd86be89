//! The annotation language: what a person may write into a drawing.
//!
//! Invariant: this module knows strings, not drawings. [`parse()`] never fails; what it cannot read
//! becomes a diagnostic, and everything else in the string still counts. One table, [`keyword`], is
//! the language.
//!
//! A string goes through three steps: [`parse()`] gives its syntax tree, [`Variables::collect`] reads
//! the `Let` of all `%` strings, and [`settings`] checks the attributes and computes their values.

pub mod ast;
pub mod check;
pub mod explain;
pub mod keyword;
pub mod parse;
pub mod reference;
pub mod slot;
pub mod value;
pub mod variables;

mod evaluate;
mod folded;
#[cfg(test)]
mod tests;

pub use check::settings;
pub use folded::folded;
pub use parse::{Place, in_name, in_word, looks_like_string, parse};
pub use slot::{Slot, slot};
pub use variables::Variables;

use crate::diagnostic::Diagnostic;
use crate::source::Text;

/// Drops fixes that would replace tags between the parts of a text along with it.
fn keep_safe_fixes(text: &Text, diagnostics: &mut [Diagnostic]) {
    for diagnostic in diagnostics {
        diagnostic
            .fixes
            .retain(|fix| fix.edits.iter().all(|edit| text.is_whole(edit.span)));
    }
}
