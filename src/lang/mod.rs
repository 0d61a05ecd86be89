//! The annotation language: the strings that people write into a drawing.
//!
//! Invariant: this module knows strings, not drawings. [`parse()`] never fails: whatever it cannot read
//! becomes a diagnostic, and the rest of the string still counts. One table, [`keyword`], defines the
//! language.
//!
//! A string goes through three steps: [`parse()`] builds its syntax tree, [`Variables::collect`] reads
//! the `Let` of all `%` strings, and [`settings`] checks the attributes and computes their values.

pub(crate) mod ast;
pub(crate) mod check;
pub(crate) mod explain;
pub(crate) mod keyword;
pub(crate) mod parameter;
pub mod parse;
pub(crate) mod quoting;
pub mod reference;
pub(crate) mod value;
pub(crate) mod variables;

mod evaluate;
pub(crate) mod motion;
mod normalize;
#[cfg(test)]
mod tests;
mod topics;

pub use check::settings;
pub(crate) use normalize::normalize;
pub(crate) use parameter::{ParameterRef, parameter_at};
pub use parse::{Container, parse};
pub(crate) use parse::{
    annotates, describes, is_name_char, is_word_char, looks_like_string, says_keyword, strings_in,
};
pub(crate) use variables::{Variables, solved};

use std::ops::Range;

use crate::diagnostic::Diagnostic;
use crate::source::Text;

/// Drops fixes that would also replace tags between the pieces of a text.
fn keep_safe_fixes(text: &Text, diagnostics: &mut [Diagnostic]) {
    for diagnostic in diagnostics {
        diagnostic
            .fixes
            .retain(|fix| fix.edits.iter().all(|edit| text.is_whole(edit.span)));
    }
}

/// A diagnostic with the fix that writes something better in a range of its string.
fn fixed_by_writing(
    diagnostic: Diagnostic,
    text: &Text,
    range: &Range<usize>,
    better: &str,
) -> Diagnostic {
    let written = text.escape_at(range.start, better);
    diagnostic.fix(
        format!("Write `{better}`"),
        text.span(range.clone()),
        written,
    )
}

/// The same for a word that is misspelled.
fn did_you_mean(
    diagnostic: Diagnostic,
    text: &Text,
    range: &Range<usize>,
    near: &str,
) -> Diagnostic {
    let diagnostic = diagnostic.label(format!("did you mean `{near}`?"));
    fixed_by_writing(diagnostic, text, range, near)
}
