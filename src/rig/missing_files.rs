//! Links of strings to files that cannot be read.

use crate::diagnostic::{Diagnostic, nearest_word};
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;
use crate::svg::broken_link;

use super::figure_clip::stem;

/// A link at `span` that leads to no file that can be read; of the files beside it, the one that could be meant is offered, as
/// `written` writes it in the string.
pub(super) fn missing_file(
    link: &str,
    error: &LinkError,
    span: Span,
    written: impl Fn(&str) -> String,
    resolver: &dyn Resolver,
) -> Diagnostic {
    let diagnostic = broken_link(link, error, span);
    if *error != LinkError::Missing {
        return diagnostic;
    }
    let siblings = resolver.siblings(link);
    let stems = siblings.iter().map(|sibling| stem(sibling));
    let nearest = nearest_word(stem(link), stems);
    let mut siblings = siblings.iter();
    // A name with a quotation mark cannot be written in a string.
    let found = siblings.find(|sibling| Some(stem(sibling)) == nearest && !sibling.contains('"'));
    match found {
        Some(found) => diagnostic.label(format!("did you mean `{found}`?")).fix(
            format!("Write `{found}`"),
            span,
            written(found),
        ),
        None => diagnostic,
    }
}
