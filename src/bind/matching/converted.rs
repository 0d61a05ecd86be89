//! Strings that were converted to paths.

use crate::lang::annotates;
use crate::source::Span;
use crate::svg::{ConvertedText, Drawing};

/// Where the strings are that were converted to paths: their letters are no parts.
pub(super) struct ConvertedStrings(Vec<Span>);

impl ConvertedStrings {
    pub(super) fn of(drawing: &Drawing) -> Self {
        let converted = drawing.unseen.converted.iter();
        let converted = converted.filter(|converted| annotates(&converted.text));
        let mut spans: Vec<Span> = Vec::new();
        for ConvertedText { whole, .. } in converted {
            // One in another is the outer one's.
            if spans.last().is_none_or(|outer| outer.end <= whole.start) {
                spans.push(*whole);
            }
        }
        Self(spans)
    }

    /// Whether the drawing's byte `at` is in one of them. They are in document order and apart from each other.
    pub(super) fn contains(&self, at: usize) -> bool {
        let next = self.0.partition_point(|span| span.start <= at);
        self.0[..next].last().is_some_and(|span| at < span.end)
    }
}
