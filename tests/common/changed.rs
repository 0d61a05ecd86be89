//! Drawings that are changed by edits.

use std::path::Path;

use okoshi::FolderResolver;
use okoshi::diagnostic::Edit;
use okoshi::internals::ide::Analysis;

/// The analysis of a drawing whose links lead from a folder.
pub(crate) fn analysis(folder: &Path, text: &str) -> Analysis {
    let compiled = super::compiled(text, &FolderResolver::new(folder));
    Analysis::new(text, compiled)
}

/// A text with some edits, which must be in order.
pub(crate) fn applied(text: &str, edits: &[Edit]) -> String {
    let mut out = String::new();
    let mut at = 0;
    for edit in edits {
        assert!(at <= edit.span.start, "{edits:?} are in order");
        out += &text[at..edit.span.start];
        out += &edit.text;
        at = edit.span.end;
    }
    out + &text[at..]
}
