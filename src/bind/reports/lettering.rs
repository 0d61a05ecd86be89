//! Reports that texts which look like strings are lettering.

use typed_index_collections::TiSlice;

use crate::bind::bindings::{DrawingString, StringId};
use crate::diagnostic::{Code, Diagnostic};

/// The hint that the strings of a drawing are taken for lettering, because of what would be an error.
pub(in crate::bind) fn lettering(
    strings: &TiSlice<StringId, DrawingString>,
    error: &Diagnostic,
) -> Diagnostic {
    let texts = match strings.len() {
        1 => "the text is".to_owned(),
        count => format!("the {count} texts are"),
    };
    let message = format!(
        "{texts} taken as lettering, not as names of parts: {}",
        error.message
    );
    Diagnostic::new(Code::Lettering, error.span, message).help(
        "leave it so if they are lettering; if they name parts, write a text with a keyword too, such as `%Scale 1`: then all texts are read as strings",
    )
}
